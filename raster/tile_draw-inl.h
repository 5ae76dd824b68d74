// Draws the triangles of a tile's list. It is the descent of a quadtree over the screen, from coarse to fine
// (Warnock 1969, "A hidden surface algorithm for computer generated halftone pictures"), with several of its
// levels a step: frame, tile of 32 x 32, then block of 4 x 4 and pixel (pixels/block_draw-inl.h). Included
// once per Highway target.

#if defined(PLUMB_RASTER_TILE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_TILE_DRAW_INL_H_
#undef PLUMB_RASTER_TILE_DRAW_INL_H_
#else
#define PLUMB_RASTER_TILE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <span>

#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/block_draw-inl.h"
#include "pixels/candidate_draw-inl.h"
#include "pixels/no_tile_counts.h"
#include "pixels/tile_frame-inl.h"
#include "pixels/tile_planes-inl.h"
#include "raster/kernels.h"
#include "raster/tile_counts.h"
#include "raster/wide_draw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Whether all that the tile may see of the triangle is hidden.
HWY_INLINE bool Hidden(const TileEntry& entry, const TileState& state) {
  const int column0 = entry.x0() / kBlockPx, column1 = entry.x1() / kBlockPx;
  const int row0 = entry.y0() / kBlockPx * kTileBlocks, row1 = entry.y1() / kBlockPx * kTileBlocks;
  if (column1 - column0 > 1 || row1 - row0 > kTileBlocks) return entry.nearest < state.tile_low;
  const float* const low = state.block_low;
  const float least = std::min(std::min(low[row0 + column0], low[row0 + column1]),
                               std::min(low[row1 + column0], low[row1 + column1]));
  return entry.nearest < least;
}

HWY_INLINE void AddEntry(const TileView& view, MeshView mesh, const TileEntry& entry, SetupCandidates& to) {
  const glm::uvec3& c = mesh.triangles[entry.index];
  const glm::vec3* const vertex[3] = {&mesh.positions[c.x], &mesh.positions[c.y], &mesh.positions[c.z]};
  const size_t i = to.count++;
  for (int v = 0; v < 3; ++v) {
    to.corner[3 * v][i] = vertex[v]->x;
    to.corner[3 * v + 1][i] = vertex[v]->y;
    to.corner[3 * v + 2][i] = vertex[v]->z;
  }
  to.x0[i] = view.x + entry.x0();
  to.y0[i] = view.y + entry.y0();
  to.x1[i] = view.x + entry.x1();
  to.y1[i] = view.y + entry.y1();
  to.nearest[i] = entry.nearest;
  to.index[i] = entry.index;
}

// Fetches what a run's triangles are made of, all at once rather than one after the other.
HWY_INLINE void FetchTriangles(MeshView mesh, const EntryRun& run) {
  for (const TileEntry& entry : run.entries) hwy::Prefetch(&mesh.triangles[entry.index]);
}

HWY_INLINE void FetchVertices(MeshView mesh, const EntryRun& run) {
  for (const TileEntry& entry : run.entries) {
    const glm::uvec3& c = mesh.triangles[entry.index];
    hwy::Prefetch(&mesh.positions[c.x]);
    hwy::Prefetch(&mesh.positions[c.y]);
    hwy::Prefetch(&mesh.positions[c.z]);
  }
}

HWY_INLINE void FetchEntries(const EntryRun& run) {
  const auto* const bytes = reinterpret_cast<const char*>(run.entries.data());
  for (size_t offset = 0; offset < run.entries.size_bytes(); offset += 64) hwy::Prefetch(bytes + offset);
}

// Draws the triangles of the tile's lists.
template <class State, class Counts>
HWY_INLINE void DrawLists(const TileJob& job, const MeshTriangles& mesh, State& state, Counts& counts) {
  SetupCandidates candidates;
  candidates.count = 0;
  const auto draw = [&]() HWY_ATTR {
    DrawCandidates(job.projection, job.view, mesh, candidates, 0, candidates.count, state, counts);
    candidates.count = 0;
    UpdateLows(state);
  };
  const std::vector<EntryRun>& runs = job.contents.runs;
  if (!runs.empty()) FetchTriangles(mesh.mesh, runs[0]);
  if (runs.size() > 1) FetchEntries(runs[1]);
  for (size_t r = 0; r < runs.size(); ++r) {
    const EntryRun& run = runs[r];
    if (run.nearest < state.tile_low) {  // and all that follow
      for (; r < runs.size(); ++r) {
        for (size_t i = 0; i < runs[r].entries.size(); ++i) counts.tile(true);
      }
      break;
    }
    if (r + 2 < runs.size()) FetchEntries(runs[r + 2]);
    FetchVertices(mesh.mesh, run);
    if (r + 1 < runs.size()) FetchTriangles(mesh.mesh, runs[r + 1]);
    for (const TileEntry& entry : run.entries) {
      const bool hidden = Hidden(entry, state);
      counts.tile(hidden);
      if (hidden) continue;
      AddEntry(job.view, mesh.mesh, entry, candidates);
      if (candidates.count == hn::Lanes(SetupTag())) draw();
    }
  }
  if (candidates.count != 0) draw();
}

template <class State, class Counts>
HWY_INLINE void DrawContents(const TileJob& job, const MeshTriangles& mesh, State& state, Counts& counts) {
  for (const SortedList& list : job.contents.sorted) DrawSorted(job, mesh, list, state, counts);
  DrawWideList(job, mesh, job.contents.wide, state, counts);
  UpdateLows(state);
  DrawLists(job, mesh, state, counts);
}

template <class Counts>
HWY_INLINE void DrawFrame(const TileJob& job, const MeshTriangles& mesh, Frame& frame, Counts& counts) {
  if (job.contents.empty()) {
    ClearTile(job.view, frame);
    return;
  }
  TileState state;
  if (job.fresh) {
    StartTile(job.view, state);
  } else {
    LoadTile(job.view, frame, state);
  }
  DrawContents(job, mesh, state, counts);
  StoreTile(job.view, mesh, state, frame);
}

inline void DrawLayers(const TileJob& job, const MeshTriangles& mesh, LayeredFrame& frame) {
  NoTileCounts counts;
  LayeredTile tile;
  StartTile(job.view, tile);
  PartBlocks(tile);
  load_entries(job.view, frame, tile);
  for (int block = 0; block < kTileBlocks * kTileBlocks; ++block) SetBounds(tile, block, 0xffffu);
  HideOutside(tile);
  tile.changed = ~std::uint64_t{0};
  UpdateLows(tile);
  DrawContents(job, mesh, tile, counts);
  store_entries(job.view, tile, frame);
}

inline void DrawTile(const TileJob& job, const MeshTriangles& mesh, Frame& frame) {
  NoTileCounts counts;
  DrawFrame(job, mesh, frame, counts);
}

// The same, counted: out of line, so that it costs the other nothing.
HWY_NOINLINE inline void CountTile(const TileJob& job, const MeshTriangles& mesh, Frame& frame,
                                   RasterCounts& counts) {
  TileCounts counter{counts};
  DrawFrame(job, mesh, frame, counter);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
