#include "content/generate/grasp_level.h"

#include <algorithm>
#include <cmath>

#include "content/author/save_script.h"
#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr double kGraspBall = 0.030;          // [m] radius of the ball, which lies on the table, y = 0
constexpr double kAboveBall = 0.062;          // [m] of the palm's middle above that of the ball, as it grips
constexpr dvec2 kFingerHinge{0.025, -0.008};  // [m] of a finger: out from the palm's axis, and up from its middle
constexpr dvec2 kKnuckle{0.032, -0.034};      // [m] the same, as it touches the ball
constexpr dvec2 kFingerTip{0.045, -0.076};
constexpr double kOpenBy = 28.0, kPressedBy = 12.0;  // [degree] from there: where it begins; where a closed grip aims
constexpr double kFingerRoot = 0.0062, kFingerEnd = 0.0054;  // [m] half its width

// Along +X from the palm's axis, its hinge at the origin, in the pose in which it begins.
Solid grasp_finger() {
  const auto at = [](dvec2 p) {
    const dvec2 d = p - kFingerHinge;
    const double a = glm::radians(kOpenBy);
    return dvec3(d.x * std::cos(a) - d.y * std::sin(a), d.x * std::sin(a) + d.y * std::cos(a), 0.0);
  };
  const dvec3 knuckle = at(kKnuckle), tip = at(kFingerTip);
  return [=](dvec3 p) {
    return std::min(tapered(p, dvec3(0), knuckle, kFingerRoot, kFingerRoot),
                    tapered(p, knuckle, tip, kFingerRoot, kFingerEnd));
  };
}

// A disc with a rounded rim, and a wrist.
Solid grasp_palm() {
  return [](dvec3 p) {
    const dvec2 q = dvec2(length(dvec2(p.x, p.z)), std::abs(p.y)) - dvec2(0.026, 0.001);
    const double disc = length(glm::max(q, dvec2(0))) + std::min(std::max(q.x, q.y), 0.0) - 0.006;
    const double wrist = tapered(p, dvec3(0, 0.008, 0), dvec3(0, 0.052, 0), 0.013, 0.011);
    const double blend = std::max(0.008 - std::abs(disc - wrist), 0.0) / 0.008;
    return std::min(disc, wrist) - blend * blend * 0.002;
  };
}

void add_hand_part(LevelNode& node) {
  node.rigid_body = RigidBody{};
  node.rigid_body->density = 540.0;  // hollow: the hand feels little of its inertia
  node.rigid_body->friction_static = 0.9;
  node.rigid_body->friction_sliding = 0.8;
}

void add_finger(Level& level, int number, const LevelNode& palm, std::int32_t material) {
  const std::string name = std::string("finger_") + "abc"[number];
  const dquat around = glm::angleAxis(glm::radians(90.0 + 120.0 * number), dvec3(0, 1, 0));
  const vec3 hinge = palm.local.translation + vec3(around * dvec3(kFingerHinge.x, kFingerHinge.y, 0.0));
  const Box box{{-0.015f, -0.085f, -0.01f}, {0.085f, 0.015f, 0.01f}};
  LevelNode& node = add_shape(level, name, grasp_finger(), box, 0.0034, material);
  node.local = {hinge, quat(around)};
  add_hand_part(node);
  node.rigid_body->density = 200.0;
  LevelNode& joint = add_node(level, "joint_" + std::string(1, "abc"[number]));
  joint.local = {hinge, quat(around * glm::angleAxis(glm::radians(90.0), dvec3(1, 0, 0)))};
  joint.joint = Joint{};
  joint.joint->kind = JointKind::kHinge;
  joint.joint->a = name;
  joint.joint->b = joint.joint->grip = "palm";
  joint.joint->closed = -glm::radians(kOpenBy + kPressedBy);
  joint.joint->stiffness = 0.8;
  joint.joint->damping = 0.02;
  joint.joint->max_force = 0.25;
}

struct GraspMoment {
  double time;    // [s]
  dvec3 middle;   // [m] of the ball that it holds
  double turned;  // [degree] about +Z, around that
  double grip;    // [1]
};

