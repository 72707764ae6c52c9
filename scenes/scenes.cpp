#include "scenes/scenes.h"

#include <algorithm>
#include <cmath>

#include "content/mesh/mesh_build.h"
#include "systems/device/hands.h"
#include "systems/hash_state.h"
#include "systems/schedule.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant::scenes {
namespace {

// A grid of (n+1)^2 points over (u, v) in [0,1]^2, two triangles per cell. Counter-clockwise if the point map keeps (u,
// v, normal) right-handed.
void add_grid(Primitive& p, int n, const std::function<dvec3(double, double)>& point) {
  const std::uint32_t first = static_cast<std::uint32_t>(p.position.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) p.position.push_back(vec3(point(double(i) / n, double(j) / n)));
  const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (const std::uint32_t v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        p.index.push_back(v);
}

}  // namespace

Primitive sheet(int cells, double size) {
  Primitive p;
  add_grid(p, cells, [&](double u, double v) { return dvec3((u - 0.5) * size, 0, (0.5 - v) * size); });
  return p;
}

Primitive sphere(int n, double radius) {
  Primitive p;
  const dvec3 faces[6][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                             {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                             {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}};
  for (const auto& [normal, across, up] : faces) {
    add_grid(p, n, [&, normal = normal, across = across, up = up](double u, double v) {
      // Equal angles give nearly equal cells; the tangent is made odd about zero so that edges of two faces agree to
      // the bit.
      const auto tangent = [](double s) {
        return s == 0.5 ? 0.0 : s < 0.5 ? -std::tan((0.5 - s) * M_PI / 2) : std::tan((s - 0.5) * M_PI / 2);
      };
      const dvec3 cube = normal + tangent(u) * across + tangent(v) * up;
      const vec3 rounded(cube);
      return radius * normalize(dvec3(rounded));
    });
  }
  return p;
}

Primitive bowl(int n, double radius) {
  Primitive out = sphere(n, radius);
  std::vector<std::uint32_t> lower;
  for (std::size_t i = 0; i < out.index.size(); i += 3) {
    const std::uint32_t a = out.index[i], b = out.index[i + 1], c = out.index[i + 2];
    if (std::max({out.position[a].y, out.position[b].y, out.position[c].y}) < static_cast<float>(0.1 * radius))
      lower.insert(lower.end(), {a, c, b});
  }
  out.index = std::move(lower);
  for (vec3& normal : out.normal) normal = -normal;
  return out;
}

Primitive slab(int cells, double size, double thickness) {
  Primitive p;
  const double h = size / 2;
  add_grid(p, cells, [&](double u, double v) { return dvec3(u * size - h, 0, h - v * size); });
  add_grid(p, cells, [&](double u, double v) { return dvec3(u * size - h, -thickness, v * size - h); });
  const auto wall = [&](dvec3 from, dvec3 to) {
    const std::uint32_t first = static_cast<std::uint32_t>(p.position.size());
    for (int i = 0; i <= cells; ++i) {
      const dvec3 top = from + (to - from) * (double(i) / cells);
      // The same float coordinates as the faces', so that the seams weld.
      p.position.push_back(vec3(top));
      p.position.push_back(vec3(top.x, -thickness, top.z));
    }
    for (int i = 0; i < cells; ++i) {
      const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
      for (const std::uint32_t v : {a, a + 1, a + 3, a, a + 3, a + 2}) p.index.push_back(v);
    }
  };
  wall({-h, 0, h}, {h, 0, h});
  wall({h, 0, h}, {h, 0, -h});
  wall({h, 0, -h}, {-h, 0, -h});
  wall({-h, 0, -h}, {-h, 0, h});
  return p;
}

Primitive valley(int cells, double size, double angle) {
  Primitive p;
  const double slope = std::tan(angle);
  add_grid(p, cells, [&](double u, double v) {
    const double x = (u - 0.5) * size;
    return dvec3(x, std::abs(x) * slope, (0.5 - v) * size);
  });
  return p;
}

Stage::Stage(double rate_hz) : dt_(1 / rate_hz), schedule_(touch_schedule()) {
  world.simulation.touch_rate = rate_hz;
}

Entity Stage::add(const Primitive& primitive, Deformable deformable, Pose pose) {
  Result<BuiltMesh> built = build_mesh("surface", std::span(&primitive, 1), mat4(1));
  ASSERT(built.ok());
  deformable.mesh = world.meshes.add(std::move(built->mesh));
  deformable.field = world.fields.add({});
  const Entity entity = world.registry.create();
  world.registry.add(entity, Name{"surface"});
  world.registry.add(entity, pose);
  world.registry.add(entity, deformable);
  return entity;
}

void Stage::carry(Entity surface, PrescribedMotion motion, Entity parent) {
  const Pose& pose = world.registry.get<Pose>(surface);
  world.hierarchy.add(surface, parent);
  world.registry.add(surface, LocalTransform{vec3(pose.position), quat(pose.rotation), vec3(1)});
  world.registry.add(surface, Kinematic{world.motions.add(std::move(motion))});
}

Entity Stage::add_node(PrescribedMotion motion, Entity parent, LocalTransform rest) {
  const Entity entity = world.registry.create();
  world.hierarchy.add(entity, parent);
  world.registry.add(entity, rest);
  world.registry.add(entity, WorldTransform{});
  world.registry.add(entity, Kinematic{world.motions.add(std::move(motion))});
  return entity;
}

Entity Stage::add_probe(dvec3 position, double radius) {
  return add_free_probe(world, "probe", radius, position);
}

void Stage::prepare() {
  ASSERT(prepare_touch(world).ok());
}

void Stage::place(Entity probe, dvec3 position) {
  device(probe).position = position;
}

void Stage::tick(double age) {
  for (auto [entity, device] : world.registry.view<HapticDevice>()) device.sensed_at = time() - age;
  schedule_.run(world, {ticks_, dt_, time(), static_cast<double>(skipped_) * dt_});
  ++ticks_;
  skipped_ = 0;
}

void Stage::move(Entity probe, dvec3 to, double seconds, const std::function<void(const ProbeReading&)>& each) {
  const dvec3 from = device(probe).position;
  const int steps = std::max(1, static_cast<int>(std::lround(seconds / dt_)));
  for (int i = 1; i <= steps; ++i) {
    place(probe, from + (to - from) * (double(i) / steps));
    tick();
    if (each) each(read(probe));
  }
}

void Stage::wait(double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / dt_)); ++i) tick();
}

const Contact& Stage::contact(Entity probe, std::size_t object) const {
  std::size_t i = 0;
  for (auto [entity, contact] : world.registry.view<Contact>())
    if (contact.probe == probe && i++ == object) return contact;
  static const Contact none;
  if (i == 0) return none;  // no contact
  ASSERT(false && "no such contact");
  std::abort();
}

std::uint64_t Stage::hash() const {
  Hash hash;
  hash_state(world, hash);
  return hash.value();
}

}  // namespace pliant::scenes
