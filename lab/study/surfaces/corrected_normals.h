// Normals of a dented surface: P1's correction N0 + sum N_i, which the field carries, against the normals of the dented
// triangles. The truth is the dented surface's own, on a plane and on a sphere.
#pragma once

#include <cstdint>

namespace pliant {

enum class DrawnNormal : std::uint8_t { kRest, kCorrected, kRecomputed };
inline constexpr DrawnNormal kDrawnNormals[] = {DrawnNormal::kRest, DrawnNormal::kCorrected, DrawnNormal::kRecomputed};
const char* name_of(DrawnNormal normal);

struct DentedSurface {
  bool sphere = false;  // of 0.1 m, otherwise a sheet
  int edges = 10;       // along the reach of 30 mm
  double depth = 0.1;   // [1] of the reach
};
struct NormalErrors {
  double rms = 0.0, worst = 0.0;  // [degree] over the vertices within reach
  double ns = 0.0;                // CPU time per vertex, its height included
};
NormalErrors normals_on(const DentedSurface& surface, DrawnNormal normal, int batches);

}  // namespace pliant
