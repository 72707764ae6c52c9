#include "engine/choice/press_bench.h"

#include <cmath>

#include "runtime/clock.h"
#include "systems/device/hands.h"
#include "systems/schedule.h"
#include "systems/touch/collide/surface_distance.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr double kAside = 0.01;  // [1] of the reach

// Distances of vertices along the surface from the contact, up to `reach`. [m]
std::vector<float> distances(const Mesh& mesh, const Contact& contact, double reach) {
  March march;
  march.size(mesh);
  Chart start;
  start.triangle = contact.triangle;
  start.origin = vec3(contact.foot);
  march_from(mesh, sides_of(mesh), start, static_cast<float>(reach), march);
  return march.distance;
}

}  // namespace

PressPlaces press_places(const Mesh& mesh) {
  PressPlaces places;
  for (std::uint64_t k = 0; k < kPressPlaces; ++k) {
    const auto vertex = static_cast<std::uint32_t>((2 * k + 1) * mesh.vertex_count / (2 * kPressPlaces));
    places.foot.emplace_back(mesh.position(vertex));
    places.normal.emplace_back(mesh.normal(vertex));
  }
  return places;
}

Result<PressBench> PressBench::make(const Level& level, const PressPlaces* places, double probe_radius) {
  auto world = spawn_level(level);
  if (!world) return world.error();
  PressBench bench;
  bench.world_ = std::move(world).value();
  bench.probe_radius_ = probe_radius;
  bench.schedule_ = Schedule<World>(touch_schedule());
  for (auto [entity, deformable] : bench.world_.registry.view<const Deformable>()) bench.object_ = entity;
  Deformable& surface = bench.surface();
  if (surface.reach == 0.0) surface.reach = default_reach(bench.mesh());
  surface.response = Response::kFollow;
  surface.settling_time = DeformableRange::kSettlingTime.min;  // the surface is at rest again within a tick
  surface.damping_ratio = 1.0;
  surface.contact_damping = 0.0;
  surface.contact_damping_material = false;
  surface.friction_static = surface.friction_sliding = surface.friction_viscous = 0.0;
  surface.texture_amplitude = surface.transient_amplitude = surface.relief = 0.0;
  bench.places_ = places ? *places : press_places(bench.mesh());
  bench.aside_ = kAside * surface.reach;
  const Pose pose = bench.world_.registry.get<Pose>(bench.object_);
  for (std::size_t k = 0; k < bench.places_.foot.size(); ++k) {
    const double outside = probe_radius + bench.aside_;
    const dvec3 at = pose.to_world(bench.places_.foot[k] + outside * bench.places_.normal[k]);
    bench.probes_.push_back(add_free_probe(bench.world_, "press", probe_radius, at));
    bench.world_.registry.get<Probe>(bench.probes_.back()).position = at;
  }
  bench.regions_.resize(bench.probes_.size());
  return bench;
}

Status PressBench::prepare() {
  world_.fields[surface().field] = {};
  if (const Status ready = prepare_touch(world_); !ready) return ready;
  tick(probes_.size(), 0.0);
  return Done{};
}

void PressBench::tick(std::size_t place, double depth) {
  const Pose& pose = world_.registry.get<Pose>(object_);
  const double dt = 1 / world_.simulation.touch_rate, time = static_cast<double>(ticks_) * dt;
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    HapticDevice& device = world_.registry.get<HapticDevice>(probes_[k]);
    const double above = probe_radius_ + (k == place ? -depth : aside_);
    device.position = pose.to_world(places_.foot[k] + above * places_.normal[k]);
    device.sensed_at = time;
  }
  const std::uint64_t begin = now_ns();
  schedule_.run(world_, {ticks_, dt, time});
  ms_ = static_cast<double>(now_ns() - begin) * 1e-6;
  ++ticks_;
}

void PressBench::find_region(std::size_t place, const Contact& contact, const SurfaceTruth& truth) {
  Region& region = regions_[place];
  region.known = true;
  const Mesh& its = mesh();
  const std::vector<float> way = distances(its, contact, 2 * truth.region());
  for (std::uint32_t v = 0; v < its.vertex_count; ++v) {
    if (length(dvec3(its.position(v)) - contact.foot) > truth.region()) continue;
    const double r = way[v];
    region.vertex.push_back(v);
    region.share.push_back(r < 2 * truth.region() ? truth.share(r) : 0.0);
  }
}

PressBench::Press PressBench::press(std::size_t place, double depth, const SurfaceTruth& truth) {
  Press out;
  tick(place, depth);
  out.ms = ms_;
  const HeightField& field = world_.fields[surface().field];
  const Contact* contact = nullptr;
  for (auto [entity, each] : world_.registry.view<const Contact>())
    if (each.probe == probes_[place] && each.state != ContactState::kFree && each.height < 0 &&
        (!contact || each.height < contact->height))
      contact = &each;
  if (contact) {
    if (!regions_[place].known) find_region(place, *contact, truth);
    const Region& region = regions_[place];
    const double pressed = -contact->height;
    for (std::size_t i = 0; i < region.vertex.size(); ++i) {
      const std::uint32_t v = region.vertex[i];
      const double share = -static_cast<double>(field.stream[v].w) / pressed, area = mesh().area[v];
      out.off += area * (share - region.share[i]) * (share - region.share[i]);
      out.size += area * region.share[i] * region.share[i];
    }
    out.vertices = field.awake_vertices;
    const Pose& pose = world_.registry.get<Pose>(object_);
    out.force = dot(world_.registry.get<Probe>(probes_[place]).force, pose.rotation * places_.normal[place]);
  }
  tick(probes_.size(), 0.0);  // release
  tick(probes_.size(), 0.0);  // until asleep
  return out;
}

}  // namespace pliant
