// Finds the parts of a mesh around one of its triangles by counting the intersections of a ray with each part.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "components/mesh.h"

namespace pliant {

class EnclosingParts {
 public:
  // `part_of`: each triangle's part.
  EnclosingParts(const Mesh& mesh, const std::vector<std::uint32_t>& part_of);

  // The other parts that a ray from the triangle's centre crosses an odd number of times, ascending; empty if no ray is
  // reliable.
  std::optional<std::vector<std::uint32_t>> around(std::uint32_t triangle);

 private:
  bool cast(dvec3 from, dvec3 along, std::uint32_t own);
  bool meet(dvec3 from, dvec3 along, std::uint32_t triangle);

  struct Visit {
    std::size_t level, box;
  };
  const Mesh& mesh_;
  const std::vector<std::uint32_t>& part_of_;
  TriangleTree tree_;
  std::vector<Visit> waiting_;
  std::vector<std::uint32_t> hits_;
};

}  // namespace pliant
