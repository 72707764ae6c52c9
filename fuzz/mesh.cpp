// Meshes of other formats through Assimp, which reads files: the first byte chooses the format, the rest is the file.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "content/files/assimp_import.h"
#include "content/files/file_io.h"
#include "fuzz/sound_level.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kFormats[] = {".obj", ".ply", ".off", ".stl"};
  if (size < 1) return 0;
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("pliant-fuzz-" + std::to_string(::getpid()) + kFormats[data[0] % 4]);
  if (!pliant::write_file(path, {data + 1, size - 1})) return 0;
  const auto level = pliant::import_mesh(path);
  std::filesystem::remove(path);
  if (level)
    pliant::assert_sound(*level);
  else
    ASSERT(!level.error().message().empty());
  return 0;
}
