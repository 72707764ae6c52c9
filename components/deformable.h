// A surface that gives way: P1's local model, authored by what a person can feel (methods.md 1.1 to 1.4).
// Rate: touch (read). Writer: content at spawn; editor and --set between ticks. Keys of PLIANT_deformable.
#pragma once

#include "components/mesh.h"
#include "components/range.h"

namespace pliant {

struct HeightField;

enum class SpringLaw : std::uint8_t { kLinear, kCubic, kExponential, kStandardLinearSolid };
enum class Shape : std::uint8_t { kPunch, kHertz, kGaussian, kWendland, kVolume, kKelvinlet };
enum class Response : std::uint8_t { kFollow, kLag };     // methods.md 1.8
enum class Distance : std::uint8_t { kChord, kSurface };  // methods.md 1.3

struct Deformable {
  SpringLaw spring = SpringLaw::kLinear;
  double stiffness = 300.0;               // [N/m] slope of the normal force against depth at depth 0
  double cubic = 3e6;                     // [N/m3] k3 of the cubic law
  double stiffening = 100.0;              // [1/m] alpha of the exponential law
  double relaxation_stiffness = 300.0;    // [N/m] the arm of the standard linear solid
  double relaxation_time = 0.5;           // [s] tau of that arm
  double damping_ratio = 1.0;             // [1] zeta of the free surface
  double settling_time = 0.05;            // [s] 2 % settling time of the free surface
  double contact_damping = 0.0;           // [N s/m] rate term of the probe's force
  bool contact_damping_material = false;  // take b of the local model instead, as P1 does
  Response response = Response::kFollow;
  Shape shape = Shape::kVolume;
  Distance distance = Distance::kChord;
  double reach = 0.0;             // [m] radius R of the field; 0: default_reach, set at spawn
  double volume = 1.0;            // [1] chi: share of the volume that the shape `volume` conserves
  double friction_static = 0.4;   // [1] mu_s
  double friction_sliding = 0.3;  // [1] mu_d <= mu_s
  double crease_angle = 0.0;      // [rad] edges that turn by more are creases; 0: the file's normals, else 0.7
  double young = 0.0;             // [Pa] with thickness: calibrates stiffness instead of `stiffness`; 0: not given
  double poisson = 0.45;          // [1]
  double thickness = 0.0;         // [m] 0: deep

  Handle<Mesh> mesh;          // set at spawn
  Handle<HeightField> field;  // set at spawn
};

// What its numbers may be: the bounds of the keys of PLIANT_deformable, and of what the touch clock takes.
struct DeformableRange {
  static constexpr Range kStiffness{1e-6, 1e7};           // [N/m]
  static constexpr Range kCubic{0.0, 1e15};               // [N/m3]
  static constexpr Range kStiffening{1e-6, 1e5};          // [1/m]
  static constexpr Range kRelaxationStiffness{0.0, 1e7};  // [N/m]
  static constexpr Range kRelaxationTime{1e-6, 1e6};      // [s]
  static constexpr Range kDampingRatio{0.0, 100.0};       // [1]
  static constexpr Range kSettlingTime{1e-4, 100.0};      // [s]
  static constexpr Range kContactDamping{0.0, 1e6};       // [N s/m]
  static constexpr Range kReach{0.0, 1e6};                // [m]
  static constexpr Range kVolume{0.0, 1.0};               // [1]
};

inline constexpr double kDefaultReach = 0.08;  // [1] of the diagonal of the object's box
// [m] The reach of a deformable that says none.
double default_reach(const Mesh& mesh);

// Whether a released dent has a closed form in time: then the GPU evaluates a list of sources (systems/touch/field.h),
// else it takes every step (components/field_feed.h).
bool has_closed_form(const Deformable& deformable, const Mesh& mesh);

}  // namespace pliant
