# The executable and the programs of the unit tests, with the address and undefined-behaviour sanitizers.
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${SOURCE} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --preset asan -DWEIR_TESTS=ON -DWEIR_BENCHMARKS=OFF -DWEIR_PYTHON=OFF)
run(${CMAKE_COMMAND} --build ${BUILD} --target sanitized)
