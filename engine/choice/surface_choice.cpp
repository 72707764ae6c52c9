// The shape of a surface's dent, and what its distance is, by presses of the touch tick.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "content/keys/enum_words.h"
#include "content/level/progress.h"
#include "engine/choice/choice_parts.h"
#include "runtime/clock.h"
#include "systems/schedule.h"
#include "systems/touch/force_field.h"
#include "systems/touch/prepare.h"
#include "systems/touch/surface_distance.h"

namespace pliant {
namespace {

constexpr std::uint32_t kPresses = 6;     // places, along the mesh's own order
constexpr double kInner = 0.2;            // [1] of the reach: the punch, as the engine's shapes have it
constexpr double kDepths[] = {0.2, 0.5};  // [1] of the punch's radius, in turn
constexpr Shape kShapes[] = {Shape::kPunch,    Shape::kHertz,  Shape::kGaussian,
                             Shape::kWendland, Shape::kVolume, Shape::kKelvinlet};

// Nanoseconds a vertex in the kernels that ship, measured once (bench/results/studies/shapes.csv): counted with, so
// that a choice is the same on every machine. The volume shape sums its coefficient first.
double vertex_ns(Shape shape) {
  constexpr double kNs[] = {2.6, 3.1, 2.3, 1.0, 2.1, 2.9};
  return shape <= kLastShape ? kNs[static_cast<std::size_t>(shape)] : 20.0;
}
constexpr double kMarchNs = 150.0;  // [ns] a vertex whose distance along the surface is found
constexpr double kTickUs = 3.0;     // [us] of a tick beside its vertices

struct Only {
  Entity entity;
  const Deformable* deformable;
};
std::optional<Only> only_surface(World& world) {
  for (auto [entity, deformable] : world.registry.view<const Deformable>()) return Only{entity, &deformable};
  return std::nullopt;
}

Entity probe_of(World& world) {
  for (auto [entity, probe] : world.registry.view<const Probe>()) return entity;
  const Entity entity = world.registry.create();
  Probe probe;
  probe.device = entity;
  world.registry.add(entity, Name{"press"});
  world.registry.add(entity, probe);
  HapticDevice device;
  device.driver = DriverKind::kExternal;
  device.max_force = 1e9;
  device.max_slew = 1e12;
  world.registry.add(entity, device);
  return entity;
}

// Distances of vertices along the surface from where the probe presses, as far as two reaches.
std::vector<vec3> distances(const Mesh& mesh, const Contact& contact, double reach) {
  std::vector<vec3> offset(mesh.px.size(), vec3(kFar));
  FieldSource source;
  source.center = vec3(contact.foot);
  source.normal = vec3(contact.normal);
  source.inv_reach2 = static_cast<float>(1 / (4 * reach * reach));
  std::vector<MarchItem> heap;
  heap.reserve(std::size_t{8} * mesh.vertex_count);
  march_distance(mesh, contact, source, offset, heap);
  return offset;
}

struct Tried {
  Shape shape;
  Distance distance;
};

}  // namespace

double punch_share(double r, double radius) {
  return r <= radius ? 1.0 : 2 / std::numbers::pi * std::asin(radius / r);
}

Result<SurfacePress> press_vertex(World& world, std::uint32_t vertex, double depth) {
  const Entity probe = probe_of(world);
  const auto only = only_surface(world);
  const Mesh& mesh = world.meshes[only->deformable->mesh];
  HeightField& field = world.fields[only->deformable->field];
  field = {};
  if (const Status ready = prepare_touch(world); !ready) return ready.error();
  const Pose& pose = world.registry.get<Pose>(only->entity);
  HapticDevice& device = world.registry.get<HapticDevice>(probe);
  Schedule<World> schedule(touch_schedule());
  SurfacePress out;
  const double dt = 1 / world.simulation.touch_rate;
  const dvec3 foot(mesh.position(vertex)), normal(mesh.normal(vertex));
  for (std::uint64_t n = 0; n < 2; ++n) {
    device.position = pose.to_world(foot + (n == 0 ? depth : -depth) * normal);
    device.sensed_at = static_cast<double>(n) * dt;
    const std::uint64_t begin = now_ns();
    schedule.run(world, {n, dt, static_cast<double>(n) * dt});
    out.ms = static_cast<double>(now_ns() - begin) * 1e-6;
  }
  const Contact* contact = nullptr;
  for (auto [entity, each] : world.registry.view<const Contact>())
    if (each.state != ContactState::kFree && each.height < 0 && (!contact || each.height < contact->height))
      contact = &each;
  if (!contact) return out;
  const double reach = only->deformable->reach, pressed = -contact->height;
  const std::vector<vec3> way = distances(mesh, *contact, reach);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (length(dvec3(mesh.position(v)) - dvec3(contact->foot)) > reach) continue;
    const double r = length(dvec3(way[v])), truth = r < 2 * reach ? punch_share(r, kInner * reach) : 0.0,
                 share = -static_cast<double>(field.stream[v].w) / pressed, area = mesh.area[v];
    out.off += area * (share - truth) * (share - truth);
    out.size += area * truth * truth;
  }
  out.vertices = field.awake_vertices;
  return out;
}

