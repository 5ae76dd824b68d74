# Installs a build of plumb into a fresh folder and uses it from there: by find_package and by
# pkg-config. Called by ctest with
#   cmake -D PLUMB_BUILD=DIR -D WORK=DIR -D CONSUMER=DIR -D EXAMPLES=DIR -D CXX=COMPILER -D FLAGS=... -P run.cmake
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} --install ${PLUMB_BUILD} --prefix ${prefix})
# Moved, because an installed tree may hold no path of the machine that made it.
file(RENAME ${prefix} ${WORK}/moved)
set(prefix ${WORK}/moved)

foreach(installed bin/plumb share/bash-completion/completions/plumb
    include/plumb/plumb.h include/plumb/raster.h include/plumb/version.h)
  if(NOT EXISTS ${prefix}/${installed})
    message(FATAL_ERROR "${installed} was not installed")
  endif()
endforeach()
run(${prefix}/bin/plumb compare builtin:grid:4 --size 16x16)

run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/found -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/found)
run(${CMAKE_COMMAND} -E chdir ${WORK}/found ./consumer)
message(STATUS "find_package: ${output}")

run(${CMAKE_COMMAND} -S ${EXAMPLES} -B ${WORK}/examples -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/examples)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/examples --no-tests=error)
message(STATUS "examples: built and run")

find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB_RECURSE package ${prefix}/plumb.pc)
cmake_path(GET package PARENT_PATH package_folder)
set(ENV{PKG_CONFIG_PATH} ${package_folder})
run(${PKG_CONFIG} --cflags --libs plumb)
separate_arguments(package_flags UNIX_COMMAND "${output}")
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
run(${CXX} -std=c++20 ${flags} -DCONSUMER_READS_MESHES ${CONSUMER}/main.cc ${CONSUMER}/seer.cc
  -o ${WORK}/by-pkg-config ${package_flags})
run(${CMAKE_COMMAND} -E chdir ${WORK} ./by-pkg-config)
message(STATUS "pkg-config: ${output}")
