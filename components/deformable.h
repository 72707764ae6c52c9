// A deformable surface: P1's local model with perceptual parameters (methods.md 1.1 to 1.4).
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

// Bounds of the parameters: of the keys of PLIANT_deformable and of the values that the touch clock accepts.
struct DeformableRange {
  static constexpr Range kStiffness{1e-6, 1e7};            // [N/m]
  static constexpr Range kCubic{0.0, 1e15};                // [N/m3]
  static constexpr Range kStiffening{-1e5, 1e5};           // [1/m] < 0: softens
  static constexpr Range kTable{0.0, 1e9};                 // [m], [N]
  static constexpr Range kRelaxationStiffness{0.0, 1e7};   // [N/m]
  static constexpr Range kRelaxationTime{1e-6, 1e6};       // [s]
  static constexpr Range kDampingRatio{0.0, 100.0};        // [1]
  static constexpr Range kSettlingTime{1e-4, 100.0};       // [s]
  static constexpr Range kContactDamping{0.0, 1e6};        // [N s/m]
  static constexpr Range kReach{0.0, 1e6};                 // [m]
  static constexpr Range kVolume{0.0, 1.0};                // [1]
  static constexpr Range kContactRadius{0.0, 1e6};         // [m]
  static constexpr Range kStribeck{0.0, 100.0};            // [m/s]
  static constexpr Range kViscous{0.0, 100.0};             // [s/m]
  static constexpr Range kTextureAmplitude{0.0, 0.01};     // [m]
  static constexpr Range kTextureWavelength{1e-6, 1.0};    // [m]
  static constexpr Range kTextureSeed{0.0, 4294967295.0};  // [1]
  static constexpr Range kTransientAmplitude{0.0, 1000};   // [N s/m]
  static constexpr Range kTransientFrequency{1.0, 5000};   // [Hz]
  static constexpr Range kTransientDecay{1.0, 10000.0};    // [1/s]
  static constexpr Range kRelief{0.0, 10.0};               // [1]
  static constexpr Range kLayerThickness{1e-6, 1e3};       // [m]
  static constexpr Range kBreakingForce{0.0, 1e3};         // [N]
  static constexpr Range kBreakingEnergy{0.0, 1e3};        // [J]
  static constexpr Range kRemains{0.0, 1.0};               // [1]
  static constexpr Range kGrip{0.0, 1e5};                  // [N/m]
  static constexpr Range kHoleRadius{1e-6, 1.0};           // [m]
  static constexpr Range kYieldForce{0.0, 1e3};            // [N]
  static constexpr Range kHardening{0.0, 1e7};             // [N/m]
};

// Whether a shape is that of an indenter on a half-space, so that `contact_radius` has an effect.
bool depends_on_contact(Shape shape);
// Whether a law relaxes by a Maxwell arm: `relaxation.*`, and a memory per vertex.
bool has_arm(SpringLaw law);

inline constexpr std::size_t kMostLayers = 8;
// The first fault of a table of force against depth, or nullptr.
const char* fault_of(const ForceTable& table);

// A knock above this share of the touch rate would alias: there is none. [1]
inline constexpr double kMostKnock = 0.4;
inline constexpr double kMostContactShare = 0.95;  // [1] of the reach: upper bound of contact_radius
inline constexpr double kDefaultReach = 0.08;      // [1] of the diagonal of the object's box
// [m] The reach of a deformable that gives none.
double default_reach(const Mesh& mesh);

// Sizes of dents that the mesh must resolve. Lengths as in DeformableParameters.
struct DentSize {
  double reach = 0.0;    // [m] 0: the default one
  double contact = 0.0;  // [m] of a shape that depends on it; 0: not given
  bool operator==(const DentSize&) const = default;
  double radius(const Mesh& mesh) const;  // [m] of the rimless dent that needs the same resolution
};
DentSize dent_size(const DeformableParameters& deformable);

// Whether a released dent has a closed form in time. If so, the GPU evaluates a list of sources
// (systems/touch/model/field.h); else it takes every step (components/field_feed.h).
bool has_closed_form(const Deformable& deformable, const Mesh& mesh);

// Whether the GPU implements its law and its shape, and no dent of it stays. Registered laws and shapes are functions
// of the program (pliant/surface_law.h): their fields are always stepped on the CPU, as those that yield are.
bool gpu_knows(const Deformable& deformable);

}  // namespace pliant
