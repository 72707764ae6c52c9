// Tetrahedra from files: Gmsh .msh (2.2 and 4.1), legacy VTK .vtk, TetGen .node and .ele. ASCII and binary.
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
  std::vector<dvec3> nodes;        // finite, each used by a tetrahedron
  std::vector<Tet> tets;           // positive volume
  std::vector<std::string> notes;  // on skipped, turned or dropped elements
};

bool is_tet_file(const std::filesystem::path& path);  // by its extension
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
