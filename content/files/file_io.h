// Reads whole files up to a size limit. Writes files atomically.
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

// Rejects files that are not regular (a pipe would never end) or larger than `limit`.
Result<Bytes> read_file(const std::filesystem::path& path, const Limit& limit = limits::kFile);
// Reads at most the first `wanted` bytes; only these count for the limit.
Result<Bytes> read_beginning(const std::filesystem::path& path, const Limit& limit, std::uint64_t wanted);

// Code of an error: a disk, a quota or a file size limit was reached.
inline constexpr const char* kDiskFull = "disk.full";
// The error for an `errno`: "WHERE: WHAT: No space left on device; free some space".
Error not_written(std::string where, const std::string& what, int error);

// "a.glb" -> "a-2.glb": an alternative for a name in use.
std::filesystem::path numbered(const std::filesystem::path& path, int number);
// Renames a file; without `replace` only to a free name. Returns 0, or errno (EEXIST: the name is in use).
int move_file(const std::filesystem::path& from, const std::filesystem::path& to, bool replace);

// The temporary name under which write_files() writes first; if that is in use, a numbered one beside it.
std::filesystem::path aside_of(const std::filesystem::path& path);

struct FileToWrite {
  std::filesystem::path path;
  std::span<const std::uint8_t> bytes;
};
enum class Existing : std::uint8_t { kReplace, kRefuse };  // policy for an existing file
// Writes every file under a temporary name, and renames them in order after all are written. On failure, no new file is
// left and replaced files are restored.
Status write_files(const std::vector<FileToWrite>& files, Existing existing = Existing::kReplace);
Status write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes,
                  Existing existing = Existing::kReplace);

// Resolves a name from an untrusted file to a path below `folder`. Takes the literal name if such a file exists, else
// the percent-decoded one. Rejects schemes and paths outside the folder, also through symbolic links. Every path found
// in a file must pass through here.
Result<std::filesystem::path> confined_path(const std::filesystem::path& folder, const std::string& uri);
// The same for a plain file name (not a URI), relative to `folder`.
Result<std::filesystem::path> confined_file(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace pliant
