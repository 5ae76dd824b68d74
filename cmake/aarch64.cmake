# Toolchain file: cross-compiles for AArch64 with Debian's g++-aarch64-linux-gnu and runs under qemu-user.
# The libraries are in PLUMB_ARM_SYSROOT, which tools/arm-sysroot fills; libc and libstdc++ are the compiler's.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

set(PLUMB_ARM_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../build/arm-sysroot CACHE PATH "arm64 packages, unpacked")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES PLUMB_ARM_SYSROOT)
get_filename_component(_sysroot ${PLUMB_ARM_SYSROOT} ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH ${_sysroot} ${_sysroot}/usr)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,-rpath-link,${_sysroot}/usr/lib/aarch64-linux-gnu)

# Every instruction set there is, SVE2 among them.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64;-cpu;max;-L;/usr/aarch64-linux-gnu)
