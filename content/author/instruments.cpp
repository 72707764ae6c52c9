#include "content/author/instruments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "content/author/edit_nodes.h"
#include "content/author/hand.h"
#include "content/author/save_script.h"
#include "content/author/staging.h"
#include "content/author/tube.h"

namespace pliant {

namespace {

using solids::Net;
using solids::TubeRing;

constexpr std::array<Instrument, 4> kInstruments{
    {{InstrumentKind::kRod, "rod", "a straight rod with a round end", 0.75, 0.02},
     {InstrumentKind::kSphereTip, "sphere_tip", "a thin shaft with a ball at its end", 0.75, 0.03},
     {InstrumentKind::kTweezersArm, "tweezers_arm", "one arm of tweezers: flat curve, fine end", 0.75, 0.012},
     {InstrumentKind::kHand, "hand", "a soft right hand on a rigid wrist, fingers flat", 0.0, 0.0}}};

constexpr double kMass = 0.025;                                // [kg] of a rigid instrument
constexpr double kUsualLength = 0.15;                          // [m] the length that the coupling's rotational
                                                               // stiffness is tuned for
constexpr double kHandLength = 0.19;                           // [m]
constexpr double kSmallestHandOf = 0.1, kLargestHandOf = 1.0;  // [m] diagonals of objects that a life-size hand suits
constexpr vec3 kSteel{0.55f, 0.56f, 0.58f}, kSkinColor{0.80f, 0.52f, 0.40f};  // linear RGB

// Outermost entry and exit of the line through p along `up`, as distances from p.
struct Chord {
  double bottom = 0.0, top = 0.0;  // [m]
  bool valid = false;
};

std::vector<std::array<dvec3, 3>> world_triangles(const Level& level, std::int32_t object) {
  std::vector<std::array<dvec3, 3>> out;
  const LevelNode& node = level.nodes[static_cast<std::size_t>(object)];
  if (node.mesh < 0) return out;
  const dmat4 world = world_matrices(level.nodes)[static_cast<std::size_t>(object)];
  for (const Primitive& primitive : level.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
    const auto at = [&](std::size_t i) {
      return dvec3(world * glm::dvec4(dvec3(primitive.position[primitive.index[i]]), 1.0));
    };
    for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3) out.push_back({at(t), at(t + 1), at(t + 2)});
  }
  return out;
}

Chord chord(const std::vector<std::array<dvec3, 3>>& triangles, dvec3 p, dvec3 up) {
  Chord out;
  for (const auto& triangle : triangles) {
    const dvec3 a = triangle[0] - p, ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
    const dvec3 across = cross(up, ac);
    const double area = dot(ab, across);
    if (area == 0.0) continue;
    const double u = dot(-a, across) / area, v = dot(up, cross(-a, ab)) / area;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
    const double s = dot(ac, cross(-a, ab)) / area;
    out.bottom = out.valid ? std::min(out.bottom, s) : s;
    out.top = out.valid ? std::max(out.top, s) : s;
    out.valid = true;
  }
  return out;
}

// The point to touch: on top of the object, as near to the middle of its box as it is half as thick as at its thickest.
// Thickness is measured along kColumns x kColumns lines, if possible of those that pass `taken` at least `apart` [m]
// away, and best where the top does not rise by half the way to the next line.
dvec3 touch_point(const Level& level, std::int32_t object, const Box& taken = {}, double apart = 0.0) {
  constexpr int kColumns = 15, kHalf = kColumns / 2;
  const Box box = world_box(level, object);
  const dvec3 up = up_of(level), middle(box.center());
  const dvec3 side = normalize(cross(up, std::abs(up.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1)));
  const dvec3 axes[] = {side, cross(up, side)};
  double reach[2];
  for (int i = 0; i < 2; ++i) reach[i] = dot(glm::abs(axes[i]), dvec3(box.max - box.min)) / kColumns;
  const std::vector<std::array<dvec3, 3>> triangles = world_triangles(level, object);
  struct Column {
    dvec3 top;
    double thick = 0.0, away = 0.0;  // [m]
  };
  std::vector<Column> columns;
  double thickest = 0.0;
  for (int i = -kHalf; i <= kHalf; ++i)
    for (int k = -kHalf; k <= kHalf; ++k) {
      const dvec3 aside = i * reach[0] * axes[0] + k * reach[1] * axes[1];
      const Chord through = chord(triangles, middle + aside, up);
      if (!through.valid) continue;
      columns.push_back({middle + aside + through.top * up, through.top - through.bottom, length(aside)});
      thickest = std::max(thickest, columns.back().thick);
    }
  const auto is_free = [&](const Column& column) {
    const vec3 p(column.top), way = p - glm::clamp(p, taken.min, taken.max);
    return taken.empty() || length(dvec3(way) - dot(dvec3(way), up) * up) >= apart;
  };
  const auto is_level = [&](const Column& column) {
    return std::none_of(columns.begin(), columns.end(), [&](const Column& other) {
      const dvec3 way = other.top - column.top;
      const double rise = dot(way, up), run = length(way - rise * up);
      return 2 * rise > run && run < 1.5 * std::max(reach[0], reach[1]);
    });
  };
  for (const auto& [anywhere, steep] : {std::pair{false, false}, {false, true}, {true, false}, {true, true}}) {
    const Column* best = nullptr;
    for (const Column& column : columns)
      if (column.thick >= 0.5 * thickest && (!best || column.away < best->away) && (anywhere || is_free(column)) &&
          (steep || is_level(column)))
        best = &column;
    if (best) return best->top;
  }
  dvec3 highest = middle;
  for (const auto& triangle : triangles)
    for (const dvec3& at : triangle)
      if (dot(at, up) > dot(highest, up)) highest = at;
  return highest;
}

// The same beside the tools that are there already, if one is less than `apart` [m] aside.
dvec3 free_touch_point(const Level& level, std::int32_t object, double apart) {
  const dvec3 up = up_of(level), point = touch_point(level, object);
  Box tools;
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    if (!level.nodes[n].in_scene || !level.nodes[n].handle || level.nodes[n].mesh < 0) continue;
    const Box box = world_box(level, static_cast<std::int32_t>(n));
    const dvec3 way = point - dvec3(glm::clamp(vec3(point), box.min, box.max));
    if (length(way - dot(way, up) * up) >= apart) continue;
    tools.add(box.min);
    tools.add(box.max);
  }
  return tools.empty() ? point : touch_point(level, object, tools, apart);
}

