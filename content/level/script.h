// Scripts: CSV files with the poses of a probe over time.
#pragma once

#include <filesystem>
#include <map>
#include <string_view>

#include "components/haptic_device.h"
#include "runtime/result.h"

namespace pliant {

// Reads `time_s,x,y,z` or `time_s,x,y,z,qw,qx,qy,qz`, with or without a last column `grip` (0 to 1): a header line with
// exactly these names, then rows of numbers. Times in seconds, strictly ascending; positions in metres, world frame;
// rotations to world, normalised here. Ignores empty lines, lines that start with #, a UTF-8 byte order mark, blanks
// and CR. At most 64 MiB and 4,000,000 rows. Errors name the file and the line.
Result<Path> load_script(const std::filesystem::path& path);

// The same from text; errors begin with `where`.
Result<Path> parse_script(std::string_view text, const std::string& where);

// The scripts of a level. Each file is read once; all rows together are at most limits::kScriptRows.
class ScriptLibrary {
 public:
  // The script in a file. Its rows count once, and again each time that the caller copies them (`copied`).
  Result<const Path*> read(const std::filesystem::path& file, bool copied);

 private:
  std::map<std::filesystem::path, Result<Path>> scripts_;
  double rows_ = 0.0;
};

}  // namespace pliant
