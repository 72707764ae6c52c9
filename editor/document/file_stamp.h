// Time and size of a file, to detect changes.
#pragma once

#include <cstdint>
#include <filesystem>

namespace pliant {

struct FileStamp {
  bool there = false;
  std::filesystem::file_time_type time{};
  std::uintmax_t size = 0;
  bool operator==(const FileStamp&) const = default;
};

inline FileStamp stamp_of(const std::filesystem::path& file) {
  FileStamp stamp;
  std::error_code gone;
  stamp.time = std::filesystem::last_write_time(file, gone);
  if (gone) return {};
  stamp.size = std::filesystem::file_size(file, gone);
  if (gone) return {};
  stamp.there = true;
  return stamp;
}

}  // namespace pliant
