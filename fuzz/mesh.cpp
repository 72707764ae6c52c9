// Other mesh formats: our checks, Assimp and the conversion of its scene, in this process. The first byte selects the
// format; the rest is the file.
#include <cstddef>
#include <cstdint>

#include "content/files/mesh_import.h"
#include "fuzz/obj_buffer.h"
#include "fuzz/sound_level.h"

// Assimp leaks when it throws; in production this ends with import_mesh's child process.
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kFormats[] = {".obj", ".ply", ".off", ".stl"};
  if (size < 1) return 0;
  pliant::offer_obj_buffer(size);
  try {
    const auto level = pliant::import_mesh_here({data + 1, data + size}, kFormats[data[0] % 4]);
    if (level)
      pliant::assert_sound(*level);
    else
      ASSERT(!level.error().message().empty());
  } catch (const std::exception&) {  // import_mesh reports it as an error
  }
  return 0;
}
