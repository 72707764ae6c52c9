// Scripts: CSV files that say where a probe is, and when.
#pragma once

#include <filesystem>
#include <map>
#include <string_view>

#include "components/haptic_device.h"
#include "runtime/result.h"

namespace pliant {

// Reads `time_s,x,y,z` or `time_s,x,y,z,qw,qx,qy,qz` (a header line with exactly these names, then rows of numbers):
// seconds, strictly ascending; metres, world frame; rotation to world, normalised here. Lines that start with # and
// empty lines are skipped; a UTF-8 byte order mark, blanks around names and numbers, and CRLF are read over. At most 64
// MiB and 4,000,000 rows. Errors name the file and the line.
Result<Path> load_script(const std::filesystem::path& path);

// The same from text; `where` stands in front of errors.
Result<Path> parse_script(std::string_view text, const std::string& where);

// The scripts of a level: a file is read once, however many nodes name it, and all rows together are at most
// limits::kScriptRows.
class ScriptLibrary {
 public:
  // The script in a file. Its rows count once, and again whenever who asks makes a copy of them.
  Result<const Path*> read(const std::filesystem::path& file, bool copied);

 private:
  std::map<std::filesystem::path, Result<Path>> scripts_;
  double rows_ = 0.0;
};

}  // namespace pliant
