#include "systems/device/orbit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "components/soft_body.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

// One turn of the orbit, in seconds and in shares of the touched object's size.
constexpr double kApproachTime = 0.8, kPressTime = 0.5, kSlideTime = 1.6, kLiftTime = 0.5, kReturnTime = 0.6;  // [s]
constexpr double kPeriod = kApproachTime + kPressTime + kSlideTime + kLiftTime + kReturnTime;                  // [s]
constexpr double kStep = 0.005;        // [s] between rows
constexpr double kClearance = 0.12;    // [1] of the diagonal: distance at which the approach begins
constexpr double kSlideLength = 0.15;  // [1] of the diagonal
constexpr double kDepthShare = 0.2;    // [1] of the reach: pressing depth
constexpr int kSlidePoints = 64;

struct Hit {
  Entity object;
  dvec3 point{0};   // [m] world
  dvec3 normal{0};  // [1] world, interpolated
  double distance = 0.0;
};

std::optional<Hit> cast(const World& world, dvec3 from, dvec3 to) {
  std::optional<Hit> best;
  for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
    const Mesh& mesh = world.meshes[deformable.mesh];
    const Entry entry = first_entry(mesh, pose.to_local(from), pose.to_local(to));
    if (!entry.valid()) continue;
    const double distance = entry.fraction * length(to - from);
    if (best && distance >= best->distance) continue;
    const SurfaceFoot p = surface_point(corners(mesh, entry.triangle), entry.triangle, entry.barycentric, 0.0);
    best = Hit{entity, pose.to_world(p.foot), pose.rotation * p.normal, distance};
  }
  return best;
}

// For objects with a hole in the middle, such as a ring: rays along vertex normals, preferably from above.
std::optional<Hit> cast_at_vertices(const World& world, unsigned index, double out) {
  constexpr unsigned kAttempts = 64;
  for (const double least_up : {0.3, -1.0}) {
    for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
      const Mesh& mesh = world.meshes[deformable.mesh];
      for (unsigned attempt = 0; attempt < kAttempts; ++attempt) {
        const double share = std::fmod(0.618034 * (index + 1 + attempt), 1.0);
        const auto v = static_cast<std::uint32_t>(share * mesh.vertex_count);
        const dvec3 p = pose.to_world(dvec3(mesh.position(v))), n = pose.rotation * dvec3(mesh.normal(v));
        if (!(n.y >= least_up)) continue;
        if (const std::optional<Hit> hit = cast(world, p + out * n, p - out * n)) return hit;
      }
    }
  }
  return {};
}

double smooth(double s) {
  return s * s * s * (10 + s * (6 * s - 15));
}  // minimum jerk

// Points on the surface from the first hit along a tangent, up to the first jump of the surface.
std::vector<Hit> slide_line(const World& world, const Hit& first, double size) {
  const dvec3 helper = std::abs(first.normal.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 along = normalize(cross(helper, first.normal));
  std::vector<Hit> line{first};
  for (int i = 1; i <= kSlidePoints; ++i) {
    const dvec3 over = first.point + along * (kSlideLength * size * i / kSlidePoints) + first.normal * (0.1 * size);
    const std::optional<Hit> next = cast(world, over, over - first.normal * (0.3 * size));
    const double step = next ? length(next->point - line.back().point) : 0.0;
    if (!next || next->object != first.object || step > 4 * kSlideLength * size / kSlidePoints ||
        dot(next->normal, line.back().normal) < 0.8)
      break;
    line.push_back(*next);
  }
  return line;
}

Box world_box(const Mesh& mesh, const Pose& pose) {
  Box box;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) box.add(vec3(pose.to_world(dvec3(mesh.position(v)))));
  return box;
}

// The highest point of any other object under a box. [m]
std::optional<double> ground_below(const World& world, Entity tool, const Box& box) {
  std::optional<double> ground;
  const auto offer = [&](Entity entity, Handle<Mesh> mesh, const Pose& pose) {
    if (entity == tool) return;
    const Box other = world_box(world.meshes[mesh], pose);
    const bool below = other.min.x < box.max.x && other.max.x > box.min.x && other.min.z < box.max.z &&
                       other.max.z > box.min.z && other.max.y < box.center().y;
    if (below) ground = std::max(ground.value_or(other.max.y), static_cast<double>(other.max.y));
  };
  for (auto [entity, body, pose] : world.registry.view<Deformable, Pose>()) offer(entity, body.mesh, pose);
  for (auto [entity, body, pose] : world.registry.view<SoftBody, Pose>()) offer(entity, body.collision_mesh, pose);
  for (auto [entity, body, pose] : world.registry.view<RigidBody, Pose>()) offer(entity, body.collision_mesh, pose);
  return ground;
}

}  // namespace

