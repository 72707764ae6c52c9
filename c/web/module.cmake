# The C interface as a WebAssembly module: pliant.js with pliant.wasm, and pliant.single.js, which holds its wasm.
set(stb ${PROJECT_SOURCE_DIR}/cmake/web/stb.cpp)
set_source_files_properties(${stb} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
add_executable(pliant_module ${sources} ${stb})
target_compile_definitions(pliant_module PRIVATE PLIANT_VERSION="${PROJECT_VERSION}")
target_link_libraries(pliant_module PRIVATE pliant_engine pliant_content pliant_drivers pliant_picture)
set_target_properties(pliant_module PROPERTIES OUTPUT_NAME pliant RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

# Every function of the header, and what JavaScript needs to pass text, arrays, files and callbacks.
file(READ ${PROJECT_SOURCE_DIR}/include/pliant.h header)
string(REGEX MATCHALL "\nPLIANT_API [^(;]*" functions "${header}")
set(exports _malloc _free)
foreach(function ${functions})
  string(REGEX MATCH "pliant_[a-z0-9_]+$" name "${function}")
  list(APPEND exports _${name})
endforeach()
list(JOIN exports "," exports)
string(CONCAT methods FS,HEAP8,HEAPU8,HEAP16,HEAP32,HEAPU32,HEAPF32,HEAPF64,ccall,cwrap,addFunction,removeFunction,
  UTF8ToString,stringToUTF8,lengthBytesUTF8,GL)
# -O2: binaryen's -O3 takes several gigabytes for nothing measurable.
target_link_options(pliant_module PRIVATE -O2 --no-entry -sMODULARIZE=1 -sEXPORT_ES6=1 -sEXPORT_NAME=createPliant
  -sENVIRONMENT=web,worker -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=33554432 -sMAXIMUM_MEMORY=2147483648
  -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2 -sALLOW_TABLE_GROWTH=1 -sFORCE_FILESYSTEM=1 -sWASM_BIGINT=1 -sEXPORTED_FUNCTIONS=${exports}
  -sEXPORTED_RUNTIME_METHODS=${methods})
add_custom_command(TARGET pliant_module POST_BUILD
  COMMAND node ${CMAKE_CURRENT_SOURCE_DIR}/web/single.mjs ${PROJECT_BINARY_DIR}/pliant.js VERBATIM)
# A page waits for every byte: what no tick runs is compiled for size.
foreach(target pliant_devices pliant_level pliant_content pliant_engine pliant_drivers pliant_visual pliant_picture pliant_module)
  target_compile_options(${target} PRIVATE -Os)
endforeach()
# Eigen sums in pairs, as on x86-64: the same bits. It recognises SSE2, which emscripten puts upon SIMD128, and for a GCC
# between 4.9 and 6 it writes no assembly. The sizes of its blocks stand in libcxx13.h.
foreach(target pliant_systems pliant_engine)
  target_compile_options(${target} PRIVATE -msse2 -fgnuc-version=4.99)
endforeach()
