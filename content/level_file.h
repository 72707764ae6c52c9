// Level files: reading, writing, setting keys, and conversion to a World.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/range.h"
#include "content/files/file_io.h"
#include "content/level/level.h"

namespace pliant {

// Reads .gltf, .glb, and through Assimp the formats of convert. Errors are one sentence with file and JSON pointer.
Result<Level> load_level(const std::filesystem::path& path);

// The level's description (Level::about), without loading its meshes. Only .gltf and .glb have one.
Result<std::string> read_about(const std::filesystem::path& path);

struct SaveOptions {
  static constexpr Range kDracoBits{8, 24};
  // Position quantisation bits, in kDracoBits; compressed data are compressed again. 0: unchanged.
  int draco_bits = 0;
  bool no_draco = false;  // decompresses compressed data
  Existing existing = Existing::kReplace;
};
// A file to be written.
struct MadeFile {
  std::filesystem::path path;
  Bytes bytes;
};
// Writes .gltf (with a .bin beside it) or .glb by the extension; returns the files in writing order. They have been
// read back: content that load_level would reject is an error here.
Result<std::vector<MadeFile>> make_level_files(const Level& level, const std::filesystem::path& path,
                                               const SaveOptions& options = {});
// Writes all files or none, each atomically.
Status write_made(const std::vector<MadeFile>& files, Existing existing = Existing::kReplace);
// Both in one: an unreadable result replaces no file.
Status save_level(const Level& level, const std::filesystem::path& path, const SaveOptions& options = {});

// --set NODE.EXT.KEY=VALUE (level-format.md), in order. NODE is a name or `*`. Dependent keys are checked after the
// last one, as in a file. After an error nothing has changed; the message names the faulty part.
Status set_keys(Level& level, const std::vector<std::string>& assignments);
Status set_key(Level& level, const std::string& assignment);

// spawn_level, plus decoding of the level's panorama.
Result<World> spawn(const Level& level, std::vector<std::string>* notes = nullptr);
// The same, but moves the level's pictures into the World: they may take half a gigabyte. The rest of the level is
// kept.
Result<World> spawn_moving_images(Level& level, std::vector<std::string>* notes = nullptr);

}  // namespace pliant
