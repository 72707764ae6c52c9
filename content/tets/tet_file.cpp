#include "content/tets/tet_file.h"

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

// The file with the same name and the other extension, in the same letter case.
fs::path partner(fs::path path, const char* lower, const char* upper) {
  const std::string extension = path.extension().string();
  const bool is_upper = extension.size() > 1 && std::isupper(static_cast<unsigned char>(extension[1]));
  return path.replace_extension(is_upper ? upper : lower);
}

template <Result<TetFile> (*parse)(std::span<const std::uint8_t>, const std::string&)>
Result<TetFile> read_one(const fs::path& path, const fs::path&) {
  Result<Bytes> bytes = read_file(path, limits::kTetFile);
  if (!bytes) return bytes.error();
  return parse(*bytes, path.string());
}

// TetGen writes two files; either may be given.
Result<TetFile> read_tetgen(const fs::path& path, const fs::path& within) {
  const bool is_node = lower_extension(path) == ".node";
  Result<Bytes> bytes = read_file(path, limits::kTetFile);
  if (!bytes) return bytes.error();
  const fs::path beside = tetgen_partner(path);
  if (!within.empty()) {
    std::error_code error;
    const fs::path name = fs::relative(beside.parent_path(), within, error) / beside.filename();
    if (const Result<fs::path> confined = confined_file(within, name); !confined) return confined.error();
  }
  Result<Bytes> other = read_file(beside, limits::kTetFile);
  if (!other) return other.error();
  const std::string stem = fs::path(path).replace_extension().string();
  return is_node ? parse_tetgen(*bytes, *other, stem) : parse_tetgen(*other, *bytes, stem);
}

// To add a format: write a parser and add a line here. `within`: see load_tets.
struct Format {
  const char* extension;
  Result<TetFile> (*read)(const fs::path& path, const fs::path& within);
};
constexpr Format kFormats[] = {
    {".msh", read_one<parse_msh>},  // Gmsh 2 and 4
    {".vtk", read_one<parse_vtk>},  // legacy VTK
    {".node", read_tetgen},
    {".ele", read_tetgen},
};

const Format* format_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  for (const Format& format : kFormats)
    if (extension == format.extension) return &format;
  return nullptr;
}

}  // namespace

bool is_tet_file(const fs::path& path) {
  return format_of(path) != nullptr;
}

fs::path tetgen_partner(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".node") return partner(path, ".ele", ".ELE");
  return extension == ".ele" ? partner(path, ".node", ".NODE") : fs::path();
}

Result<TetFile> load_named_tets(const fs::path& folder, const std::string& name) {
  const Result<fs::path> path = confined_path(folder, name);
  if (!path) return path.error();
  return load_tets(*path, folder.empty() ? fs::path(".") : folder);
}

Result<TetFile> load_tets(const fs::path& path, const fs::path& within) {
  if (const Format* format = format_of(path)) return format->read(path, within);
  std::string known;
  for (const Format& format : kFormats) known += (known.empty() ? "" : ", ") + std::string(format.extension);
  return Error{path.string(), "is no tetrahedra file that is read", "formats are: " + known};
}

}  // namespace pliant
