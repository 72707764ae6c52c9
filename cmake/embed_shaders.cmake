# cmake -D FOLDER=shaders -D OUT=FILE.cpp -P embed_shaders.cmake: writes every file in FOLDER as a string into a C++
# file.
file(GLOB_RECURSE names RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT names)
set(text "// Made from shaders/ by cmake/embed_shaders.cmake.\n#include \"systems/visual/gpu/embedded_shaders.h\"\n\n")
string(APPEND text "namespace pliant::gpu {\n\nconst EmbeddedShader kEmbeddedShaders[] = {\n")
foreach(name IN LISTS names)
  file(READ "${FOLDER}/${name}" shader)
  string(APPEND text "{\"${name}\", R\"glsl(${shader})glsl\"},\n")
endforeach()
string(APPEND text "{nullptr, nullptr}};\n\n}  // namespace pliant::gpu\n")
file(WRITE "${OUT}" "${text}")
