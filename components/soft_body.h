// The second system's authoring (P2): flesh, its rigid handle, and rigid bodies. Keys of PLIANT_soft_body,
// PLIANT_handle and PLIANT_rigid_body. Rate: soft (read). Writer: content at spawn.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "components/math.h"
#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "pliant/parameters.h"

namespace pliant {

struct SoftBody : SoftBodyParameters {
  Handle<TetMesh> tets;  // set at spawn
  Handle<Mesh> skin;     // set at spawn: the embedded surface, which collides and is drawn
};

struct Handle6 : HandleParameters {
  std::string device;  // node with PLIANT_haptic_device
};

struct RigidBody : RigidBodyParameters {
  Handle<Mesh> skin;  // set at spawn
};

}  // namespace pliant
