# `cmake --install` puts libraries, headers, the command and what ships; `find_package(pliant)` then finds them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS pliant_options pliant_runtime pliant_components pliant_systems pliant_visual pliant_level pliant_content pliant_engine EXPORT pliant-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS pliant RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY runtime components systems content engine DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pliant
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY shaders/shared DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pliant/shaders)  # headers include this arithmetic
install(DIRECTORY content/levels content/environments DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant/content OPTIONAL)
install(DIRECTORY shaders DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant)
install(EXPORT pliant-targets NAMESPACE pliant:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
configure_package_config_file(cmake/pliant-config.cmake.in ${CMAKE_BINARY_DIR}/pliant-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pliant-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/pliant-config.cmake ${CMAKE_BINARY_DIR}/pliant-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
