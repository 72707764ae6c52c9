// Reading whole files with a limit, and writing files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

using Bytes = std::vector<std::uint8_t>;
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{2} << 30;  // of any file that content reads

// Refuses what is not a regular file (a pipe would never end) or is larger than `limit` bytes.
Result<Bytes> read_file(const std::filesystem::path& path, std::uint64_t limit = kMaxFileBytes);

struct FileToWrite {
  std::filesystem::path path;
  std::span<const std::uint8_t> bytes;
};
// Writes every file aside and renames them, in order, once all are written; on failure nothing is left behind.
Status write_files(const std::vector<FileToWrite>& files);
Status write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// A relative URI of an untrusted file as a path below `folder`: percent-decoded, without scheme, and not outside the
// folder, not even through a symbolic link.
Result<std::filesystem::path> confined_path(const std::filesystem::path& folder, const std::string& uri);

}  // namespace pliant
