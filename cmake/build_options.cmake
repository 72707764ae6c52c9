# Flags that every target shares, as one interface library.
add_library(pliant_options INTERFACE)
target_compile_features(pliant_options INTERFACE cxx_std_20)
# How we build is not how those who use us must: warnings and flags stay inside the build tree.
# No contraction into fused multiply-add: the same bits on every machine (lockstep).
target_compile_options(pliant_options INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wshadow;-Wconversion;-Wno-sign-conversion;-Wno-missing-field-initializers;-Werror>"
  "$<BUILD_INTERFACE:-ffp-contract=off>")
# Nobody reads errno after sqrt or traps on a comparison; knowing that lets loops become SIMD, without changing a bit.
target_compile_options(pliant_options INTERFACE "$<BUILD_INTERFACE:-fno-math-errno;-fno-trapping-math>")
# GCC 12 sees overlaps in std::string that cannot be (its bug 105651).
target_compile_options(pliant_options INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>)
# Twelve source files are compiled as one (CMAKE_UNITY_BUILD, set by the presets): most of the time of a small file goes
# into the headers that it includes. A name in an unnamed namespace must then be unique within its library. What one file
# names so is then outside the next, where a local of that name is no mistake: shadowing is looked for by the debug build,
# file by file. GCC takes an unnamed namespace in an included file for one in a header.
if(CMAKE_UNITY_BUILD)
  target_compile_options(pliant_options INTERFACE
    $<BUILD_INTERFACE:-Wno-shadow> $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>>)
endif()
# A driver's thread may have a function of its own that is called as the maker's loop is (Driver::run).
target_compile_options(pliant_options INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:Clang>:-Wno-overloaded-virtual>>)
target_include_directories(pliant_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                    $<INSTALL_INTERFACE:include>)
if(PLIANT_VALIDATE)
  target_compile_definitions(pliant_options INTERFACE PLIANT_VALIDATE)
endif()
if(PLIANT_SANITIZE)
  target_compile_options(pliant_options INTERFACE -fsanitize=${PLIANT_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(pliant_options INTERFACE -fsanitize=${PLIANT_SANITIZE})
  target_compile_definitions(pliant_options INTERFACE PLIANT_SANITIZED)
  if(PLIANT_SANITIZE MATCHES "undefined")
    # Checks of every pointer that is followed or computed: they double the time that Eigen takes to compile, and what
    # they find the address sanitizer mostly stops at too.
    target_compile_options(pliant_options INTERFACE -fno-sanitize=null,object-size,alignment,pointer-overflow)
    # A maker's library is called through types of ours, which are not the ones that it was compiled with.
    target_compile_options(pliant_options INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=function>>)
    # What is found ends the program: nobody reads what a test that passes has printed.
    target_compile_options(pliant_options INTERFACE -fno-sanitize-recover=undefined)
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
  add_library(pliant_${name} STATIC ${sources})
  add_library(pliant::${name} ALIAS pliant_${name})
  set_target_properties(pliant_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(pliant_${name} PUBLIC pliant_options ${ARG_DEPENDS})
endfunction()
