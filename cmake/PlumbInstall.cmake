# Installs the archives, the headers and what find_package(plumb) and pkg-config need.
include(CMakePackageConfigHelpers)

set(PLUMB_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/plumb)

set(PLUMB_ARCHIVES plumb_raster plumb)  # in the order of linking
if(PLUMB_BUILD_IO)
  list(PREPEND PLUMB_ARCHIVES plumb_io)
endif()
install(TARGETS ${PLUMB_ARCHIVES} EXPORT plumbTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT plumbTargets NAMESPACE plumb:: DESTINATION ${PLUMB_CMAKE_DIR})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/plumb ${PROJECT_SOURCE_DIR}/raster/include/plumb
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_BINARY_DIR}/lib/include/plumb/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plumb)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/plumbConfig.cmake.in
  ${PROJECT_BINARY_DIR}/plumbConfig.cmake INSTALL_DESTINATION ${PLUMB_CMAKE_DIR})
# Before 1.0 a minor version may break what was built on the one before.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/plumbConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/plumbConfig.cmake ${PROJECT_BINARY_DIR}/plumbConfigVersion.cmake
  DESTINATION ${PLUMB_CMAKE_DIR})

if(PLUMB_BUILD_IO)
  set(PLUMB_PC_IO_REQUIRES " openmesh")
endif()
list(TRANSFORM PLUMB_ARCHIVES PREPEND "-l" OUTPUT_VARIABLE PLUMB_PC_LIBS)
list(JOIN PLUMB_PC_LIBS " " PLUMB_PC_LIBS)
# Relative to the file itself, so that the installed tree can be moved; absolute install folders stay.
file(RELATIVE_PATH PLUMB_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
cmake_path(APPEND PLUMB_PC_LIBDIR "\${prefix}" ${CMAKE_INSTALL_LIBDIR})
cmake_path(APPEND PLUMB_PC_INCLUDEDIR "\${prefix}" ${CMAKE_INSTALL_INCLUDEDIR})
configure_file(${CMAKE_CURRENT_LIST_DIR}/plumb.pc.in ${PROJECT_BINARY_DIR}/plumb.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/plumb.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
