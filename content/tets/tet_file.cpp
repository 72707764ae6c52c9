#include "content/tets/tet_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const TetFormat* format_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  for (const TetFormat& format : tet_formats())
    if (std::count(format.endings.begin(), format.endings.end(), extension)) return &format;
  return nullptr;
}

}  // namespace

const std::vector<TetFormat>& tet_formats() {
#define PLIANT_FORMAT(word, name, ...) TetFormat{name, {__VA_ARGS__}, read_##word},
  static const std::vector<TetFormat> formats{PLIANT_TET_FORMATS(PLIANT_FORMAT)};
#undef PLIANT_FORMAT
  return formats;
}

std::vector<std::string> tet_endings() {
  std::vector<std::string> all;
  for (const TetFormat& format : tet_formats()) all.insert(all.end(), format.endings.begin(), format.endings.end());
  return all;
}

bool is_tet_file(const fs::path& path) {
  return format_of(path) != nullptr;
}

Result<TetFile> read_parsed(const fs::path& path, TetParser parse) {
  Result<Bytes> bytes = read_file(path, limits::kTetFile);
  if (!bytes) return bytes.error();
  return parse(*bytes, path.string());
}

Result<TetFile> load_named_tets(const fs::path& folder, const std::string& name) {
  const Result<fs::path> path = confined_path(folder, name);
  if (!path) return path.error();
  return load_tets(*path, folder.empty() ? fs::path(".") : folder);
}

Result<TetFile> load_tets(const fs::path& path, const fs::path& within) {
  if (const TetFormat* format = format_of(path)) return format->read(path, within);
  return Error{path.string(), "is no tetrahedra file that is read",
               fmt::format("formats are: {}", fmt::join(tet_endings(), ", "))};
}

}  // namespace pliant