// Down over the ball, closes, up by 20 cm, over and back, down, opens, up.
std::vector<GraspMoment> grasp_moments() {
  const dvec3 low(0, kGraspBall, 0), high(0, kGraspBall + 0.20, 0), above(0, kGraspBall + 0.03, 0);
  return {{0.0, above, 0, 0},  {0.85, low, 0, 0},   {0.9, low, 0, 0},   {1.5, low, 0, 1},  {2.7, high, 0, 1},
          {4.0, high, 180, 1}, {4.6, high, 180, 1}, {5.9, high, 0, 1},  {7.1, low, 0, 1},  {7.3, low, 0, 1},
          {7.8, low, 0, 0},    {8.0, low, 0, 0},    {8.8, above, 0, 0}, {9.0, above, 0, 0}};
}

Path grasp_path() {
  const std::vector<GraspMoment> at = grasp_moments();
  Path out;
  out.turns = out.grips = true;
  for (int row = 0; row <= static_cast<int>(std::lround(at.back().time * kFineRate)); ++row) {
    const double t = row / kFineRate;
    GraspMoment now = at.front();
    for (std::size_t i = 1; i < at.size(); ++i) {
      const double s = smooth_step(at[i - 1].time, at[i].time, t);
      now.middle += (at[i].middle - at[i - 1].middle) * s;
      now.turned += (at[i].turned - at[i - 1].turned) * s;
      now.grip += (at[i].grip - at[i - 1].grip) * s;
    }
    const dquat turned = glm::angleAxis(glm::radians(now.turned), dvec3(0, 0, 1));
    out.rows.push_back({t, now.middle + turned * dvec3(0, kAboveBall, 0), turned, std::clamp(now.grip, 0.0, 1.0)});
  }
  return out;
}

}  // namespace

Level grasp() {
  Level level;
  level.name = "grasp";
  level.about = "A hand with three fingers closes on a soft ball, lifts it, turns it over, and puts it down.";
  level.simulation.soft_step = 0.01;  // [s] at 1/60 some steps of the turn do not converge
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f),
                     steel = add_material(level, "steel", kSteel, 0.3f),
                     skin = add_material(level, "skin", kSkin, 0.45f);
  add_slab(level, "table", {0.12, 0.006, 0.10}, {0.0, -0.006, 0.0}, stone);
  const std::int32_t coral = add_material(level, "coral", kCoral, 0.4f);
  LevelNode& soft =
      add_soft(level, "ball", ball(kGraspBall), around(dvec3(kGraspBall + 0.008)), 0.005, 0.0135, 4e4, coral);
  soft.local.translation = vec3(0.0f, static_cast<float>(kGraspBall), 0.0f);
  soft.soft_body->density = 300.0;
  soft.soft_body->rayleigh = {1.0, 0.01};
  soft.soft_body->friction_static = 0.9;
  soft.soft_body->friction_sliding = 0.8;
  LevelNode& hand =
      add_shape(level, "palm", grasp_palm(), {{-0.04f, -0.014f, -0.04f}, {0.04f, 0.07f, 0.04f}}, 0.005, steel);
  hand.local.translation = vec3(grasp_path().rows.front().position);
  add_hand_part(hand);
  hand.handle = Handle6{};
  hand.handle->translation = {1500.0, 15.0};
  hand.handle->rotation = {6.0, 0.06};
  hand.handle->max_force = 10.0;
  hand.handle->max_torque = 1.0;
  hand.handle->device = "palm";
  hand.device = script_device("grasp.csv", 10.0);
  const LevelNode at = hand;
  for (int number = 0; number < 3; ++number) add_finger(level, number, at, skin);
  add_view(level, {0.30, 0.26, 0.62}, {0.0, 0.155, 0.0}, "sky.exr", {0.5, 0.8, 0.5});
  return level;
}

Status write_grasp_level(const std::filesystem::path& folder) {
  if (Status s = write_scene(grasp(), folder); !s) return s;
  return save_script(grasp_path(), "closes on the ball, lifts it, turns it over and back, and puts it down",
                     folder / "grasp.csv");
}

}  // namespace pliant::generate
