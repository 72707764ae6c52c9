#!/usr/bin/env bash
# Pliant as a part of another project: only its own targets affect that project. Compiles only small files. Usage:
# subproject.sh SOURCES
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf '%s\n' "$*"; exit 1; }

# Code with warnings that Pliant's own flags would make errors; it gets glm and fmt through pliant::engine.
cat >"$work/host.cpp" <<'TEXT'
#include <pliant/pliant.h>
int host(int unused) {
  int narrow = 1.5 * 3;
  pliant::Scene scene;
  return narrow;
}
TEXT
cat >"$work/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(host LANGUAGES CXX)
include(FetchContent)
set(names CMAKE_CXX_STANDARD CMAKE_CXX_EXTENSIONS CMAKE_RUNTIME_OUTPUT_DIRECTORY CMAKE_EXPORT_COMPILE_COMMANDS BUILD_SHARED_LIBS
    BUILD_TESTING CMAKE_CXX_FLAGS CMAKE_POSITION_INDEPENDENT_CODE CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
foreach(name IN LISTS names)
  set(was_${name} "${${name}}")
endforeach()
if(FETCH)
  FetchContent_Declare(pliant SOURCE_DIR ${SOURCES})
  FetchContent_MakeAvailable(pliant)
else()
  add_subdirectory(${SOURCES} pliant EXCLUDE_FROM_ALL)
endif()
foreach(name IN LISTS names)
  if(NOT "${${name}}" STREQUAL "${was_${name}}")
    message(FATAL_ERROR "${name} has changed to '${${name}}'")
  endif()
endforeach()
foreach(property COMPILE_OPTIONS INCLUDE_DIRECTORIES COMPILE_DEFINITIONS)
  get_directory_property(value ${property})
  if(value)
    message(FATAL_ERROR "this folder's ${property} are now '${value}'")
  endif()
endforeach()
function(check_targets folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    if(NOT target MATCHES "^pliant(_|$)")
      message(FATAL_ERROR "a target is named '${target}'")
    endif()
    get_target_property(flags ${target} INTERFACE_COMPILE_OPTIONS)
    if(flags)
      message(FATAL_ERROR "'${target}' hands on the flags ${flags}")
    endif()
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(each IN LISTS folders)
    check_targets(${each})
  endforeach()
  get_property(tests DIRECTORY ${folder} PROPERTY TESTS)
  if(tests)
    message(FATAL_ERROR "it brings tests: ${tests}")
  endif()
endfunction()
check_targets(${SOURCES})
add_library(host_part OBJECT host.cpp)
target_link_libraries(host_part PRIVATE pliant::engine)
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/where.txt CONTENT "$<TARGET_FILE:pliant_runtime>")
TEXT

# Packages that the engine does not need are not searched.
unneeded=()
for package in draco TinyGLTF OpenEXR assimp OpenGL X11 CLI11 GTest benchmark PkgConfig; do
  unneeded+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
cmake -S "$work" -B "$work/build" -G Ninja -DSOURCES="$source" -DBUILD_SHARED_LIBS=ON -DPLIANT_ENGINE_ONLY=ON "${unneeded[@]}" \
  >"$work/configure.log" 2>&1 || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/build" -j 2 --target host_part pliant_runtime >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }

# BUILD_SHARED_LIBS is the project's own: obeyed, with a version, symbols that are seen, and neighbours found where it lies.
library=$(cat "$work/build/where.txt")
dynamic=$(readelf -d "$library") symbols=$(nm -DC "$library")
grep -q 'SONAME.*libpliant_runtime\.so\.0\.' <<<"$dynamic" || { echo "$dynamic"; fail "no SONAME with a version"; }
grep -q ' T pliant::set_log' <<<"$symbols" || fail "its functions are not seen"
grep -q 'INSTALL_RPATH\|RPATH_CHANGE' "$work"/build/pliant/cmake_install.cmake 2>/dev/null && fail "it brings install rules"

# The libraries alone, the default of a part, need no window. By FetchContent, and static.
cmake -S "$work" -B "$work/libraries" -G Ninja -DSOURCES="$source" -DFETCH=ON -DBUILD_SHARED_LIBS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DCMAKE_DISABLE_FIND_PACKAGE_X11=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON >"$work/configure.log" 2>&1 ||
  { cat "$work/configure.log"; exit 1; }
[[ $(cat "$work/libraries/where.txt") == *libpliant_runtime.a ]] || fail "BUILD_SHARED_LIBS=OFF is not obeyed"
echo "as it should be"
