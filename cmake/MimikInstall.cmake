include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/mimikConfig.cmake.in ${PROJECT_BINARY_DIR}/mimikConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mimik)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mimikConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT mimikTargets NAMESPACE mimik:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mimik)
install(FILES ${PROJECT_BINARY_DIR}/mimikConfig.cmake ${PROJECT_BINARY_DIR}/mimikConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/MimikDependencies.cmake ${PROJECT_SOURCE_DIR}/cmake/MimikAdapters.cmake
  ${PROJECT_SOURCE_DIR}/cmake/MimikFigureDependencies.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mimik)
