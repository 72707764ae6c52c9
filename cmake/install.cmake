# `cmake --install` puts libraries, public headers, the command and what ships. find_package(pliant COMPONENTS engine
# content visual devices) then finds them: `engine` needs neither OpenGL nor a reader of files, `content` reads and writes level
# files, `visual` draws.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
function(pliant_component name)
  install(TARGETS ${ARGN} EXPORT pliant-${name}-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT pliant-${name}-targets NAMESPACE pliant:: DESTINATION ${package})
endfunction()
pliant_component(engine pliant_options pliant_runtime pliant_components pliant_systems pliant_level pliant_devices pliant_engine)
pliant_component(devices pliant_drivers)
pliant_component(content pliant_content)
pliant_component(visual pliant_visual pliant_picture)

install(DIRECTORY include/pliant DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS pliant RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY content/levels content/environments DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant/content OPTIONAL)
# Who sits at the machine may open its devices. udev looks in this folder whatever the prefix is: a package's is /usr.
install(FILES devices/70-pliant.rules DESTINATION lib/udev/rules.d)
install(DIRECTORY shaders DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant)
configure_package_config_file(cmake/pliant-config.cmake.in ${CMAKE_BINARY_DIR}/pliant-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pliant-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/pliant-config.cmake ${CMAKE_BINARY_DIR}/pliant-config-version.cmake
        DESTINATION ${package})
