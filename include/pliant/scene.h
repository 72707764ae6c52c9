// A level built in code: deformable surfaces, soft and rigid bodies, tools, probes, effects. A level file can be loaded
// as one too (pliant/content.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pliant/math.h"
#include "pliant/parameters.h"
#include "pliant/result.h"

namespace pliant {

struct Level;

// A triangle mesh. Other arrays are empty or as long as `position`.
struct MeshData {
  std::vector<vec3> position;        // [m]
  std::vector<std::uint32_t> index;  // three per triangle, counter-clockwise from outside
  std::vector<vec3> normal;          // [1] for shading; empty: computed
  std::vector<vec2> uv;
  // Painted factors [1]; 1 where unpainted.
  std::vector<float> stiffness, friction, damping, relaxation;
  // [1] 0 to 1: pinned vertices of a soft body, and those rigidly attached to a tool's handle.
  std::vector<float> pinned, handle;
};

struct Placement {
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  dvec3 scale{1};  // [1]
};

// Copies are independent. A moved-from one may only be destroyed or assigned to. Names must be unique: they identify
// objects in a Session. Session::open reports errors in the scene (a mesh without triangles, a parameter out of range,
// a duplicate name).
class Scene {
 public:
  explicit Scene(std::string name = "scene");
  explicit Scene(const Level& level);
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  Simulation& simulation() & PLIANT_LIFETIMEBOUND;  // valid as long as the scene

  // A deformable surface (P1).
  void add_surface(const std::string& name, MeshData mesh, const DeformableParameters& parameters = {},
                   const Placement& placement = {});
  // FEM on tetrahedra made from the mesh (P2).
  void add_soft_body(const std::string& name, MeshData mesh, const SoftBodyParameters& parameters = {},
                     const Placement& placement = {});
  void add_rigid_body(const std::string& name, MeshData mesh, const RigidBodyParameters& parameters = {},
                      const Placement& placement = {});
  // Makes an existing soft or rigid body a tool that is moved by its handle.
  Status add_handle(const std::string& body, const HandleParameters& parameters = {},
                    const DeviceParameters& device = {});
  void add_probe(const std::string& name, const ProbeParameters& parameters = {}, const DeviceParameters& device = {},
                 const Placement& placement = {});
  // Acts on probes in space, on all or on those that it names. `path`: of the kind guidance, in the effect's frame; its
  // times do not count, and no file is read.
  void add_effect(const std::string& name, const EffectParameters& parameters = {}, const Placement& placement = {},
                  Path path = {});
  // Connects bodies of the scene.
  void add_joint(const std::string& name, const JointParameters& parameters, const Placement& placement = {});

  // The level format's own description (content/level/level.h); not part of the public interface.
  const Level& level() const { return *level_; }
  Level& level() { return *level_; }

 private:
  std::unique_ptr<Level> level_;
};

}  // namespace pliant
