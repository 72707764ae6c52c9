// Tetrahedra files: elements of positive volume with finite nodes, or an error of one sentence. Input that begins with
// `$` is read as .msh, with `# vtk` as .vtk; else as TetGen's pair, separated by a byte of 1 between .node and .ele.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "content/tets/tet_file.h"
#include "content/tets/tet_quality.h"
#include "runtime/assert.h"

namespace {

pliant::Result<pliant::TetFile> parse(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(0, 1) == "$") return pliant::parse_msh(bytes, "file");
  if (text.substr(0, 5) == "# vtk") return pliant::parse_vtk(bytes, "file");
  const std::size_t split = std::min(text.find('\1'), text.size());
  return pliant::parse_tetgen(bytes.first(split), bytes.subspan(std::min(split + 1, text.size())), "file");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = parse({data, size});
  if (!file) {
    ASSERT(!file.error().message().empty());
    return 0;
  }
  ASSERT(!file->tets.empty());
  for (const pliant::dvec3& p : file->nodes) ASSERT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const pliant::Tet& tet : file->tets) {
    for (const std::uint32_t corner : tet) ASSERT(corner < file->nodes.size());
    ASSERT(pliant::tet_volume(file->nodes, tet) > 0.0);
  }
  return 0;
}
