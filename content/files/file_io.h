// Reading whole files with a limit, and writing files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "content/files/limits.h"
#include "runtime/result.h"

namespace pliant {

using Bytes = std::vector<std::uint8_t>;

// Refuses what is not a regular file (a pipe would never end) or is larger than `limit`.
Result<Bytes> read_file(const std::filesystem::path& path, const Limit& limit = limits::kFile);
// No more than the first `wanted` bytes of it, which count for the limit.
Result<Bytes> read_beginning(const std::filesystem::path& path, const Limit& limit, std::uint64_t wanted);

// Why a file cannot be written, and the cure, of an `errno`.
std::string why_not_written(int error);
// Whether a sentence that came of it says that a disk, a quota or a limit on files was full: with more room the same
// would have been written.
bool wants_room(const std::string& sentence);

// "a.glb" -> "a-2.glb": where something goes whose place is taken.
std::filesystem::path numbered(const std::filesystem::path& path, int number);
// Renames a file; without `replace` only to a name that is free. 0, or errno (EEXIST: it is taken).
int move_file(const std::filesystem::path& from, const std::filesystem::path& to, bool replace);

// Where write_files() writes a file first; where that name is taken, beside it.
std::filesystem::path aside_of(const std::filesystem::path& path);

struct FileToWrite {
  std::filesystem::path path;
  std::span<const std::uint8_t> bytes;
};
enum class Existing : std::uint8_t { kReplace, kRefuse };  // a file that is there already
// Writes every file aside and renames them, in order, once all are written; on failure nothing is left behind, and
// what was there is there again.
Status write_files(const std::vector<FileToWrite>& files, Existing existing = Existing::kReplace);
Status write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                  Existing existing = Existing::kReplace);

// What an untrusted file calls another one, as a path below `folder`: the name as it stands where there is such a file,
// else percent-decoded; without scheme, and not outside the folder, not even through a symbolic link. Every path that
// stands in a file goes through here.
Result<std::filesystem::path> confined_path(const std::filesystem::path& folder, const std::string& uri);
// The same for a name that is none of a URI, relative to `folder`.
Result<std::filesystem::path> confined_file(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace pliant
