#include "editor/panels/folder_listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "content/openable.h"
#include "runtime/printable.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostEntries = 5000;  // per folder; beyond it, the user types a part of the name

bool opens(const fs::path& name) {
  return has_ending(name, openable_endings());
}

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

FolderListing read_folder(const fs::path& folder, const FolderFilter& filter, const Jobs::Stop& stop) {
  FolderListing out;
  std::error_code failed;
  const std::string part = lower_case(filter.part);
  auto it = fs::directory_iterator(folder, fs::directory_options::none, failed);
  if (failed) {
    out.fault = fs::exists(folder) ? "cannot be read (" + failed.message() + ")" : "is not there";
    return out;
  }
  for (; it != fs::directory_iterator() && !stop; it.increment(failed)) {
    if (failed) break;
    FolderEntry entry;
    entry.name = it->path().filename().string();
    if (!filter.hidden && entry.name.starts_with('.')) continue;
    if (!part.empty() && lower_case(entry.name).find(part) == std::string::npos) continue;
    std::error_code gone;
    entry.folder = it->is_directory(gone);
    if (!entry.folder && (!it->is_regular_file(gone) || (!filter.all && !opens(entry.name)))) continue;
    if (out.entries.size() >= kMostEntries) {
      ++out.left_out;
      continue;
    }
    if (!entry.folder) entry.size = it->file_size(gone);
    entry.shown = printable(entry.name);
    out.entries.push_back(std::move(entry));
  }
  std::sort(out.entries.begin(), out.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.folder != b.folder ? a.folder : lower_case(a.name) < lower_case(b.name);
  });
  return out;
}

std::string size_text(std::uintmax_t bytes) {
  const auto b = static_cast<double>(bytes);
  return bytes < 1000      ? fmt::format("{} B", bytes)
         : bytes < 1000000 ? fmt::format("{:.0f} kB", b / 1e3)
                           : fmt::format("{:.1f} MB", b / 1e6);
}

}  // namespace pliant
