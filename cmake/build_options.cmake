# Flags of everything in this project; who links to the libraries gets none of them, in the same build tree or installed.
include_directories(${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
if(PROJECT_IS_TOP_LEVEL)
  add_compile_options(-Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers -Werror)
endif()
# No contraction into fused multiply-add: the same bits on every machine (lockstep). Nobody reads errno after sqrt or
# traps on a comparison; knowing that lets loops become SIMD, without changing a bit.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)
# A library that is position-independent may still inline its own functions, as a program does.
add_compile_options(-fno-semantic-interposition)
# What is built says nothing of where: assertions name files within the project. Only the debug build keeps whole paths
# for its debugger.
add_compile_options("$<IF:$<CONFIG:Debug>,-fmacro-prefix-map,-ffile-prefix-map>=${PROJECT_BINARY_DIR}/="
                    "$<IF:$<CONFIG:Debug>,-fmacro-prefix-map,-ffile-prefix-map>=${PROJECT_SOURCE_DIR}/=")
# GCC 12 sees overlaps in std::string that cannot be (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-restrict)
endif()
# Twelve source files are compiled as one (CMAKE_UNITY_BUILD, set by the presets): most of the time of a small file goes
# into the headers that it includes. A name in an unnamed namespace must then be unique within its library. What one file
# names so is then outside the next, where a local of that name is no mistake: shadowing is looked for by the debug build,
# file by file. GCC takes an unnamed namespace in an included file for one in a header.
if(CMAKE_UNITY_BUILD)
  add_compile_options(-Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# A driver's thread may have a function of its own that is called as the maker's loop is (Driver::run).
add_compile_options($<$<CXX_COMPILER_ID:Clang>:-Wno-overloaded-virtual>)

# What who links to a library of ours needs, too.
add_library(pliant_options INTERFACE)
target_compile_features(pliant_options INTERFACE cxx_std_20)
target_include_directories(pliant_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                    $<INSTALL_INTERFACE:include>)
if(PLIANT_VALIDATE)
  add_compile_definitions(PLIANT_VALIDATE)
endif()
if(PLIANT_SANITIZE)
  add_compile_options(-fsanitize=${PLIANT_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(pliant_options INTERFACE -fsanitize=${PLIANT_SANITIZE})
  add_link_options(-fsanitize=${PLIANT_SANITIZE})
  add_compile_definitions(PLIANT_SANITIZED)
  if(PLIANT_SANITIZE MATCHES "undefined")
    # Checks of every pointer that is followed or computed: they double the time that Eigen takes to compile, and what
    # they find the address sanitizer mostly stops at too.
    add_compile_options(-fno-sanitize=null,object-size,alignment,pointer-overflow)
    # A maker's library is called through types of ours, which are not the ones that it was compiled with.
    add_compile_options($<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=function>)
    # What is found ends the program: nobody reads what a test that passes has printed.
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

# Code that runs a few times, where the compiler's time weighs more than its own: tests, and under the sanitizers all that
# stands around the engine.
function(pliant_compile_fast target)
  if(PLIANT_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  else()
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()

# A library of one folder and its subfolders:
#   pliant_library(NAME DEPENDS libraries... EXCEPT folders... ALSO other folders or files...)
function(pliant_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;EXCEPT;ALSO" ${ARGN})
  set(here ${CMAKE_CURRENT_SOURCE_DIR})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${here}/*.cpp)
  foreach(path ${ARG_EXCEPT})
    list(FILTER sources EXCLUDE REGEX "^${here}/${path}[/.]")
  endforeach()
  foreach(path ${ARG_ALSO})
    file(GLOB_RECURSE more CONFIGURE_DEPENDS ${here}/${path}/*.cpp)
    if(path MATCHES "\\.cpp$")
      set(more ${here}/${path})
    endif()
    list(APPEND sources ${more})
  endforeach()
  add_library(pliant_${name} ${sources})  # BUILD_SHARED_LIBS says of which kind
  set_target_properties(pliant_${name} PROPERTIES EXPORT_NAME internal_${name} POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN"
    CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
  target_link_libraries(pliant_${name} PUBLIC pliant_options ${ARG_DEPENDS})
endfunction()

# What a program links to for a component of the package: pliant::COMPONENT, installed and in the same build tree.
function(pliant_component_target component target)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component})
  add_library(pliant::${component} ALIAS ${target})
endfunction()
