// A surface with creases, felt in two ways: P1's normals drift, shared by the faces beside a crease, with the
// interpolated contact vertex, the nearest one; or the engine's feet, one on each face.
#pragma once

#include <cstdint>

namespace pliant {

enum class CreaseFelt : std::uint8_t { kDriftingNormals, kFeet };
inline constexpr CreaseFelt kCreaseFelt[] = {CreaseFelt::kDriftingNormals, CreaseFelt::kFeet};
const char* name_of(CreaseFelt felt);

// A closed loop inside a box of 100 x 40 mm, 1 to 5 mm behind its faces and around its edges.
struct CreaseErrors {
  double work = 0.0;       // [1] net work over the energy stored at the deepest place
  double direction = 0.0;  // [degree] RMS angle to the nearest face's normal, farther than two depths from the others
  double steepest = 0.0;   // [1] largest change of the force per way and stiffness; 1 on a face
  double us = 0.0;         // CPU time of a query; of the feet the tick's whole collision
};
CreaseErrors feel_creases(int cells, CreaseFelt felt, int samples);

}  // namespace pliant
