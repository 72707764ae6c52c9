// glTF and GLB from memory: a sound Level that can be written and read again, or an error of one sentence.
#include <cstddef>
#include <cstdint>

#include "content/gltf/form/gltf_document.h"
#include "content/gltf/write/gltf_save.h"
#include "fuzz/sound_level.h"

// tinygltf must be able to read everything that passes the checks.
static bool tinygltf_failed(const pliant::Error& error) {
  return error.code == pliant::kTinygltfFailed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto level = pliant::load_gltf({data, size}, false, "/nonexistent");
  if (!level) {
    ASSERT(!level.error().message().empty());
    ASSERT(!tinygltf_failed(level.error()));
    return 0;
  }
  pliant::assert_sound(*level);
  auto document = pliant::build_document(*level);
  ASSERT(document.ok());
  if (const auto status = pliant::compress_document(*document, 12); !status) ASSERT(!status.error().message().empty());
  pliant::pack_document(*document, false);
  const auto glb = pliant::level_as_glb(*level);
  ASSERT(glb.ok());
  const auto again = pliant::load_gltf(*glb, true, "/nonexistent");
  if (!again) ASSERT(!tinygltf_failed(again.error()));
  return 0;
}
