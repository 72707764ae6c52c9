#include "content/author/hand_bones.h"

#include <algorithm>
#include <cmath>

#include "content/author/edit_nodes.h"
#include "content/author/object_frame.h"
#include "content/author/save_script.h"
#include "content/level/spawn_soft.h"

namespace pliant {
namespace {

// A rigid part, as a share of the bone's length, and of the flesh around it: sideways, towards the back of the hand,
// which it includes, and towards the palm, where tissue stays. [1]
constexpr double kBoneBegin = 0.2, kBoneEnd = 0.8, kBoneAside = 0.8, kBoneBack = 1.2, kBonePalm = 0.35;
constexpr double kCellOfHand = 0.033;              // [1] of wrist to tip, around the digits: coarser elsewhere
constexpr int kNodesOfBone = 4, kWiderRounds = 8;  // of 10 % each
constexpr std::array<double, 3> kFingerClosed{55.0, 65.0, 45.0}, kThumbClosed{25.0, 30.0, 40.0};  // [degree]
constexpr double kStretched = -10.0, kBentMost = 100.0;                                           // [degree]

// An oriented box of a rigid part; its axes are the columns.
struct BoneBox {
  dvec3 center;  // [m]
  dmat3 axes;
  dvec3 half, most;  // [m] along the axes: as it should be, and as far as its corners may reach
};

// A box along the axes of the frame, within `most`: its longest side is shortened until it fits.
DBox inscribed(const BoneBox& bone) {
  std::array<int, 3> by_length{0, 1, 2};
  std::sort(by_length.begin(), by_length.end(), [&](int a, int b) { return bone.half[a] > bone.half[b]; });
  dvec3 half(0);
  for (const int k : by_length) {
    int best = -1;
    for (int i = 0; i < 3; ++i)
      if (half[i] == 0.0 && (best < 0 || std::abs(bone.axes[k][i]) > std::abs(bone.axes[k][best]))) best = i;
    half[best] = bone.half[k];
  }
  const auto fits = [&] {
    for (int k = 0; k < 3; ++k)
      if (dot(glm::abs(bone.axes[k]), half) > bone.most[k]) return false;
    return true;
  };
  for (int i = 0; i < 200 && !fits(); ++i) {
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (half[k] > half[longest]) longest = k;
    half[longest] *= 0.95;
  }
  return {bone.center - half, bone.center + half};
}

// Directions of a hand, unit. Which side is the palm's shows in fingers that are a little bent at rest, as hands are.
struct HandAxes {
  dvec3 along, across, palmar;  // wrist to knuckles; index to little finger; out of the palm
};

HandAxes axes_of(const HandBones& hand) {
  dvec3 knuckles(0), bend(0);
  for (std::size_t i = 1; i < 5; ++i) {
    const std::array<dvec3, 4>& at = hand.digit[i].joint;
    knuckles += 0.25 * at[0];
    bend += cross(at[1] - at[0], at[2] - at[1]) + cross(at[2] - at[1], at[3] - at[2]);
  }
  HandAxes out;
  out.along = normalize(knuckles - hand.wrist);
  out.across = hand.digit[4].joint[0] - hand.digit[1].joint[0];
  out.across = normalize(out.across - dot(out.across, out.along) * out.along);
  const dvec3 normal = cross(out.across, out.along);
  out.palmar = dot(cross(bend, out.along), normal) < 0.0 ? -normal : normal;
  return out;
}

// The axis about which a bone bends towards the palm; of a bone that points there already, that of a straight one.
dvec3 bending_axis(const HandAxes& axes, dvec3 along) {
  const dvec3 axis = cross(along, axes.palmar), straight = cross(axes.along, axes.palmar);
  return length(axis) > 0.1 * length(along) ? normalize(axis)
                                            : normalize(straight - along * (dot(straight, along) / dot(along, along)));
}

// [m] From the middle part of a segment to the nearest vertex of the mesh. All in the object frame.
double flesh_around(const std::vector<dvec3>& skin, dvec3 a, dvec3 b) {
  double least = 1e9;
  for (const dvec3& p : skin) {
    const double s = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), kBoneBegin, kBoneEnd);
    least = std::min(least, length(p - a - s * (b - a)));
  }
  return least;
}

