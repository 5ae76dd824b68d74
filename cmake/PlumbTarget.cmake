# What every target of plumb is compiled with. Nothing here reaches a user's own targets.

# Warnings, as errors where asked for.
function(plumb_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor)
  if(PLUMB_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# Flags for code that decides what is visible (docs/visibility.md says why): no fused multiply-add
# unless written, and without GCC's SLP vectorizer, which drops double-to-float roundings.
function(plumb_exact_arithmetic target)
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-tree-slp-vectorize)
endfunction()

# The instruction sets that kernels are compiled for: all, so that each can be named, compared and timed
# on one machine, but for those of PLUMB_DISABLED_SIMD.
function(plumb_simd_targets target)
  target_compile_definitions(${target} PRIVATE HWY_COMPILE_ALL_ATTAINABLE)
  if(PLUMB_DISABLED_SIMD)
    target_compile_definitions(${target} PRIVATE "HWY_DISABLED_TARGETS=(${PLUMB_DISABLED_SIMD})")
  endif()
endfunction()

# plumb_library(NAME ARCHIVE SOURCES...): an archive of the library with its alias plumb::NAME.
function(plumb_library name archive)
  add_library(${archive} STATIC ${ARGN})
  add_library(plumb::${name} ALIAS ${archive})
  set_target_properties(${archive} PROPERTIES
    EXPORT_NAME ${name} OUTPUT_NAME ${archive} POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  target_compile_features(${archive} PUBLIC cxx_std_20)
  target_include_directories(${archive} PRIVATE ${PROJECT_SOURCE_DIR}/lib ${PROJECT_SOURCE_DIR}/raster)
  plumb_simd_targets(${archive})
  plumb_warnings(${archive})
  plumb_exact_arithmetic(${archive})
endfunction()
