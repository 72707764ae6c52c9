// The files and folders in a folder, as the file browser shows them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "editor/core/jobs.h"

namespace pliant {

struct FolderEntry {
  std::string name, shown;
  bool folder = false;
  std::uintmax_t size = 0;
};
struct FolderListing {
  std::vector<FolderEntry> entries;  // folders first, by name
  std::size_t left_out = 0;
  std::string fault;
};

struct FolderFilter {
  bool hidden = false, all = false, levels_only = false;
  std::string part;
  bool operator==(const FolderFilter&) const = default;
};

FolderListing read_folder(const std::filesystem::path& folder, const FolderFilter& filter, const Jobs::Stop& stop);

std::string lower_case(std::string text);
std::string size_text(std::uintmax_t bytes);

}  // namespace pliant
