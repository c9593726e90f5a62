# Makes the meshes of cases/shapes anew, and compares.
file(MAKE_DIRECTORY ${OUT})
execute_process(COMMAND ${PYTHON} ${SHAPES}/make_shapes.py ${OUT} COMMAND_ERROR_IS_FATAL ANY)
foreach(name duck boat buoy)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${OUT}/${name}.ply ${SHAPES}/${name}.ply RESULT_VARIABLE differs)
  if(differs)
    message(FATAL_ERROR "${name}.ply is not what make_shapes.py makes: run it in cases/shapes")
  endif()
endforeach()