// A rod along -Y, its origin a third of the way down. [m]
Net rod(double length, double tip, double shaft, double bend) {
  const double top = length / 3.0, grip = 1.3 * std::max(shaft, 0.02 * length);
  std::vector<TubeRing> rings;
  const auto along = [&](double y) {  // the axis bends towards -Z below the grip
    const double t = std::max(0.0, -y) / (2.0 / 3.0 * length);
    return std::pair{dvec3(0, y, -bend * length * t * t), normalize(dvec3(0, -1, -3.0 * bend * t))};
  };
  const auto add = [&](double y, double radius) {
    const auto [centre, direction] = along(y);
    rings.push_back({centre, direction, radius});
  };
  add(top - 0.2 * grip, 0.6 * grip);
  add(top - 0.6 * grip, grip);
  add(0.0, grip);
  add(-0.1 * length, grip);
  add(-0.16 * length, shaft);
  const double end = -2.0 / 3.0 * length;  // the far pole of the tip
  const double shrinks = std::min(shaft, tip) < shaft ? tip : shaft;
  constexpr int kSections = 4, kSteps = 6;
  const double enters = std::asin(std::min(1.0, shrinks / tip));
  const double neck = end + tip + tip * std::cos(enters);
  for (int i = 1; i < kSections; ++i) {
    const double share = double(i) / kSections, y = -0.16 * length + share * (neck + 0.16 * length);
    add(y, shaft + share * (shrinks - shaft));
  }
  const auto [pole, direction] = along(end);
  const dvec3 centre = pole - tip * direction;
  for (int i = 0; i < kSteps; ++i) {
    const double a = enters + (glm::pi<double>() - enters) * i / kSteps;  // from the pole towards the grip
    rings.push_back({centre - tip * std::cos(a) * direction, direction, tip * std::sin(a)});
  }
  return solids::tube({0, top, 0}, rings, pole);
}

