# Compiler flags of this project. Targets that link to the libraries inherit none of them, in the same build tree or
# installed.
include_directories(${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
# In WebAssembly sizes have 32 bits: other conversions, of which the native builds know nothing.
if(EMSCRIPTEN)
  add_compile_options(-w)
elseif(PROJECT_IS_TOP_LEVEL)
  add_compile_options(-Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers -Werror)
endif()
# No contraction into fused multiply-add, so that results have the same bits on every machine (lockstep). No code reads
# errno after sqrt or traps on a comparison; declaring this allows vectorisation without changing a bit.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)
# Allows a position-independent library to inline its own functions, as in a program.
add_compile_options(-fno-semantic-interposition)
# Build paths are removed: assertions name files within the project. Only the debug build keeps full paths for its
# debugger.
add_compile_options("$<IF:$<CONFIG:Debug>,-fmacro-prefix-map,-ffile-prefix-map>=${PROJECT_BINARY_DIR}/="
                    "$<IF:$<CONFIG:Debug>,-fmacro-prefix-map,-ffile-prefix-map>=${PROJECT_SOURCE_DIR}/=")
# GCC 12 warns about impossible overlaps in std::string (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-restrict)
endif()
# Many source files are compiled as one (CMAKE_UNITY_BUILD, set by the presets), because a small file's compile time
# is mostly that of its headers. A name in an unnamed namespace must therefore be unique within its library. In a unity
# build a local may legally shadow such a name of another file, so the shadow warning is enabled only in the debug
# build, file by file. GCC treats an unnamed namespace in an included file as one in a header.
if(CMAKE_UNITY_BUILD)
  add_compile_options(-Wno-shadow $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()
# A driver's thread may run a function that is called by the vendor's loop (Driver::run).
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-overloaded-virtual>)

# Also needed by targets that link to our libraries.
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
    # Pointer checks double the compile time of Eigen, and the address sanitizer finds most of the same errors.
    add_compile_options(-fno-sanitize=null,object-size,alignment,pointer-overflow)
    # Functions of a vendor's library are called through our own declarations of their types.
    add_compile_options($<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=function>)
    # A finding aborts the program, because output of a passing test is not read.
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

# For code outside the ticks, where compile time matters more than speed. Its units are larger too: it is mostly headers.
# Under the sanitizers everything except the engine is such code.
function(pliant_compile_fast target)
  if(PLIANT_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  else()
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 36)
endfunction()

# Of a template's instances (Eigen's, for example) the linker keeps the first: the engine's, which are optimised, come
# before those of a program.
function(pliant_engine_first target)
  target_link_options(${target} PRIVATE LINKER:--whole-archive $<TARGET_FILE:pliant_systems> LINKER:--no-whole-archive)
endfunction()

# A static library of one folder and its subfolders, of code outside the ticks:
#   pliant_outer_library(NAME DEPENDS libraries... FULL folders or files...)
# FULL: optimised as the engine is: loops over meshes, or loops of its own that a study times. Files that use Eigen's
# dense matrices are among them: of a template instantiated in several files, the linker keeps one copy for all.
function(pliant_outer_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;FULL" ${ARGN})
  set(here ${CMAKE_CURRENT_SOURCE_DIR})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${here}/*.cpp)
  list(REMOVE_ITEM sources ${here}/main.cpp)
  set(full)
  foreach(path ${ARG_FULL})
    set(found ${sources})
    list(FILTER found INCLUDE REGEX "^${here}/${path}[/.]")
    list(APPEND full ${found})
    list(FILTER sources EXCLUDE REGEX "^${here}/${path}[/.]")
  endforeach()
  add_library(pliant_${name} STATIC ${sources})
  set(targets pliant_${name})
  target_link_libraries(pliant_${name} PUBLIC pliant_options ${ARG_DEPENDS})
  pliant_compile_fast(pliant_${name})
  if(full)
    add_library(pliant_${name}_full OBJECT ${full})
    list(APPEND targets pliant_${name}_full)
    target_link_libraries(pliant_${name}_full PRIVATE pliant_options ${ARG_DEPENDS})
    target_sources(pliant_${name} PRIVATE $<TARGET_OBJECTS:pliant_${name}_full>)
    if(PLIANT_SANITIZE)
      pliant_compile_fast(pliant_${name}_full)
      set_target_properties(pliant_${name}_full PROPERTIES UNITY_BUILD_BATCH_SIZE "${CMAKE_UNITY_BUILD_BATCH_SIZE}")
    endif()
  endif()
  foreach(target ${targets})
    target_compile_definitions(${target} PRIVATE PLIANT_VERSION="${PROJECT_VERSION}")
  endforeach()
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
  add_library(pliant_${name} ${sources})  # BUILD_SHARED_LIBS selects static or shared
  set_target_properties(pliant_${name} PROPERTIES EXPORT_NAME internal_${name} POSITION_INDEPENDENT_CODE ${PLIANT_RELOCATABLE}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN"
    CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
  target_link_libraries(pliant_${name} PUBLIC pliant_options ${ARG_DEPENDS})
endfunction()

# The target that a program links to for a component of the package: pliant::COMPONENT, installed and in the same build
# tree.
function(pliant_component_target component target)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${component})
  add_library(pliant::${component} ALIAS ${target})
endfunction()
