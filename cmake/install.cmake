# `cmake --install` installs libraries, public headers, the command and content. The installation is relocatable.
# find_package(pliant COMPONENTS ...) provides pliant::COMPONENT: `engine` needs neither OpenGL nor file readers,
# `content` reads and writes level files, `visual` renders, `devices` contains the drivers, `c` is the C interface. Targets named internal_* are
# parts of these.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/pliant)
set(installed)
function(pliant_component name)
  install(TARGETS ${ARGN} EXPORT pliant-${name}-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev)
  install(EXPORT pliant-${name}-targets NAMESPACE pliant:: DESTINATION ${package} COMPONENT dev)
  set(installed ${installed} ${ARGN} PARENT_SCOPE)
endfunction()
pliant_component(engine pliant_options pliant_runtime pliant_components pliant_systems pliant_level pliant_devices pliant_engine)
set_target_properties(pliant_options PROPERTIES EXPORT_NAME internal_options)
if(NOT PLIANT_ENGINE_ONLY)
  pliant_component(devices pliant_drivers)
  pliant_component(content pliant_content)
  pliant_component(visual pliant_visual pliant_picture)
endif()
if(PLIANT_C)
  pliant_component(c pliant_c)
  file(RELATIVE_PATH pliant_prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(cmake/pliant.pc.in ${PROJECT_BINARY_DIR}/pliant.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pliant.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endif()

install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
if(PLIANT_COMMAND)
  # `./dev run` builds only the command; files installed with it are built with it.
  list(REMOVE_ITEM installed pliant_options)
  add_dependencies(pliant ${installed})
  file(RELATIVE_PATH libraries /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(pliant PROPERTIES INSTALL_RPATH "$<$<BOOL:${BUILD_SHARED_LIBS}>:$ORIGIN/${libraries}>")
  install(TARGETS pliant RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
  install(DIRECTORY content/levels content/environments content/samples DESTINATION ${CMAKE_INSTALL_DATADIR}/pliant/content
          COMPONENT command OPTIONAL)
  # Who sits at the machine may open its devices. udev looks in this folder whatever the prefix is: a package's is /usr.
  install(FILES devices/70-pliant.rules DESTINATION lib/udev/rules.d COMPONENT command)
  include(packaging/desktop.cmake)
endif()
configure_package_config_file(cmake/pliant-config.cmake.in ${PROJECT_BINARY_DIR}/pliant-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pliant-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pliant-config.cmake ${PROJECT_BINARY_DIR}/pliant-config-version.cmake
        DESTINATION ${package} COMPONENT dev)
if(PLIANT_COMMAND AND PLIANT_C)
  include(packaging/debian.cmake)
endif()
