// Authored parameters of the second system (P2): tissue, its rigid handle, and rigid bodies. Keys of PLIANT_soft_body,
// PLIANT_handle and PLIANT_rigid_body. Rate: soft (read). Writer: content at spawn.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "components/deformable.h"
#include "components/math.h"
#include "components/mesh.h"
#include "components/range.h"
#include "components/tet_mesh.h"
#include "pliant/parameters.h"

namespace pliant {

struct SoftBody : SoftBodyParameters {
  Handle<TetMesh> tets;         // set at spawn
  Handle<Mesh> collision_mesh;  // set at spawn: the embedded surface, which collides and is drawn
};

// The law of a soft body's dents, of a node with PLIANT_deformable too (systems/soft/local/dent_spring.h). Writer:
// content at spawn; `mesh` is the collision mesh, without a field.
struct DentLaw : Deformable {};

// A mesh that is only drawn and moves with the body around it (Carries). Writer: content at spawn.
struct Carried {
  Entity by;                 // has a SoftBody or a Deformable
  Handle<Mesh> mesh;         // of its vertices, in the frame of `by`
  std::vector<float> share;  // [1] of a surface's dent, per drawn vertex; empty: it is embedded in tissue
};

struct Handle6 : HandleParameters {
  std::string device;  // node with PLIANT_haptic_device
};

struct RigidBody : RigidBodyParameters {
  Handle<Mesh> collision_mesh;  // set at spawn
};

inline constexpr std::size_t kMostRigidParts = 32;  // of a soft body

// Bounds of their parameters, in a file and in code.
struct SoftBodyRange {
  static constexpr Range kYoung{0.0, 1e12, true};   // [Pa]
  static constexpr Range kPoisson{0.0, 0.499};      // [1]
  static constexpr Range kStiffening{0.0, 100.0};   // [1]
  static constexpr Range kDensity{0.0, 1e6, true};  // [kg/m3]
  static constexpr Range kCell{0.0, 1e3};           // [m]
  static constexpr Range kThickness{0.0, 1e3};      // [m]
  static constexpr Range kMass{0.0, 1e9};           // [kg] of a rigid body
};
inline constexpr Range kVelocityRange{-1e3, 1e3};   // [m/s] of a body at the beginning
inline constexpr Range kPairRange{0.0, 1e9};        // of springs and dampers of couplings, and of Rayleigh damping
inline constexpr Range kSaturationRange{0.0, 1e4};  // [N], [N m] of a coupling

}  // namespace pliant
