// A deformable surface: P1's local model, authored by what a person can feel (methods.md 1.1 to 1.4).
// Rate: touch (read). Writer: content at spawn; editor and --set between ticks. Keys of PLIANT_deformable.
#pragma once

#include "components/mesh.h"
#include "components/range.h"
#include "pliant/parameters.h"

namespace pliant {

struct HeightField;

struct Deformable : DeformableParameters {
  Handle<Mesh> mesh;          // set at spawn
  Handle<HeightField> field;  // set at spawn
};

// What its numbers may be: the bounds of the keys of PLIANT_deformable, and of what the touch clock takes.
struct DeformableRange {
  static constexpr Range kStiffness{1e-6, 1e7};           // [N/m]
  static constexpr Range kCubic{0.0, 1e15};               // [N/m3]
  static constexpr Range kStiffening{-1e5, 1e5};          // [1/m] < 0: softens
  static constexpr Range kRelaxationStiffness{0.0, 1e7};  // [N/m]
  static constexpr Range kRelaxationTime{1e-6, 1e6};      // [s]
  static constexpr Range kDampingRatio{0.0, 100.0};       // [1]
  static constexpr Range kSettlingTime{1e-4, 100.0};      // [s]
  static constexpr Range kContactDamping{0.0, 1e6};       // [N s/m]
  static constexpr Range kReach{0.0, 1e6};                // [m]
  static constexpr Range kVolume{0.0, 1.0};               // [1]
  static constexpr Range kContactRadius{0.0, 1e6};        // [m]
};

// Whether a shape is of an indenter on a half-space, so that `contact_radius` says something.
inline bool depends_on_contact(Shape shape) {
  return shape == Shape::kPunch || shape == Shape::kHertz || shape == Shape::kKelvinlet;
}

inline constexpr double kMostContactShare = 0.95;  // [1] of the reach: what contact_radius may be
inline constexpr double kDefaultReach = 0.08;      // [1] of the diagonal of the object's box
// [m] The reach of a deformable that says none.
double default_reach(const Mesh& mesh);

// What dents ask of the mesh that is to show them. Lengths as DeformableParameters has them.
struct DentSize {
  double reach = 0.0;    // [m] 0: the default one
  double contact = 0.0;  // [m] of a shape that depends on it; 0: none is said
  bool operator==(const DentSize&) const = default;
  double radius(const Mesh& mesh) const;  // [m] of a dent without an edge of its own that asks for the same
};
DentSize dent_size(const DeformableParameters& deformable);

// Whether a released dent has a closed form in time: then the GPU evaluates a list of sources (systems/touch/field.h),
// else it takes every step (components/field_feed.h).
bool has_closed_form(const Deformable& deformable, const Mesh& mesh);

// Whether the GPU has its law and its shape. Registered ones are functions of the program (pliant/surface_law.h): their
// fields are stepped on the CPU, whatever is asked for.
bool gpu_knows(const Deformable& deformable);

}  // namespace pliant
