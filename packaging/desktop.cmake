# Desktop entry, MIME type, icon; man pages and completions, which are made of `pliant --help` when it is installed.
install(FILES packaging/pliant.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT command)
install(FILES packaging/pliant.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT command)
install(FILES packaging/pliant.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT command)
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  set(help ${PROJECT_BINARY_DIR}/help)
  install(CODE "execute_process(COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/packaging/from_help.py $<TARGET_FILE:pliant> ${help}
                                COMMAND_ERROR_IS_FATAL ANY)" COMPONENT command)
  install(DIRECTORY ${help}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT command)
  install(FILES ${help}/pliant DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT command)
  install(FILES ${help}/_pliant DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT command)
endif()
