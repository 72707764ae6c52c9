#include "content/generate/hand_grip_level.h"

#include <algorithm>
#include <string>

#include "content/author/hand.h"
#include "content/author/hand_bones.h"
#include "content/generate/stage.h"
#include "content/generate/tool_stage.h"

namespace pliant::generate {
namespace {

constexpr double kHeldBall = 0.027;                    // [m] radius
constexpr dvec3 kBallInHand{-0.002, -0.0405, -0.034};  // [m] from the hand's origin: it lies in the open palm

HandBones bones_of_solid() {
  HandBones out;
  out.wrist = {0.0, 0.0, 0.045};
  const auto joints = hand_joints();
  const char* const digits[] = {"thumb", "index", "middle", "ring", "little"};
  const char* const bones[] = {"proximal", "middle", "distal"};
  for (std::size_t d = 0; d < 5; ++d) {
    out.digit[d].joint = joints[d];
    for (std::size_t i = 0; i < 3; ++i) out.digit[d].name[i] = std::string(digits[d]) + "_" + bones[i];
  }
  return out;
}

// Palm up it closes, rises and tilts with the ball, comes back and opens.
std::vector<Waypoint> hand_grip_path() {
  const dvec3 low(0, 0.10, 0), high(0, 0.13, 0), up(0, 0, 180), tilted(0, 0, 145);
  return {{0.0, low, up, 0},        {0.1, low, up, 0},   {0.6, low, up, 0.8}, {0.8, low, up, 0.8},
          {1.5, high, tilted, 0.8}, {2.2, low, up, 0.8}, {2.8, low, up, 0},   {3.0, low, up, 0}};
}

}  // namespace

Result<Level> hand_grip() {
  Level level;
  level.name = "hand_grip";
  level.about = "A hand of tissue on fifteen bones closes by its grip on a soft ball, lifts and tilts it.";
  const std::int32_t stone = add_material(level, "stone", kStone, 0.7f);
  add_slab(level, "table", {0.14, 0.006, 0.14}, {0.0, -0.006, -0.04}, stone);
  LevelNode& held = add_soft(level, "ball", ball(kHeldBall), around(dvec3(kHeldBall + 0.008)), 0.005, 0.0135, 1.5e4,
                             add_material(level, "coral", kCoral, 0.4f));
  const Waypoint begin = hand_grip_path().front();
  const dquat turned = glm::normalize(dquat(glm::radians(begin.turn)));
  held.local.translation = vec3(begin.position + turned * kBallInHand);
  held.soft_body->density = 500.0;
  held.soft_body->rayleigh = {1.0, 0.01};
  held.soft_body->friction_static = held.soft_body->friction_sliding = 0.6;
  LevelNode& hand =
      add_soft(level, "hand", hand_solid(), hand_box(), 0.0042, 0.0115, 4e4, add_tissue(level, "skin", 0.02f));
  place(hand, begin);
  hand.soft_body->friction_static = hand.soft_body->friction_sliding = 0.6;
  const std::int32_t number = static_cast<std::int32_t>(level.nodes.size()) - 1;
  HandBones bones = bones_of_solid();
  bones.wrist = begin.position + turned * bones.wrist;
  for (DigitBones& digit : bones.digit)
    for (dvec3& joint : digit.joint) joint = begin.position + turned * joint;
  if (Status s = put_on_bones(level, number, bones); !s) return s.error();
  level.nodes[static_cast<std::size_t>(number)].device = script_device("hand_grip.csv", 10.0);
  add_view(level, {-0.22, 0.23, -0.30}, {0.0, 0.125, -0.04}, "sky.exr", {0.5, 0.8, -0.4});
  return level;
}

Status write_hand_grip_level(const std::filesystem::path& folder) {
  const Result<Level> level = hand_grip();
  if (!level) return level.error();
  if (Status s = write_scene(*level, folder); !s) return s;
  return write_path(hand_grip_path(), "closes on the ball, lifts and tilts it, comes back and opens", "hand_grip.csv",
                    folder);
}

}  // namespace pliant::generate
