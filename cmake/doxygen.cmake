# cmake --build BUILD --target doxygen: BUILD/doxygen/html, of the headers that are installed; fails where one has a warning.
find_program(WEIR_DOXYGEN doxygen)
list(TRANSFORM WEIR_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/solvers/ OUTPUT_VARIABLE weir_doxygen_input)
list(JOIN weir_doxygen_input " " weir_doxygen_input)
string(PREPEND weir_doxygen_input "${PROJECT_SOURCE_DIR}/docs/doxygen/index.md ${PROJECT_SOURCE_DIR}/docs/doxygen/members.dox ")
configure_file(${PROJECT_SOURCE_DIR}/docs/doxygen/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
if(WEIR_DOXYGEN)
  add_custom_target(doxygen COMMAND ${WEIR_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile COMMENT "doxygen/html/index.html")
endif()