BoneBox bone_between(const std::vector<dvec3>& skin, dvec3 a, dvec3 b, const HandAxes& axes) {
  const double flesh = flesh_around(skin, a, b), half = 0.5 * (kBoneEnd - kBoneBegin) * length(b - a);
  const dvec3 along = normalize(b - a), aside = bending_axis(axes, along), back = cross(along, aside);
  const double thick = 0.5 * (kBoneBack + kBonePalm) * flesh, aside_by = kBoneAside * flesh;
  return {0.5 * (a + b) + 0.5 * (kBoneBack - kBonePalm) * flesh * back,
          {along, aside, back},
          {half, aside_by, thick},
          {1.2 * half, 1.2 * aside_by, 1.2 * thick}};
}

BoneBox palm_between(const std::vector<dvec3>& skin, const HandBones& hand, const HandAxes& axes) {
  dvec3 knuckles(0);
  for (std::size_t i = 1; i < 5; ++i) knuckles += 0.25 * hand.digit[i].joint[0];
  const double half = 0.35 * length(knuckles - hand.wrist);
  const double wide = 0.42 * length(hand.digit[4].joint[0] - hand.digit[1].joint[0]);
  const dvec3 center = 0.5 * (knuckles + hand.wrist);
  const double flesh = flesh_around(skin, center - half * axes.along, center + half * axes.along);
  return {
      center, {axes.along, axes.across, axes.palmar}, {half, wide, 0.6 * flesh}, {1.2 * half, 1.2 * wide, 0.9 * flesh}};
}

bool overlap(const DBox& a, const DBox& b) {
  return glm::all(glm::lessThan(a.min, b.max)) && glm::all(glm::lessThan(b.min, a.max));
}

// Rigid parts may not share a node.
void keep_apart(std::vector<DBox>& boxes) {
  const auto shrink = [](DBox& box) {
    const dvec3 less = 0.025 * (box.max - box.min);
    box.min += less, box.max -= less;
  };
  for (int round = 0; round < 50; ++round)
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (overlap(boxes[i], boxes[k])) shrink(boxes[i]), shrink(boxes[k]);
}

// Widens boxes until each holds as many nodes as fix its rotation.
void hold_nodes(std::vector<DBox>& boxes, const std::vector<dvec3>& nodes) {
  const auto held = [&](const DBox& box) {
    return std::count_if(nodes.begin(), nodes.end(), [&](const dvec3& p) {
      return glm::all(glm::greaterThanEqual(p, box.min)) && glm::all(glm::lessThanEqual(p, box.max));
    });
  };
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (int round = 0; round < kWiderRounds && held(boxes[i]) < kNodesOfBone; ++round) {
      const dvec3 more = 0.05 * (boxes[i].max - boxes[i].min);
      const DBox wider{boxes[i].min - more, boxes[i].max + more};
      bool free = true;
      for (std::size_t k = 0; k < boxes.size(); ++k) free = free && (k == i || !overlap(wider, boxes[k]));
      if (!free) break;
      boxes[i] = wider;
    }
}

dvec3 hinge_axis(const HandBones& hand, const HandAxes& axes, std::size_t digit) {
  const std::array<dvec3, 4>& at = hand.digit[digit].joint;
  if (digit > 0) return bending_axis(axes, at[1] - at[0]);
  // A thumb closes towards the middle finger, in front of the palm.
  const double wide = length(hand.digit[4].joint[0] - hand.digit[1].joint[0]);
  const dvec3 meets = 0.5 * (hand.digit[2].joint[0] + hand.digit[3].joint[0]) + 0.6 * wide * axes.palmar;
  const dvec3 along = at[3] - at[0], way = meets - at[3], axis = cross(along, way);
  return length(axis) > 0.1 * length(along) * length(way) ? normalize(axis) : bending_axis(axes, along);
}

