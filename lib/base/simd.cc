#include "plumb/simd.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "base/simd_dispatch.h"
#include "hwy/targets.h"
#include "plumb/error.h"

namespace plumb {
namespace {

struct Entry {
  Simd simd;
  std::int64_t target;
  std::string_view name;
};

// Best first, as Highway orders its bits within one architecture.
constexpr Entry kEntries[] = {
    {Simd::Avx3Dl, HWY_AVX3_DL, "avx3_dl"},
    {Simd::Avx3, HWY_AVX3, "avx3"},
    {Simd::Avx2, HWY_AVX2, "avx2"},
    {Simd::Sse4, HWY_SSE4, "sse4"},
    {Simd::Ssse3, HWY_SSSE3, "ssse3"},
    {Simd::Sve2_128, HWY_SVE2_128, "sve2_128"},
    {Simd::Sve256, HWY_SVE_256, "sve_256"},
    {Simd::Sve2, HWY_SVE2, "sve2"},
    {Simd::Sve, HWY_SVE, "sve"},
    {Simd::Neon, HWY_NEON, "neon"},
    {Simd::Wasm, HWY_WASM, "wasm"},
    {Simd::Emu128, HWY_EMU128, "emu128"},
    {Simd::Scalar, HWY_SCALAR, "scalar"},
};

std::int64_t usable_targets() {
  // Asked once: it executes CPUID, which a virtual machine traps, and every tree asks. The fallback
  // without vector instructions runs everywhere, though Highway lists it only where it is the baseline.
  static const std::int64_t usable = HWY_TARGETS & (hwy::SupportedTargets() | HWY_SCALAR | HWY_EMU128);
  return usable;
}

}  // namespace

std::vector<Simd> simd_targets() {
  const std::int64_t usable = usable_targets();
  std::vector<Simd> targets;
  for (const Entry& entry : kEntries) {
    if ((entry.target & usable) != 0) targets.push_back(entry.simd);
  }
  return targets;
}

std::string_view simd_name(Simd simd) {
  for (const Entry& entry : kEntries) {
    if (entry.simd == simd) return entry.name;
  }
  return "auto";
}

Simd parse_simd(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower == "auto") return Simd::Auto;
  for (const Entry& entry : kEntries) {
    if (entry.name == lower) return entry.simd;
  }
  std::string message = "plumb: unknown SIMD target '" + std::string(name) + "'; this machine has: auto";
  for (const Simd simd : simd_targets()) message.append(", ").append(simd_name(simd));
  throw Error(message);
}

namespace detail {

std::int64_t highway_target(Simd simd) {
  for (const Entry& entry : kEntries) {
    if (entry.simd == simd) return entry.target;
  }
  throw Error("plumb: a SIMD target was used before it was resolved; please report this");
}

Simd resolve_simd(Simd simd) {
  const std::vector<Simd> targets = simd_targets();
  if (simd == Simd::Auto) return targets.front();
  if (std::find(targets.begin(), targets.end(), simd) != targets.end()) return simd;
  std::string message = "plumb: SIMD target '" + std::string(simd_name(simd)) +
                        "' is not in this build or cannot run on this machine; it has:";
  for (const Simd t : targets) message.append(" ").append(simd_name(t));
  throw Error(message);
}

}  // namespace detail
}  // namespace plumb
