# GNU MP with its C++ interface: the targets GMP::gmp and GMP::gmpxx. Debian's libgmp-dev brings no
# CMake package of its own.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(GMP_PC QUIET gmpxx)
endif()
# Debian has gmp.h in the machine's own folder and gmpxx.h in the common one.
find_path(GMP_INCLUDE_DIR gmp.h HINTS ${GMP_PC_INCLUDE_DIRS})
find_path(GMPXX_INCLUDE_DIR gmpxx.h HINTS ${GMP_PC_INCLUDE_DIRS})
find_library(GMP_LIBRARY gmp HINTS ${GMP_PC_LIBRARY_DIRS})
find_library(GMPXX_LIBRARY gmpxx HINTS ${GMP_PC_LIBRARY_DIRS})
mark_as_advanced(GMP_INCLUDE_DIR GMPXX_INCLUDE_DIR GMP_LIBRARY GMPXX_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GMP
  REQUIRED_VARS GMP_LIBRARY GMPXX_LIBRARY GMP_INCLUDE_DIR GMPXX_INCLUDE_DIR
  VERSION_VAR GMP_PC_VERSION)

if(GMP_FOUND AND NOT TARGET GMP::gmp)
  add_library(GMP::gmp UNKNOWN IMPORTED)
  set_target_properties(GMP::gmp PROPERTIES
    IMPORTED_LOCATION ${GMP_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${GMP_INCLUDE_DIR})
  add_library(GMP::gmpxx UNKNOWN IMPORTED)
  set_target_properties(GMP::gmpxx PROPERTIES
    IMPORTED_LOCATION ${GMPXX_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${GMPXX_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES GMP::gmp)
endif()
