#pragma once

#include <string_view>
#include <vector>

namespace plumb {

/// Instruction sets that kernels are compiled for. Which of them this build holds and this machine
/// can run is `simd_targets()`. Every one returns the same bits; only the speed differs.
enum class Simd {
  Auto,      ///< the best that this machine can run
  Scalar,    ///< one lane, no vector instructions
  Emu128,    ///< 128-bit vectors emulated in plain C++
  Ssse3,     ///< x86, 128 bits
  Sse4,      ///< x86, 128 bits
  Avx2,      ///< x86, 256 bits, with FMA
  Avx3,      ///< x86, AVX-512 (F, BW, CD, DQ, VL)
  Avx3Dl,    ///< x86, AVX-512 as of Ice Lake
  Neon,      ///< Arm, 128 bits
  Sve,       ///< Arm, scalable
  Sve2,      ///< Arm, scalable
  Sve256,    ///< Arm, 256 bits
  Sve2_128,  ///< Arm, 128 bits
  Wasm,      ///< WebAssembly, 128 bits
};

/// The targets that this build was compiled for and this machine can run, best first. Never empty,
/// never holds Auto.
std::vector<Simd> simd_targets();

/// The target's name in lower case, as the tool's `--simd` takes it: "auto", "avx2", ...
std::string_view simd_name(Simd simd);

/// The inverse of `simd_name` (any case). Throws plumb::Error for a name that is none.
Simd parse_simd(std::string_view name);

}  // namespace plumb
