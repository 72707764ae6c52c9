// Scenes small enough to check by hand, written once for tests and benchmarks.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "runtime/schedule.h"
#include "systems/device/reading.h"

namespace pliant::scenes {

// A square sheet in the plane y = 0, normals up, `cells` x `cells` squares of two triangles each, `size` [m] wide,
// centred.
Primitive sheet(int cells, double size);
// A sphere about the origin: a cube sphere of 12 n^2 triangles. radius [m].
Primitive sphere(int n, double radius);
// The lower half of a sphere, facing its centre: open.
Primitive bowl(int n, double radius);
// A closed slab of cells x cells squares, y from -thickness to 0.
Primitive slab(int cells, double size, double thickness);
// Two sheets that meet at x = 0 with slopes +-angle [rad]: a concave crease (valley) for angle > 0, a ridge for < 0.
Primitive valley(int cells, double size, double angle);

// A world that a test builds and drives tick by tick.
class Stage {
 public:
  explicit Stage(double rate_hz = 1000.0);
  // Adds a surface and sets the Deformable's handles.
  Entity add(const Primitive& primitive, Deformable deformable, Pose pose = {});
  // Attaches a surface to a prescribed motion, before prepare(): it becomes a node under `parent`.
  void carry(Entity surface, PrescribedMotion motion, Entity parent = kNoEntity);
  // A node without a surface, as a parent of others.
  Entity add_node(PrescribedMotion motion, Entity parent = kNoEntity, LocalTransform rest = {});
  // Adds a probe moved by hand (place()), with an unlimited device: no clamp, no slew limit.
  Entity add_probe(dvec3 position, double radius = 0.0);
  void prepare();

  void place(Entity probe, dvec3 position);
  // `age` [s] of the poses.
  void tick(double age = 0.0);
  // Ticks missed because the machine was late: index and time advance as those of RealtimeClock do.
  void skip(std::uint64_t ticks) { ticks_ += ticks, skipped_ += ticks; }
  // Moves a probe along a straight line at constant speed for `seconds`, calling `each` after every tick.
  void move(Entity probe, dvec3 to, double seconds, const std::function<void(const ProbeReading&)>& each = {});
  void wait(double seconds);

  ProbeReading read(Entity probe) const { return reading(world, probe); }
  const Contact& contact(Entity probe, std::size_t object = 0) const;
  const Mesh& mesh(Entity surface) const { return world.meshes[world.registry.get<Deformable>(surface).mesh]; }
  HeightField& field(Entity surface) { return world.fields[world.registry.get<Deformable>(surface).field]; }
  HapticDevice& device(Entity probe) { return world.registry.get<HapticDevice>(probe); }
  double time() const { return static_cast<double>(ticks_) * dt_; }
  double dt() const { return dt_; }
  const Schedule<World>& schedule() const { return schedule_; }  // for the cost of each system
  std::uint64_t hash() const;

  World world;

 private:
  double dt_;
  std::uint64_t ticks_ = 0, skipped_ = 0;
  Schedule<World> schedule_;
};

// Work done on the hand along a recorded path, trapezoidal. [J]
class WorkMeter {
 public:
  void add(const ProbeReading& r) {
    if (started_) work_ += 0.5 * dot(r.force + force_, r.position - position_);
    force_ = r.force;
    position_ = r.position;
    started_ = true;
  }
  double work() const { return work_; }

 private:
  bool started_ = false;
  dvec3 force_{0}, position_{0};
  double work_ = 0.0;
};

}  // namespace pliant::scenes
