// Level files: read, written, changed by a key, and made a World.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/range.h"
#include "content/files/file_io.h"
#include "content/level/level.h"

namespace pliant {

// Reads .gltf, .glb (and, through Assimp, what convert reads). Every failure is one sentence with file and JSON
// pointer.
Result<Level> load_level(const std::filesystem::path& path);

// The level's own sentence on what it shows (Level::about), without its meshes. Only .gltf and .glb have one.
Result<std::string> read_about(const std::filesystem::path& path);

struct SaveOptions {
  static constexpr Range kDracoBits{8, 24};
  // Position quantisation bits, in kDracoBits; what is compressed already is compressed anew. 0: as it is.
  int draco_bits = 0;
  bool no_draco = false;  // what is compressed is written plain
  Existing existing = Existing::kReplace;
};
// A file that is still to be written.
struct MadeFile {
  std::filesystem::path path;
  Bytes bytes;
};
// .gltf (with a .bin beside it) or .glb by the extension, in the order in which they are written. They have been read
// back as load_level reads them: what it would refuse is an error here.
Result<std::vector<MadeFile>> make_level_files(const Level& level, const std::filesystem::path& path,
                                               const SaveOptions& options = {});
// All of them or none appear, each whole (written aside, then renamed).
Status write_made(const std::vector<MadeFile>& files, Existing existing = Existing::kReplace);
// Both in one: what cannot be opened again replaces nothing.
Status save_level(const Level& level, const std::filesystem::path& path, const SaveOptions& options = {});

// --set NODE.EXT.KEY=VALUE (level-format.md), in order. NODE is a name or `*`. Keys that depend on each other are
// checked after the last one, as in a file. The error names what was not understood; then nothing has changed.
Status set_keys(Level& level, const std::vector<std::string>& assignments);
Status set_key(Level& level, const std::string& assignment);

// spawn_level, and the panorama that the level names is decoded.
Result<World> spawn(const Level& level, std::vector<std::string>* notes = nullptr);
// The same, and the level's pictures become the World's: they may take half a gigabyte. All else of the level stays.
Result<World> spawn_moving_images(Level& level, std::vector<std::string>* notes = nullptr);

}  // namespace pliant
