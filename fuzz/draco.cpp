// Bare Draco files: a sound Level, or an error of one sentence.
#include <cstddef>
#include <cstdint>

#include "content/files/mesh_import.h"
#include "fuzz/sound_level.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto level = pliant::import_draco({data, size}, "mesh");
  if (level)
    pliant::assert_sound(*level);
  else
    ASSERT(!level.error().message().empty());
  return 0;
}