Path make_tool_orbit(const World& world, Entity tool) {
  constexpr double kPress = 0.15, kSlide = 0.25;  // [1] of the tool's height and width
  const Pose& pose = world.registry.get<Pose>(tool);
  const SoftBody* const soft = world.registry.find<SoftBody>(tool);
  const Handle<Mesh> mesh = soft ? soft->collision_mesh : world.registry.get<RigidBody>(tool).collision_mesh;
  const Box box = world_box(world.meshes[mesh], pose);
  const dvec3 size(box.max - box.min);
  const double away = std::max(0.0, box.min.y - ground_below(world, tool, box).value_or(box.min.y - 0.5 * size.y));
  const dvec3 press = pose.position - dvec3(0, away + kPress * size.y, 0);
  const dvec3 slide = press + dvec3(kSlide * size.x, 0, 0), lift = slide + dvec3(0, away + kPress * size.y, 0);

  struct Leg {
    double seconds;
    dvec3 to;
  };
  Path path;
  path.repeats = true;
  path.rows.push_back({0.0, pose.position, pose.rotation});
  for (const Leg& leg : {Leg{kApproachTime + kPressTime, press}, Leg{kSlideTime, slide}, Leg{kLiftTime, lift},
                         Leg{kReturnTime, pose.position}}) {
    const PathRow from = path.rows.back();
    const int steps = static_cast<int>(std::lround(leg.seconds / kStep));
    for (int i = 1; i <= steps; ++i)
      path.rows.push_back(
          {from.time + i * kStep, from.position + smooth(double(i) / steps) * (leg.to - from.position), pose.rotation});
  }
  return path;
}

Path make_orbit(const World& world, unsigned index, double radius) {
  Box bounds;
  for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
    const Box& box = world.meshes[deformable.mesh].box;
    bounds.add(vec3(pose.to_world(dvec3(box.min))));
    bounds.add(vec3(pose.to_world(dvec3(box.max))));
  }
  Path path;
  if (bounds.empty()) return path;

  // The first direction, from the front and above, whose ray hits an object. Each probe begins its search elsewhere on
  // the golden spiral, so that they take different places.
  const dvec3 center(bounds.center());
  const double out = bounds.diagonal();
  std::optional<Hit> first;
  for (unsigned attempt = 0; attempt < 64 && !first; ++attempt) {
    const unsigned n = index + 7 * attempt;
    const double turn = 2.399963 * n, tilt = 0.35 + 0.9 * std::fmod(0.618034 * n, 1.0);
    const dvec3 direction(std::sin(tilt) * std::sin(turn), std::cos(tilt), std::sin(tilt) * std::cos(turn));
    first = cast(world, center + out * direction, center - out * direction);
  }
  if (!first) first = cast_at_vertices(world, index, out);
  if (!first) return path;

  const Deformable& deformable = world.registry.get<Deformable>(first->object);
  const double size = world.meshes[deformable.mesh].box.diagonal();
  const double depth = kDepthShare * deformable.reach;
  const std::vector<Hit> line = slide_line(world, *first, size);
  const auto on_line = [&](double s, double height) {  // s in [0, 1] along the line; height over the surface [m]
    const double x = s * static_cast<double>(line.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), line.size() - 1), j = std::min(i + 1, line.size() - 1);
    const double share = x - static_cast<double>(i);
    const dvec3 point = line[i].point + share * (line[j].point - line[i].point);
    const dvec3 normal = normalize(line[i].normal + share * (line[j].normal - line[i].normal));
    return point + (height + radius) * normal;
  };
  const double away = kClearance * size;
  const dvec3 start = on_line(0, away), finish = on_line(1, away);
  const double late = 0.37 * index;  // [s] phase offset, so that several orbits do not press together
  path.repeats = true;
  for (double t = 0; t < kPeriod; t += kStep) {
    double s = t;
    dvec3 position;
    if (s < kApproachTime) {
      position = on_line(0, away - (away - 0.02 * size) * smooth(s / kApproachTime));
    } else if ((s -= kApproachTime) < kPressTime) {
      position = on_line(0, 0.02 * size - (0.02 * size + depth) * smooth(s / kPressTime));
    } else if ((s -= kPressTime) < kSlideTime) {
      position = on_line(smooth(s / kSlideTime), -depth);
    } else if ((s -= kSlideTime) < kLiftTime) {
      position = on_line(1, -depth + (depth + away) * smooth(s / kLiftTime));
    } else {
      position = finish + (start - finish) * smooth((s - kLiftTime) / kReturnTime);
    }
    path.rows.push_back({late + t, position, dquat(1, 0, 0, 0)});
  }
  path.rows.push_back({late + kPeriod, start, dquat(1, 0, 0, 0)});
  return path;
}

}  // namespace pliant
