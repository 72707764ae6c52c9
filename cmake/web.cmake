# In place of cmake/packages.cmake where emscripten compiles: the same targets, of what cmake/web/libraries.sh made.
set(libraries ${PROJECT_SOURCE_DIR}/build/web/libraries CACHE PATH "Where cmake/web/libraries.sh put its libraries")
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
option(PLIANT_WEB_THREADS "Threads, for pages that are cross-origin isolated" OFF)

# web_library(TARGET ARCHIVE... ): in the prefix.
function(web_library name)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${name} SYSTEM INTERFACE ${libraries}/headers ${libraries}/prefix/include)
  foreach(archive ${ARGN})
    target_link_libraries(${name} INTERFACE ${libraries}/prefix/lib/lib${archive}.a)
  endforeach()
endfunction()
foreach(name glm::glm Eigen3::Eigen nlohmann_json::nlohmann_json TinyGLTF::TinyGLTF fmt::fmt Threads::Threads)
  web_library(${name})
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
web_library(draco::draco draco)
web_library(PNG::PNG png z)
web_library(JPEG::JPEG jpeg)
web_library(metis metis)
set(PLIANT_METIS_INCLUDE ${libraries}/prefix/include)
web_library(OpenEXR::OpenEXR OpenEXR-3_1 Iex-3_1 IlmThread-3_1 Imath-3_1 z)
target_include_directories(OpenEXR::OpenEXR SYSTEM INTERFACE ${libraries}/prefix/include/OpenEXR
                                                             ${libraries}/prefix/include/Imath)
web_library(PkgConfig::stb)
target_include_directories(PkgConfig::stb SYSTEM INTERFACE ${libraries}/headers/stb)
# OpenGL ES is emscripten's own, upon WebGL 2.
web_library(PkgConfig::epoxy)
web_library(OpenGL::EGL)

# No window, no command: the C interface as a module.
set(PLIANT_RELOCATABLE OFF)
foreach(part COMMAND TESTS BENCH INSTALL PYTHON FUZZ)
  set(PLIANT_${part} OFF)
endforeach()
set(PLIANT_C ON)

# Exceptions of WebAssembly; no option may contract a product and a sum (build_options.cmake). What libc++ 13 lacks
# stands in front of every file.
set(web_options -fwasm-exceptions -sSUPPORT_LONGJMP=wasm -msimd128)
if(PLIANT_WEB_THREADS)
  list(APPEND web_options -pthread)
endif()
add_compile_options(${web_options} -isystem ${PROJECT_SOURCE_DIR}/cmake/web/include
                    "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/web/libcxx13.h>")
add_link_options(${web_options})
