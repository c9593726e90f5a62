# One target a folder; the link list of a target is the layer rule (tests/layout checks every #include against it).

# Flags of all our own code. No FMA contraction: a*b + c*d must round the same way on both sides of a mirror.
add_library(weir_flags INTERFACE)
target_compile_options(weir_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror -ffp-contract=off -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(weir_flags INTERFACE -Wno-restrict)  # false alarm on "text" + std::string (GCC bug 105651)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(weir_flags INTERFACE -Wno-pass-failed)  # a loop that clang cannot vectorise is slower, not wrong
endif()
if(WEIR_NATIVE)
  target_compile_options(weir_flags INTERFACE -march=native)
endif()
# Where registers are narrower than the vectors of 8 numbers in our loops, GCC warns that such arguments would be passed in another way
# elsewhere (-Wpsabi): all functions that take them are inlined, or built like those that call them.
include(CheckCXXSourceCompiles)
if(WEIR_NATIVE)
  set(CMAKE_REQUIRED_FLAGS -march=native)
else()
  set(CMAKE_REQUIRED_FLAGS "")
endif()
check_cxx_source_compiles("#ifndef __AVX512F__\n#error\n#endif\nint main() {}" WEIR_WIDE_REGISTERS)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT WEIR_WIDE_REGISTERS)
  target_compile_options(weir_flags INTERFACE -Wno-psabi)
endif()
if(WEIR_SANITIZE MATCHES "thread" AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "WEIR_SANITIZE=thread requires clang: the sanitizer does not see the barriers of GCC's OpenMP, and every threaded loop would be reported as a race")
endif()
if(WEIR_SANITIZE)
  target_compile_options(weir_flags INTERFACE -fsanitize=${WEIR_SANITIZE} -fno-omit-frame-pointer)
  target_compile_definitions(weir_flags INTERFACE _GLIBCXX_ASSERTIONS)  # an index past size() and within the capacity is no error of memory
  target_link_options(weir_flags INTERFACE -fsanitize=${WEIR_SANITIZE})
endif()

set_property(GLOBAL PROPERTY WEIR_LIBRARIES "")

# weir_unity(TARGET)  compiles the sources of a target together: where headers cost more than the code below them. Not for hot loops, whose
# files say how each is compiled.
function(weir_unity target)
  if(WEIR_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# weir_library(NAME [UNITY] SOURCES a.cpp ... LINKS weir::core ... PRIVATE_LINKS ...)  builds the static library weir_NAME, known as weir::NAME.
function(weir_library name)
  cmake_parse_arguments(arg "UNITY" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(weir_${name} STATIC ${arg_SOURCES})
  if(arg_UNITY)
    weir_unity(weir_${name})
  endif()
  add_library(weir::${name} ALIAS weir_${name})
  set_target_properties(weir_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(weir_${name} PUBLIC cxx_std_20)
  target_include_directories(weir_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/solvers> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(weir_${name} PUBLIC ${arg_LINKS} PRIVATE $<BUILD_INTERFACE:weir_flags> ${arg_PRIVATE_LINKS})
  set_property(GLOBAL APPEND PROPERTY WEIR_LIBRARIES weir_${name})
endfunction()

# weir_test_program(KIND NAME SOURCES a.cpp ... LINKS ...)  builds the program of tests KIND_NAME, which no ctest entry runs yet.
function(weir_test_program kind name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${kind}_${name} ${arg_SOURCES})
  target_include_directories(${kind}_${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${kind}_${name} PRIVATE weir_flags weir_test_main ${arg_LINKS})
  target_compile_options(${kind}_${name} PRIVATE $<$<CONFIG:Release>:-O1>)  # what is tested is optimised; what tests it need not be
  set_property(GLOBAL APPEND PROPERTY WEIR_${kind}_PROGRAMS ${kind}_${name})
  target_compile_definitions(${kind}_${name} PRIVATE WEIR_SOURCE_DIR="${PROJECT_SOURCE_DIR}" WEIR_BINARY_DIR="${PROJECT_BINARY_DIR}")
endfunction()

# weir_test(KIND NAME SOURCES a.cpp ... LINKS ... [LABELS ...] [ENVIRONMENT ...])  builds one program KIND_NAME; each source file is one
# ctest entry, named KIND.NAME.file, that runs the tests of that file. On one thread unless a test sets more: ctest runs several beside each
# other. Unit tests are compiled together, each file in a namespace of its own. An entry of which a test is skipped is skipped (tests/support/main.cpp). Threads that wait spin for as long as a pass takes, then sleep, as those of the executable do: to wake is slow.
function(weir_test kind name)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;LINKS;LABELS;ENVIRONMENT" ${ARGN})
  weir_test_program(${kind} ${name} SOURCES ${arg_SOURCES} LINKS ${arg_LINKS})
  if(WEIR_UNITY AND kind STREQUAL "unit")
    weir_unity(${kind}_${name})
    target_compile_definitions(${kind}_${name} PRIVATE WEIR_TESTS_JOINED)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  foreach(source ${arg_SOURCES})
    get_filename_component(stem ${source} NAME_WE)
    add_test(NAME ${kind}.${name}.${stem} COMMAND ${kind}_${name} --gtest_filter=${stem}.* --gtest_brief=1)
    set_tests_properties(${kind}.${name}.${stem} PROPERTIES LABELS "${kind};${arg_LABELS}" TIMEOUT ${arg_TIMEOUT}
      SKIP_RETURN_CODE 77 ENVIRONMENT "OMP_NUM_THREADS=1;GOMP_SPINCOUNT=1000;${arg_ENVIRONMENT}")
  endforeach()
endfunction()
