#include "content/generate/forceps_level.h"

#include <algorithm>
#include <string>

#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr double kVesselRadius = 0.006, kVesselHalf = 0.060;  // [m] along X, on a bed whose top is y = 0
constexpr double kVesselHeight = kVesselRadius + 0.0003;      // [m] of its axis
constexpr double kTakenAt = -0.042;                           // [m] along X, where the jaws close
constexpr double kShaftAbove = 0.052;                         // [m] of the shaft's origin above the vessel's axis
constexpr dvec2 kJawHinge{0.005, 0.0};                        // [m] of a jaw: out from the shaft's axis, and up
constexpr dvec2 kJawBend{0.013, -0.024};                      // [m] the same, as it touches the vessel
constexpr dvec2 kJawTip{0.0088, -0.053};
constexpr double kJawOpenBy = 11.0, kJawPressedBy = 8.0;  // [degree] from there
constexpr double kJawRoot = 0.0036, kJawEnd = 0.0030;     // [m] half its width
constexpr int kBonds = 13;
constexpr double kBondStep = 0.008;  // [m]

// Along +X from the shaft's axis, its hinge at the origin, in the pose in which it begins.
Solid jaw() {
  const auto at = [](dvec2 p) {
    return glm::angleAxis(glm::radians(kJawOpenBy), dvec3(0, 0, 1)) * dvec3(p - kJawHinge, 0.0);
  };
  const dvec3 bend = at(kJawBend), tip = at(kJawTip);
  return [=](dvec3 p) {
    return std::min(tapered(p, dvec3(0), bend, kJawRoot, kJawRoot), tapered(p, bend, tip, kJawRoot, kJawEnd));
  };
}

void make_steel(LevelNode& node) {
  node.rigid_body = RigidBody{};
  node.rigid_body->density = 750.0;  // hollow: in free air the hand feels less than 10 mN of its inertia
  node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.9;  // serrated
}

void add_jaw(Level& level, bool left, const dvec3& shaft, std::int32_t material) {
  const dquat around = glm::angleAxis(glm::radians(left ? 90.0 : -90.0), dvec3(0, 1, 0));
  const vec3 hinge(shaft + around * dvec3(kJawHinge, 0.0));
  const std::string side = left ? "left" : "right";
  LevelNode& node =
      add_shape(level, "jaw_" + side, jaw(), {{-0.008f, -0.065f, -0.008f}, {0.035f, 0.008f, 0.008f}}, 0.003, material);
  node.local = {hinge, quat(around)};
  make_steel(node);
  LevelNode& hinged = add_node(level, "hinge_" + side);
  hinged.local = {hinge, quat(around * glm::angleAxis(glm::radians(90.0), dvec3(1, 0, 0)))};
  hinged.joint = Joint{};
  hinged.joint->kind = JointKind::kHinge;
  hinged.joint->a = "jaw_" + side;
  hinged.joint->b = hinged.joint->grip = "forceps";
  hinged.joint->closed = -glm::radians(kJawOpenBy + kJawPressedBy);
  hinged.joint->stiffness = 0.8;
  hinged.joint->damping = 0.01;
  hinged.joint->max_force = 0.2;
}

// Each peels off by itself.
void add_bonds(Level& level) {
  for (int i = 0; i < kBonds; ++i) {
    LevelNode& bond = add_node(level, "bond_" + std::string(1, static_cast<char>('a' + i)));
    bond.local.translation = vec3(dvec3((i - kBonds / 2) * kBondStep, 0.0, 0.0));
    bond.joint = Joint{};
    bond.joint->kind = JointKind::kBall;
    bond.joint->a = "vessel";
    bond.joint->b = "bed";
    bond.joint->strength = 0.25;
  }
}

std::vector<Waypoint> forceps_path() {
  const dvec3 low(kTakenAt, kVesselHeight + kShaftAbove, 0), above = low + dvec3(0, 0.02, 0),
                                                             high = low + dvec3(0.016, 0.050, 0), up(0);
  return {{0.0, above, up, 0}, {1.0, low, up, 0}, {1.2, low, up, 0}, {1.8, low, up, 1},  {5.4, high, up, 1},
          {6.2, high, up, 1},  {7.6, low, up, 1}, {8.2, low, up, 0}, {9.2, above, up, 0}};
}

}  // namespace

Level forceps() {
  Level level;
  level.name = "forceps";
  level.about = "Jaws take a vessel by the grip and peel it off its bed.";
  const std::int32_t steel = add_material(level, "steel", kSteel, 0.3f);
  add_slab(level, "bed", {0.090, 0.010, 0.045}, {0.0, -0.010, 0.0}, add_tissue(level, "liver", 0.02f));
  const Solid tube = [](dvec3 p) {
    return tapered(p, {-kVesselHalf, 0, 0}, {kVesselHalf, 0, 0}, kVesselRadius, kVesselRadius);
  };
  LevelNode& vessel = add_soft(level, "vessel", tube, around({kVesselHalf + 0.010, 0.010, 0.010}), 0.0045, 0.009, 1.2e5,
                               add_material(level, "vessel", {0.55f, 0.05f, 0.06f}, 0.35f));
  vessel.local.translation = vec3(0.0f, static_cast<float>(kVesselHeight), 0.0f);
  vessel.soft_body->rayleigh = {2.0, 0.01};
  vessel.soft_body->pinned = {{0.056f, -0.02f, -0.02f}, {0.08f, 0.02f, 0.02f}};  // it goes on into the organ
  vessel.soft_body->friction_static = vessel.soft_body->friction_sliding = 0.9;
  const dvec3 begins = forceps_path().front().position;
  const Solid shaft = [](dvec3 p) {
    return std::min(tapered(p, {0, 0, -0.006}, {0, 0, 0.006}, 0.005, 0.005),
                    tapered(p, {0, 0, 0}, {0, 0.075, 0}, 0.005, 0.007));
  };
  LevelNode& hand =
      add_shape(level, "forceps", shaft, {{-0.012f, -0.01f, -0.016f}, {0.012f, 0.088f, 0.016f}}, 0.0035, steel);
  hand.local.translation = vec3(begins);
  make_steel(hand);
  hand.handle = Handle6{};
  hand.handle->translation = {1500.0, 15.0};
  hand.handle->rotation = {6.0, 0.06};
  hand.handle->max_force = 10.0;
  hand.handle->max_torque = 1.0;
  hand.handle->device = "forceps";
  hand.device = script_device("forceps.csv", 10.0);
  for (const bool left : {true, false}) add_jaw(level, left, begins, steel);
  add_bonds(level);
  add_view(level, {-0.10, 0.10, 0.24}, {0.005, 0.035, 0.0}, "sky.exr", {-0.3, 0.8, 0.5});
  return level;
}

Status write_forceps_level(const std::filesystem::path& folder) {
  if (Status s = write_scene(forceps(), folder); !s) return s;
  return write_path(forceps_path(), "takes the vessel, peels it off its bed, and puts it down", "forceps.csv", folder,
                    kFineRate);
}

}  // namespace pliant::generate
