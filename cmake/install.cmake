# `cmake --install`: libraries, headers, the tool, and the package files that find_package(blum) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(layers GLOBAL PROPERTY BLUM_LAYERS)
list(TRANSFORM layers PREPEND blum_ OUTPUT_VARIABLE targets)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/blum)

install(TARGETS ${targets} blum_blum EXPORT blumTargets)
install(EXPORT blumTargets NAMESPACE blum:: DESTINATION ${package_dir})
install(DIRECTORY include/blum DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(BLUM_HAS_CUDA)
  install(TARGETS blum_cuda LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
if(BLUM_CLI)
  install(TARGETS blum_cli)
endif()

configure_package_config_file(cmake/blumConfig.cmake.in ${PROJECT_BINARY_DIR}/blumConfig.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/blumConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/blumConfig.cmake ${PROJECT_BINARY_DIR}/blumConfigVersion.cmake
        DESTINATION ${package_dir})
