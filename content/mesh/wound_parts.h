// The connected parts of a mesh, and on which side of its part each triangle is wound.
#pragma once

#include <cstdint>
#include <vector>

#include "content/mesh/mesh_surface.h"

namespace pliant {

// Triangles connected by edges of exactly two triangles.
struct WoundPart {
  dvec3 origin{0};                       // [m] one of its vertices, to avoid cancellation
  double area[2] = {0, 0};               // [m2] of triangles oriented as the first one, and of those opposite to it
  double volume = 0.0;                   // [m3] signed, after its triangles agree
  double agrees = 0.0, disagrees = 0.0;  // [m2] with the file's normals
  std::vector<std::uint32_t> samples;    // triangles
  std::uint32_t count = 0;
  bool closed = true, orientable = true, turned = false, decided = true;
};

class WoundParts {
 public:
  // `against`: from connect_triangles.
  WoundParts(const Mesh& mesh, const std::vector<SideAgainst>& against);

  // Marks the triangles on the side with the smaller area of their part, and measures the parts' volumes as wound by
  // the larger one. An unorientable part is left as it is. Returns the number of triangles marked.
  std::uint32_t agree();
  // [m2] The triangle's area vector, doubled, as wound in the file.
  dvec3 twice_area(std::uint32_t triangle) const;

  std::vector<WoundPart> parts;
  std::vector<std::uint32_t> part_of;  // of each triangle
  std::vector<std::uint8_t> side;      // per triangle: 1: opposite to the first of its part; after agree(): to turn

 private:
  void measure_volumes();

  const Mesh& mesh_;
};

}  // namespace pliant
