// Tetrahedra from files, ASCII and binary. To add a format, write read_<word> in a file of its own and a line below.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "components/tet_mesh.h"
#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

struct TetFile {
  std::vector<dvec3> nodes;          // finite, each used by a tetrahedron
  std::vector<Tet> tets;             // positive volume
  std::vector<std::string> notes;    // on skipped, turned or dropped elements
  std::vector<std::uint16_t> group;  // of each tetrahedron: its physical group, from 1 on, 0 none; empty: none
  std::vector<std::string> groups;   // their names, or numbers as text
};

// FORMAT(word, name, endings...): read_<word> in content/tets/tet_<word>.cpp.
#define PLIANT_TET_FORMATS(FORMAT)        \
  FORMAT(msh, "Gmsh 2.2 and 4.1", ".msh") \
  FORMAT(vtk, "legacy VTK", ".vtk")       \
  FORMAT(tetgen, "TetGen", ".node", ".ele")

#define PLIANT_FORMAT(word, ...) \
  Result<TetFile> read_##word(const std::filesystem::path& path, const std::filesystem::path& within);
PLIANT_TET_FORMATS(PLIANT_FORMAT)
#undef PLIANT_FORMAT

struct TetFormat {
  std::string name;
  std::vector<std::string> endings;  // in lower case, with their dot
  Result<TetFile> (*read)(const std::filesystem::path& path, const std::filesystem::path& within);  // as load_tets
};
const std::vector<TetFormat>& tet_formats();
std::vector<std::string> tet_endings();               // of all formats
bool is_tet_file(const std::filesystem::path& path);  // by its ending
// Reads a whole file and parses it; for formats of one file.
using TetParser = Result<TetFile> (*)(std::span<const std::uint8_t> bytes, const std::string& name);
Result<TetFile> read_parsed(const std::filesystem::path& path, TetParser parse);
// The other file of TetGen's pair; empty for other formats.
std::filesystem::path tetgen_partner(const std::filesystem::path& path);

// Either file of TetGen's pair may be given. The other lies beside it, and inside `within` if that is set
// (confined_file). Errors name the line or the byte.
Result<TetFile> load_tets(const std::filesystem::path& path, const std::filesystem::path& within = {});
// Loads a file that a level in `folder` names; it must lie there.
Result<TetFile> load_named_tets(const std::filesystem::path& folder, const std::string& name);

// From memory, for tests and fuzzers; `name` is used in errors.
Result<TetFile> parse_msh(std::span<const std::uint8_t> bytes, const std::string& name);
Result<TetFile> parse_vtk(std::span<const std::uint8_t> bytes, const std::string& name);
Result<TetFile> parse_tetgen(std::span<const std::uint8_t> node, std::span<const std::uint8_t> ele,
                             const std::string& name);

}  // namespace pliant