Primitive as_primitive(const Net& net) {
  Primitive out;
  for (const dvec3& p : net.position) out.position.push_back(vec3(p));
  for (const uvec3& t : net.triangles) out.index.insert(out.index.end(), {t.x, t.y, t.z});
  return out;
}

Handle6 handle_of(const std::string& device) {
  Handle6 out;
  out.device = device;
  return out;
}

HapticDevice device_of(double max_force) {
  HapticDevice out;
  out.max_force = max_force;
  return out;
}

// A mesh of rigid instruments and their bodies.
void make_rigid(Level& level, LevelNode& node, const Instrument& kind, double diagonal, const InstrumentSize& asked) {
  const double length = asked.length > 0.0 ? asked.length : kind.length * diagonal;
  const double tip = asked.tip > 0.0 ? asked.tip : kind.tip * length;
  const bool ball = kind.kind == InstrumentKind::kSphereTip, arm = kind.kind == InstrumentKind::kTweezersArm;
  Primitive primitive = as_primitive(rod(length, tip, ball ? 0.55 * tip : arm ? 2.0 * tip : tip, arm ? 0.06 : 0.0));
  primitive.material = add_material(level, "steel", kSteel, 0.3f);
  node.mesh = static_cast<std::int32_t>(level.meshes.size());
  level.meshes.push_back({node.name, {std::move(primitive)}});
  node.rigid_body = RigidBody{};
  node.rigid_body->mass = kMass;
  node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.3;
  node.handle = handle_of(node.name);
  node.handle->translation = {1000.0, 8.0};
  const double leverage = length / kUsualLength;
  node.handle->rotation = {2.0 * leverage * leverage, 0.02 * leverage * leverage};
  node.handle->max_force = 8.0;
  node.handle->max_torque = 0.6 * leverage;
  node.device = device_of(8.0);
}

// The hand of the shipped levels, scaled.
void make_hand(Level& level, LevelNode& node, double diagonal, const InstrumentSize& asked) {
  const bool life_size = diagonal >= kSmallestHandOf && diagonal <= kLargestHandOf;
  const double scale = asked.length > 0.0 ? asked.length / kHandLength : life_size ? 1.0 : diagonal / 0.25;
  const solids::Solid solid = solids::hand_solid();
  Primitive primitive = solids::to_primitive(solids::cover_by_net(solid, solids::hand_box(), 0.0042), solid);
  for (vec3& p : primitive.position) p *= static_cast<float>(scale);
  primitive.material = add_material(level, "hand", kSkinColor, 0.45f);
  node.mesh = static_cast<std::int32_t>(level.meshes.size());
  level.meshes.push_back({node.name, {std::move(primitive)}});
  node.soft_body = SoftBody{};
  node.soft_body->young = 2e5;
  node.soft_body->poisson = 0.4;
  node.soft_body->density = 500.0;
  node.soft_body->rayleigh = {0.5, 0.01};
  node.soft_body->cell = 0.0115 * scale;
  node.soft_body->friction_static = 0.5;
  node.soft_body->friction_sliding = 0.4;
  node.handle = handle_of(node.name);
  const Box bone = solids::hand_bone();
  node.handle->box = {bone.min * static_cast<float>(scale), bone.max * static_cast<float>(scale)};
  node.handle->translation = {1200.0, 12.0};
  node.handle->rotation = {3.0 * scale * scale, 0.03 * scale * scale};
  node.handle->max_force = 12.0;
  node.handle->max_torque = scale;
  node.device = device_of(10.0);
}

Status check_object(const Level& level, std::int32_t object) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(object)];
  if (it.mesh < 0 || world_box(level, object).empty())
    return Error{it.name, "has no mesh that an instrument could be for", "choose a node that shows one"};
  return Done{};
}

}  // namespace

std::span<const Instrument> instruments() {
  return kInstruments;
}

const Instrument* find_instrument(const std::string& word) {
  for (const Instrument& instrument : kInstruments)
    if (word == instrument.word) return &instrument;
  return nullptr;
}

