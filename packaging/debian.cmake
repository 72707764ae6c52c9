# Debian packages by `cpack -G DEB` (`./dev package`): libpliant0, libpliant-dev, pliant, and python3-pliant where the
# Python package is built.
set(CPACK_GENERATOR DEB)
set(PLIANT_MAINTAINER "The Pliant contributors <noreply@pliant.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT "${PLIANT_MAINTAINER}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "visuo-haptic engine: touch soft things, feel the force")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL library dev command)
if(TARGET pliant_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libpliant0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "A probe or tool touches soft objects, and its force is computed at 1 kHz.
This package has the shared library with the C interface.")
# Beside CPack's scripts that call ldconfig, Debian's trigger.
file(WRITE ${PROJECT_BINARY_DIR}/packaging/triggers "activate-noawait ldconfig\n")
file(WRITE ${PROJECT_BINARY_DIR}/packaging/shlibs "libpliant 0 libpliant0 (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/packaging/triggers ${PROJECT_BINARY_DIR}/packaging/shlibs)

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpliant-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libpliant0 (= ${PROJECT_VERSION}), libglm-dev, libfmt-dev, libmetis-dev, libdraco-dev, libopenexr-dev, libassimp-dev, libpng-dev, libjpeg-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libgl-dev, libegl-dev, libopengl-dev, libepoxy-dev, libhidapi-dev, libusb-1.0-0-dev, libwebsockets-dev, libssl-dev, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "A probe or tool touches soft objects, and its force is computed at 1 kHz.
This package has the C header pliant.h, the C++ headers and static libraries,
the CMake package and the pkg-config file.")

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME pliant)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri, fonts-inter, fonts-dejavu-core, fonts-droid-fallback")
set(CPACK_DEBIAN_COMMAND_DESCRIPTION "Runs and edits levels of soft and rigid objects that probes, tools and haptic
 devices touch; imports any mesh, measures forces, and writes pictures, plots
and reports.")

# For the interpreter that it is built for. The command has the shipped levels, and what fit, study, sweep and plot run.
if(TARGET pliant_python)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-pliant)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "pliant, libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib")
# Its compiled files, which Debian's tools make and take away.
foreach(script postinst=py3compile prerm=py3clean)
  string(REPLACE "=" ";" script ${script})
  list(POP_BACK script tool)
  file(WRITE ${PROJECT_BINARY_DIR}/packaging/python/${script}
       "#!/bin/sh\nset -e\nif command -v ${tool} >/dev/null 2>&1; then ${tool} -p python3-pliant; fi\n")
  file(CHMOD ${PROJECT_BINARY_DIR}/packaging/python/${script} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
       GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  list(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/packaging/python/${script})
endforeach()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Scenes, sessions and batches from Python with numpy arrays, psychophysical
experiments, drivers and force laws of your own, pictures and a window.")
install(FILES packaging/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME libpliant0 COMPONENT library)

# Text that Debian asks of each package.
if(DEFINED ENV{SOURCE_DATE_EPOCH})
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
else()
  set(date "Thu, 01 Jan 1970 00:00:00 +0000")
endif()
find_program(PLIANT_GZIP gzip)
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(name ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(folder ${PROJECT_BINARY_DIR}/packaging/${name})
  file(WRITE ${folder}/changelog "pliant (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * CHANGELOG.md of the sources.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  execute_process(COMMAND ${PLIANT_GZIP} -9nf ${folder}/changelog)
  set(apart)
  if(component STREQUAL "python")  # as its module: not part of `cmake --install`
    set(apart EXCLUDE_FROM_ALL)
  endif()
  install(FILES ${folder}/changelog.gz packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component}
          ${apart})
endforeach()
include(CPack)
