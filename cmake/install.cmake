# cmake --install: the library for find_package(weir), its public headers as <weir/...> and no others, the executable.
include(CMakePackageConfigHelpers)
set(weir_package ${CMAKE_INSTALL_LIBDIR}/cmake/weir)
get_property(libraries GLOBAL PROPERTY WEIR_LIBRARIES)
install(TARGETS ${libraries} EXPORT weirTargets COMPONENT library)
set(WEIR_PUBLIC_HEADERS
  sim/simulation.hpp sim/probes.hpp sim/registry.hpp sim/thread_choice.hpp                           # a scene in, steps, fields and probes out
  scene/scene.hpp scene/schema.hpp scene/solver_kind.hpp                          # what a scene may say, and a solver of one's own
  core/solver.hpp core/effects.hpp core/brush.hpp core/passes.hpp core/checkpoint.hpp core/error.hpp core/types.hpp core/parallel.hpp core/exact_sum.hpp
  scene/replicated_work.hpp output/frames.hpp output/frame_format.hpp output/series_index.hpp)                                                              # VTK series
install(CODE "set(headers \"${WEIR_PUBLIC_HEADERS}\")\nset(from \"${PROJECT_SOURCE_DIR}/solvers\")\nset(to \"${CMAKE_INSTALL_INCLUDEDIR}/weir\")" COMPONENT library)
install(SCRIPT cmake/install_headers.cmake COMPONENT library)
install(EXPORT weirTargets NAMESPACE weir:: DESTINATION ${weir_package} COMPONENT library)
configure_package_config_file(cmake/weirConfig.cmake.in ${PROJECT_BINARY_DIR}/weirConfig.cmake INSTALL_DESTINATION ${weir_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/weirConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/weirConfig.cmake ${PROJECT_BINARY_DIR}/weirConfigVersion.cmake DESTINATION ${weir_package} COMPONENT library)