Result<std::int32_t> add_instrument(Level& level, InstrumentKind kind, std::int32_t object,
                                    const InstrumentSize& size) {
  if (const Status status = check_object(level, object); !status) return status.error();
  const Instrument& instrument = kInstruments[static_cast<std::size_t>(kind)];
  const double diagonal = static_cast<double>(world_box(level, object).diagonal());
  const dvec3 up = up_of(level);
  LevelNode node;
  node.name = free_name(level, instrument.word);
  if (kind == InstrumentKind::kHand)
    make_hand(level, node, diagonal, size);
  else
    make_rigid(level, node, instrument, diagonal, size);
  // Places its lowest point above the target; -Y is down.
  const double cosine = up.y;
  const dquat turn =
      cosine < -0.999999 ? dquat(0, 1, 0, 0) : glm::normalize(dquat(1.0 + cosine, cross(dvec3(0, 1, 0), up)));
  dvec3 lowest(0);
  double wide = 0.0;
  for (const vec3& p : level.meshes[static_cast<std::size_t>(node.mesh)].primitives[0].position) {
    if (static_cast<double>(p.y) < lowest.y) lowest = dvec3(p);
    wide = std::max(wide, double{length(vec2(p.x, p.z))});
  }
  const dvec3 target = free_touch_point(level, object, wide + kClearance * diagonal) + kClearance * diagonal * up;
  node.local.rotation = quat(turn);
  node.local.translation = vec3(target - turn * lowest);
  return add_node(level, std::move(node));
}

Result<std::int32_t> add_probe(Level& level, std::int32_t object, double radius) {
  if (const Status status = check_object(level, object); !status) return status.error();
  const double diagonal = static_cast<double>(world_box(level, object).diagonal());
  LevelNode node;
  node.name = free_name(level, "probe");
  node.probe = Probe{};
  node.probe->radius = radius > 0.0 ? radius : 0.02 * diagonal;
  node.probe_device = node.name;
  node.device = device_of(3.3);
  const dvec3 up = up_of(level);
  const double apart = node.probe->radius + kClearance * diagonal;
  node.local.translation = vec3(free_touch_point(level, object, apart) + apart * up);
  return add_node(level, std::move(node));
}

Path press_path(const Level& level, std::int32_t tool, std::int32_t object, double depth) {
  const dvec3 up = up_of(level);
  const LevelNode& node = level.nodes[static_cast<std::size_t>(tool)];
  const ObjectFrame frame = object_frame(level, tool);
  // The lowest point of the moving object, and the surface straight below it.
  dvec3 lowest = frame.pose.position;
  if (node.probe) lowest -= node.probe->radius * up;
  if (node.mesh >= 0)
    for (const Primitive& primitive : level.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      for (const vec3& p : primitive.position) {
        const dvec3 at = frame.pose.to_world(dvec3(frame.to_object * glm::dvec4(dvec3(p), 1.0)));
        if (dot(at, up) < dot(lowest, up)) lowest = at;
      }
  const double diagonal = static_cast<double>(world_box(level, object).diagonal());
  const Chord through = chord(world_triangles(level, object), lowest, up);
  const double thick = through.valid ? through.top - through.bottom : diagonal;
  const double gap = through.valid ? std::max(0.0, -through.top) : kClearance * diagonal;
  // A sheet has no thickness but that of rounding.
  if (depth <= 0.0) depth = thick > 1e-4 * diagonal ? std::min(diagonal / 20.0, thick / 3.0) : diagonal / 20.0;
  constexpr double kRate = 100.0, kSeconds = 6.0;
  Path path;
  for (int row = 0; row <= static_cast<int>(std::lround(kSeconds * kRate)); ++row) {
    const double t = row / kRate;
    const double down = smooth_step(0.2, 2.6, t) - smooth_step(3.6, 5.8, t);
    path.rows.push_back({t, frame.pose.position - (gap + depth) * down * up, frame.pose.rotation});
    path.turns = path.turns || frame.pose.rotation != dquat(1, 0, 0, 0);
  }
  return path;
}

}  // namespace pliant