Result<ModelChoice> choose_surface(Level& level, std::size_t index) {
  LevelNode& node = level.nodes[index];
  ModelChoice choice{node.name, "surface", node.deformable->error, {}, 0, false, {}, {}};
  auto world = spawn_alone(level, index);
  if (!world) return world.error();
  auto only = only_surface(*world);
  if (!only) return Error{node.name, "has an error budget but no surface to press; leave out `error`"};
  Deformable& its = world->registry.get<Deformable>(only->entity);
  its.response = Response::kFollow;
  its.spring = SpringLaw::kLinear;  // the surface under a press does not depend on the law
  if (its.reach == 0.0) its.reach = default_reach(world->meshes[its.mesh]);

  std::vector<Shape> shapes(std::begin(kShapes), std::end(kShapes));
  std::vector<Distance> ways{Distance::kChord, Distance::kSurface};
  for (const char* key : {"shape", "distance", "spring", "response", "reach"})
    if (states(node, "deformable", key)) choice.kept.emplace_back(key);
  if (states(node, "deformable", "shape") || states(node, "deformable", "volume")) shapes = {its.shape};
  if (states(node, "deformable", "distance")) ways = {its.distance};
  Progress progress;
  std::vector<std::pair<ModelCandidate, Tried>> tried;
  for (const Shape shape : shapes)
    for (const Distance distance : ways) {
      its.shape = shape;
      its.distance = distance;
      double off = 0.0, size = 0.0, vertices = 0.0, ms = 0.0, count = 0.0;
      for (std::uint32_t k = 0; k < kPresses; ++k) {
        progress.say("choosing a model for `" + node.name + "`");
        const std::uint32_t n = world->meshes[its.mesh].vertex_count;
        const auto vertex = static_cast<std::uint32_t>((2 * std::uint64_t{k} + 1) * n / (2 * kPresses));
        const auto press = press_vertex(*world, vertex, kDepths[k % 2] * kInner * its.reach);
        if (!press) return press.error();
        if (!(press->size > 0.0)) continue;
        off += press->off / press->size;
        size += 1.0;
        vertices += press->vertices;
        ms += press->ms;
        count += 1.0;
      }
      if (count == 0.0) return Error{node.name, "could not be pressed to measure an error; leave out `error`"};
      ModelCandidate candidate;
      candidate.label = fmt::format("shape {}, distance {}", word_of(shape), word_of(distance));
      candidate.error = std::sqrt(off / size);
      candidate.cost =
          kTickUs + 1e-3 * vertices / count * (vertex_ns(shape) + (distance == Distance::kSurface ? kMarchNs : 0.0));
      candidate.ms = ms / count;
      tried.push_back({candidate, {shape, distance}});
    }
  std::stable_sort(tried.begin(), tried.end(),
                   [](const auto& a, const auto& b) { return a.first.cost < b.first.cost; });
  for (const auto& [candidate, what] : tried) choice.tried.push_back(candidate);
  choice.chosen = cheapest_within(choice.tried, choice.budget);
  choice.within = choice.tried[choice.chosen].error <= choice.budget;
  node.deformable->shape = tried[choice.chosen].second.shape;
  node.deformable->distance = tried[choice.chosen].second.distance;
  return choice;
}

}  // namespace pliant