void add_hinges(Level& level, const std::string& tool, const HandBones& hand, const HandAxes& axes) {
  for (std::size_t d = 0; d < hand.digit.size(); ++d) {
    const dvec3 axis = hinge_axis(hand, axes, d);
    const double cosine = axis.y;
    const dquat turn =
        cosine < -0.999999 ? dquat(0, 1, 0, 0) : glm::normalize(dquat(1.0 + cosine, cross(dvec3(0, 1, 0), axis)));
    for (std::size_t i = 0; i < 3; ++i) {
      LevelNode node;
      node.name = free_name(level, hand.digit[d].name[i] + "_hinge");
      node.local = {vec3(hand.digit[d].joint[i]), quat(turn)};
      node.joint = Joint{};
      node.joint->kind = JointKind::kHinge;
      node.joint->a = node.joint->b = node.joint->grip = tool;
      node.joint->part_a = hand.digit[d].name[i];
      node.joint->part_b = i == 0 ? kHandlePart : hand.digit[d].name[i - 1];
      node.joint->limits = {glm::radians(kStretched), glm::radians(kBentMost)};
      node.joint->closed = glm::radians(d == 0 ? kThumbClosed[i] : kFingerClosed[i]);
      node.joint->stiffness = 0.6;
      node.joint->damping = 0.015;
      node.joint->max_force = 0.4;
      add_node(level, std::move(node));
    }
  }
}

}  // namespace

Status put_on_bones(Level& level, std::int32_t number, const HandBones& hand) {
  const ObjectFrame frame = object_frame(level, number);
  LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
  std::vector<dvec3> skin;
  for (const Primitive& primitive : level.meshes[static_cast<std::size_t>(node.mesh)].primitives)
    for (const vec3& p : primitive.position) skin.push_back(dvec3(frame.to_object * glm::dvec4(dvec3(p), 1.0)));
  HandBones local = hand;
  local.wrist = frame.pose.to_local(hand.wrist);
  for (DigitBones& digit : local.digit)
    for (dvec3& at : digit.joint) at = frame.pose.to_local(at);
  const HandAxes axes = axes_of(local);
  std::vector<DBox> boxes{inscribed(palm_between(skin, local, axes))};
  for (const DigitBones& digit : local.digit)
    for (std::size_t i = 0; i < 3; ++i)
      boxes.push_back(inscribed(bone_between(skin, digit.joint[i], digit.joint[i + 1], axes)));
  keep_apart(boxes);
  SoftBody& body = *node.soft_body;
  if (body.cell == 0.0 && body.mesh.empty()) {
    body.cell = kCellOfHand * length(local.digit[2].joint[3] - local.wrist);
    for (const DigitBones& digit : local.digit)
      for (std::size_t i = 1; i < 4; ++i) body.focus.add(vec3(digit.joint[i]));
  }
  LevelNode plain = node;
  plain.handle.reset();
  plain.soft_body->rigid.clear();
  const Result<SoftParts> tissue = make_soft_parts(plain, &level.meshes[static_cast<std::size_t>(node.mesh)],
                                                   mat4(frame.to_object), level.path.parent_path());
  if (!tissue) return tissue.error();
  hold_nodes(boxes, tissue->tets.nodes);
  body.rigid.clear();
  for (std::size_t i = 1; i < boxes.size(); ++i)
    body.rigid.push_back({hand.digit[(i - 1) / 3].name[(i - 1) % 3], boxes[i]});
  node.handle = Handle6{};
  node.handle->box = {vec3(boxes[0].min), vec3(boxes[0].max)};
  node.handle->translation = {1000.0, 10.0};
  node.handle->rotation = {3.0, 0.03};
  node.handle->max_force = 10.0;
  node.handle->max_torque = 1.0;
  node.handle->carried = true;
  node.handle->force = ToolForce::kLinear;
  node.handle->device = node.name;
  node.device = HapticDevice{};
  node.device->max_force = 10.0;
  add_hinges(level, std::string(node.name), hand, axes_of(hand));
  return Done{};
}

Path closing_path(const Level& level, std::int32_t node) {
  const Pose at = object_frame(level, node).pose;
  Path out;
  out.turns = out.grips = true;
  for (int row = 0; row <= 600; ++row) {
    const double t = 0.01 * row, u = std::fmod(t, 3.0);
    out.rows.push_back({t, at.position, at.rotation, smooth_step(0.2, 1.2, u) - smooth_step(1.7, 2.7, u)});
  }
  return out;
}

}  // namespace pliant
