// glTF and GLB from memory: a sound Level, which can be written and read again, or one sentence.
#include <cstddef>
#include <cstdint>

#include "content/gltf/gltf_document.h"
#include "content/gltf/gltf_save.h"
#include "fuzz/sound_level.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto level = pliant::load_gltf({data, size}, false, "/nonexistent");
  if (!level) {
    ASSERT(!level.error().message().empty());
    return 0;
  }
  pliant::assert_sound(*level);
  auto document = pliant::build_document(*level);
  ASSERT(document.ok());
  if (const auto status = pliant::compress_document(*document, 12); !status) ASSERT(!status.error().message().empty());
  pliant::pack_document(*document, false);
  return 0;
}
