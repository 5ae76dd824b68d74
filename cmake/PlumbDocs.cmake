# The target `docs`: the reference of the public headers, in docs/html of the build folder; and a test
# that nothing in it is undocumented. Only where Doxygen is there, and only in plumb's own build.
if(PROJECT_IS_TOP_LEVEL)
  find_program(PLUMB_DOXYGEN doxygen)
  mark_as_advanced(PLUMB_DOXYGEN)
  if(PLUMB_DOXYGEN)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/docs ${PROJECT_BINARY_DIR}/docs-test)
    set(PLUMB_DOCS_COMMAND ${PLUMB_DOXYGEN} ${PROJECT_SOURCE_DIR}/docs/Doxyfile)
    add_custom_target(docs
      COMMAND ${CMAKE_COMMAND} -E env PLUMB_DOCS_OUT=${PROJECT_BINARY_DIR}/docs ${PLUMB_DOCS_COMMAND}
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
      COMMENT "Writing the reference to ${PROJECT_BINARY_DIR}/docs/html"
      VERBATIM)
    if(PLUMB_BUILD_TESTS)
      add_test(NAME reference_test
        COMMAND ${CMAKE_COMMAND} -E env PLUMB_DOCS_OUT=${PROJECT_BINARY_DIR}/docs-test ${PLUMB_DOCS_COMMAND}
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    endif()
  endif()
endif()
