// A running scene: its clocks, the sources of its probes, and the resulting forces.
//
//   pliant::Scene scene;
//   scene.add_surface("tissue", mesh);
//   scene.add_probe("finger");
//   auto session = pliant::Session::open(scene);
//   if (!session) return fail(session.error());
//   session->move("finger", {0, 0.01, 0});
//   session->step();
//   double newton = pliant::length(session->reading("finger").value().force);
//
// There are two modes. Lockstep: step() runs ticks on the caller's thread in virtual time; results are bitwise
// reproducible. Real time: start() runs the touch clock (1 kHz) and, if the scene has bodies, the soft clock on
// separate threads until stop(). One thread owns a Session and calls all of its functions; in real time they exchange
// data with the clocks without blocking them. The last force written to a device is always zero.
//
// Misuse returns an Error: an unknown name, two sources for one probe, step() while the clocks run. No function throws.
// Return values are copies; notes() and objects() return references that are valid until the next non-const call. A
// moved-from session may only be destroyed or assigned to. World frame: metres, right-handed, Y up.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "pliant/felt_event.h"
#include "pliant/progress.h"
#include "pliant/query.h"
#include "pliant/scene.h"
#include "pliant/slider.h"

namespace pliant {

struct ContactReading {
  dvec3 position{0};   // [m] world, on the undeformed surface
  dvec3 normal{0};     // [1] world, unit, outward
  dvec3 force{0};      // [N] world, on the probe, before the safety layer
  double depth = 0.0;  // [m] below the undeformed surface
  bool sliding = false;
  std::uint32_t object = 0;  // into Session::objects()
  // Of the object, numbered as in Session::triangles: the triangle that contains `position`, and its corner nearest to
  // it.
  std::uint32_t triangle = 0xffffffff, vertex = 0xffffffff;
};

// One side of a contact.
struct ContactSide {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t object = kNone;    // into Session::objects(); kNone: a probe
  std::uint32_t effector = kNone;  // into Session::effectors(); kNone: neither a probe nor a tool
  // Of the object, numbered as in Session::triangles: the touched triangle, and its nearest corner; kNone: of a probe.
  std::uint32_t triangle = kNone, vertex = kNone;
};

// A contact between soft or rigid bodies (including tools and probes), or between one and a surface.
struct BodyContact {
  dvec3 position{0};  // [m] world
  dvec3 normal{0};    // [1] world, unit, towards the body that `force` is on
  dvec3 force{0};     // [N] world, on `a`, with friction; its reaction is on `b`
  bool sliding = false;
  double depth = 0.0;  // [m] of `a` in `b` along the normal, at the start of the step; below 0: distance
  ContactSide a, b;    // the same object twice: self-contact
};
// The wrench of tissue and contacts on a tool's handle in a soft step.
struct HandleReading {
  std::string tool;
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  dvec3 force{0}, torque{0};  // [N], [N m] world, about its centre
};

// One probe or tool after a tick.
struct Reading {
  static constexpr std::uint32_t kMostContacts = 16;
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint64_t tick = 0;
  double time = 0.0;   // [s]
  bool ready = false;  // its device's state is known; false: the force is zero
  bool touching = false;
  dvec3 position{0};             // [m] world: of a probe; for a tool, of its device
  dvec3 force{0};                // [N] world, on the hand, as sent
  dvec3 torque{0};               // [N m] world, on the hand, as sent; only tools
  double depth = 0.0;            // [m] below the undeformed surface, of the strongest contact
  dvec3 normal{0};               // [1] world, of the strongest contact
  std::uint32_t object = kNone;  // into Session::objects(): of the strongest contact
  std::uint32_t contacts = 0;    // number of a probe's contacts with deformable surfaces: entries of `contact`
  std::array<ContactReading, kMostContacts> contact;
};

// Statistics of a run so far.
struct SessionFigures {
  std::uint64_t ticks = 0;
  double p50_us = 0.0, p99_us = 0.0, max_us = 0.0;  // of a tick
  std::uint64_t overruns = 0;                       // in real time: ticks that started late
  std::uint64_t soft_steps = 0;
};

// The drawn surface of an object. Vertices of the collision mesh are split where shading needs it.
struct Geometry {
  std::vector<vec3> position;        // [m] P0, at rest, object frame
  std::vector<vec3> normal;          // [1] N0 of the collision mesh; the height displaces along it
  std::vector<vec3> shading_normal;  // [1]
  std::vector<vec2> uv;
  std::vector<std::uint32_t> stream_vertex;  // per vertex: its index in the stream
  std::vector<std::uint32_t> index;          // three per triangle
};

// Vertices [first, first + count) of a stream.
struct StreamPart {
  std::uint32_t first = 0, count = 0;
};

enum class NamedKind : std::uint8_t { kSurface, kSoftBody, kRigidBody, kTool, kProbe, kEffect };

// The kind of a name of the scene, and its keys.
struct NamedKeys {
  NamedKind kind = NamedKind::kSurface;
  std::vector<std::string> live;  // the keys that Session::set changes
};

struct SessionRun;  // engine/session/session_run.h; not part of the public interface

class Session {
 public:
  // Copies the scene and allocates everything a tick needs. For a large scene this takes seconds: `progress` is called
  // on this thread and may cancel with an Error.
  static Result<Session> open(const Scene& scene, const OpenProgress& progress = {});
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();  // stop()

  // Unexpected conversions and defaults.
  const std::vector<std::string>& notes() const& PLIANT_LIFETIMEBOUND;
  std::vector<std::string> notes() &&;
  std::vector<std::string> effectors() const;  // probes, then tools
  // Deformable surfaces, soft and rigid bodies.
  const std::vector<std::string>& objects() const& PLIANT_LIFETIMEBOUND;
  std::vector<std::string> objects() &&;

  // --- The source of a probe or tool. Each has one; a second one is an error until release().
  // Sets the target pose. In real time, the motion towards it takes the time since the last call (at most 0.1 s), so
  // one call per frame suffices. After 0.25 s without a new pose the source counts as lost.
  Status move(const std::string& effector, dvec3 position, dquat rotation = {1, 0, 0, 0});
  Status follow(const std::string& effector, Path path);
  Status orbit(const std::string& effector);  // a generated path over the scene's surfaces; not while the clocks run
  // "NAME" or "NAME:ID" of a registered driver; or a custom driver.
  Status connect(const std::string& effector, const std::string& driver);
  Status connect(const std::string& effector, std::unique_ptr<Driver> driver, const std::string& id = {});
  Status release(const std::string& effector);  // removes the source: no force

  // --- Safety of devices (pliant/device_state.h). Drivers with a rate that render anything have their own servo. In
  // real time it runs on its own thread. In lockstep it runs in step(), in virtual time, with the same periods for the
  // same ticks; devices with kReply or kCallback are rejected there.
  // Safety parameters for the next driver connected to this effector.
  Status guard(const std::string& effector, const GuardParameters& parameters);
  Result<DeviceReport> device_state(const std::string& effector) const;
  Status arm(const std::string& effector);     // after a trip, or with manual arming
  Status disarm(const std::string& effector);  // until armed again
  // Disarms all devices. From any thread, unless another one connects, releases or restarts.
  void emergency_stop();

  // --- Time
  Status step(std::uint64_t ticks = 1);  // a driver keeps its last written force until the next call
  Status start();
  Status pause(bool paused);  // devices ramp down in a separate tick, and return through the gate
  Status stop();              // the error tells what ended a clock before stop()
  bool running() const;
  // Back to the initial state at time 0; keeps sources and parameters. After an error only restart() works.
  Status restart();
  double time() const;  // [s]

  // --- Recordings: the pose of every probe and tool at every tick
  // Starts at the next tick; call before the clocks start. An existing file is an error, unless it is a recording and
  // `replace` is set. The file is written atomically by end_recording(), restart() or the session's end. Without a tick
  // nothing is written, which is an error of the first two.
  Status record(const std::filesystem::path& file, bool replace = false);
  Status end_recording();
  // Makes the recording the source of every effector, in lockstep, with its settings. A recording of a lockstep run
  // reproduces the same bits in the same scene. One of a real-time run reproduces the poses, but its soft steps may
  // fall on other ticks. notes() report differences of scene or settings. step() fails after its last tick. Call before
  // the first tick.
  Status replay(const std::filesystem::path& file);

  // --- Parameters, set between ticks: keys of a surface, body, probe, tool or its device, or of an effect, by the
  // level format's names (docs/embedding.md lists the live ones). The error tells whether the name, the key or the type
  // of the value is wrong. `word`: for keys with words, such as `shape`, and for flags,
  // "true" or "false"; `values`: for keys with pairs.
  Status set(const std::string& object, const std::string& key, double value);
  Status set(const std::string& object, const std::string& key, const std::string& word);
  Status set(const std::string& object, const std::string& key, const std::vector<double>& values);
  Result<double> get(const std::string& object, const std::string& key) const;
  // The same of a key of any type, as JSON: "cubic" in quotes, 800.0, [0.1, 0.2].
  Result<std::string> json(const std::string& object, const std::string& key) const;
  // Sliders that the level offers (its key `expose`), for set() and get().
  const std::vector<Slider>& sliders() const& PLIANT_LIFETIMEBOUND;
  std::vector<Slider> sliders() &&;
  // Of an object, probe, tool or effect.
  Result<NamedKeys> keys(const std::string& name) const;

  // --- Results
  Result<Reading> reading(const std::string& effector) const;
  SessionFigures figures() const;
  // All deviations from the force law so far, one sentence each with its remedy: clipped, withheld, gated or
  // slew-limited forces, invalid poses, dropped contacts. Not while the clocks run.
  Result<std::vector<Note>> findings() const;
  // Of the newest soft step: at most 512 contacts, including those of probes with bodies; and every tool's handle.
  // Empty in a scene without bodies. Contacts of probes with surfaces are in Reading::contact.
  Status body_contacts(std::vector<BodyContact>& out);
  Status handles(std::vector<HandleReading>& out);
  // Deformed vertices, world frame [m], in the order of the object's MeshData or file. An unused vertex is at the
  // object's origin.
  Status vertices(const std::string& object, std::vector<vec3>& out);
  // The force on each of these vertices, world frame [N], distributed by barycentric coordinates: on a deformable
  // surface from the contacts of probes (Reading::kMostContacts each), on every object from body_contacts(). Their sum
  // is that of these contacts' forces.
  Status vertex_forces(const std::string& object, std::vector<vec3>& out);
  // For a custom renderer: geometry once; the stream (nx, ny, nz, h) and to_world every frame. position = P0 + h N0,
  // normal = N0 + (nx, ny, nz), object frame (P1). For deformable surfaces. For a soft or rigid body it is only the
  // rest shape, and `stream_vertex` indexes the body's own vertices (Session::vertices).
  Result<Geometry> geometry(const std::string& object) const;
  Status stream(const std::string& object, std::vector<vec4>& out);
  // The same into the vector of the last call, and which parts have changed since, ascending: all of them the first
  // time and after restart(). Only these are copied.
  Status stream(const std::string& object, std::vector<vec4>& out, std::vector<StreamPart>& changed);
  Result<mat4> to_world(const std::string& object);

  // --- External forces, constant until changed; zero removes them. They apply from the next tick on (bodies: the next
  // soft step), in lockstep and in real time. They are recorded, and kept by restart().
  // On the hand that holds a probe or tool, in addition to its contact force: [N], [N m] world; torques only for tools.
  // The same safety applies: clipped, slew-limited, withheld on a passivity violation. It is zero while the gate is
  // closed, and fades in over half a second after it opens.
  Status set_hand_force(const std::string& effector, dvec3 force, dvec3 torque = dvec3(0));
  // On a moving soft or rigid body without a handle: a force [N] at its centre of mass and a torque [N m], world;
  // distributed by mass over a soft body's nodes. Or a force [N], world, on one vertex (Session::vertices), which moves
  // with it.
  Status set_body_force(const std::string& body, dvec3 force, dvec3 torque = dvec3(0));
  Status set_point_force(const std::string& body, std::uint32_t vertex, dvec3 force);
  // The same as impulses, applied once in the next soft step: [N s], [N m s].
  Status push(const std::string& body, dvec3 impulse, dvec3 angular_impulse = dvec3(0));
  Status push_at(const std::string& body, std::uint32_t vertex, dvec3 impulse);

  // --- Objects, changed between ticks, in lockstep and in real time; changes are recorded. Not for tools.
  // Moves the object's frame, at rest: a rigid body; a soft one, undeformed; a surface without motion that bodies
  // cannot press, whose contacts end. [m] world. restart() restores its pose in the scene.
  Status place(const std::string& object, dvec3 position, dquat rotation = {1, 0, 0, 0});
  // Takes the object out of the simulation: its contacts end, and it stays where it is (and is still drawn). Putting it
  // back: at rest, at the same place, whatever is there now. Other objects are unaffected. Kept by restart().
  Status take_out(const std::string& object);
  Status put_back(const std::string& object);
  Result<bool> is_out(const std::string& object) const;
  // Adds the objects of another scene (no probes or tools), with names not yet in use. In lockstep: the run continues
  // from the current state; time and limits are those of restore_state(). For real time, open a session with the
  // objects and take them out before start(). To remove one, take it out.
  Status add(const Scene& more);

  // --- States of lockstep runs, to return to in this session or another one of the same scene.
  // A state contains all inputs since time 0 (poses, forces, pushes, parameters) up to the next tick: some 70 bytes per
  // tick for each moving probe. Not for real-time runs or replays.
  Result<std::vector<std::uint8_t>> save_state() const;
  // Restores a state: given the same poses, all further ticks are bitwise identical. The inputs are run again in a new
  // world without calling any driver, which takes the time of those ticks plus that of restart(). Set poses and
  // followed paths continue; a driver's device returns through its gate, as after any jump. Not while recording. The
  // bytes may be untrusted: they are checked. If it fails before it has started, nothing has changed.
  Status restore_state(const std::vector<std::uint8_t>& state);

  // --- Geometry as given by the program or file, of every kind of object; in real time, of the newest published state.
  // Queries use a tree that follows the vertices; results equal a test of every triangle of triangles() at vertices().
  // Three indices into vertices() per triangle, in the object's order, counter-clockwise from outside: triangles with
  // wrong winding are turned.
  Status triangles(const std::string& object, std::vector<std::uint32_t>& out) const;
  // The nearest point to `point`, at most `within` away.
  Result<QueryHit> closest_point(dvec3 point, const QueryOptions& options = {});
  // The first intersection of a ray, from either side. `direction` [1] need not be normalised.
  Result<QueryHit> ray(dvec3 from, dvec3 direction, const QueryOptions& options = {});
  // Of all vertices used by a triangle. Ignores `within`.
  Result<Bounds> bounds(const QueryOptions& options = {});

  // --- The readings of every tick, in lockstep and in real time
  // Buffers the last `ticks` readings of each probe and tool from the next tick on; older ones are lost. 0: none. Not
  // while the clocks run. Kept by restart().
  Status keep_readings(std::size_t ticks);
  // Takes the buffered readings, oldest first; returns how many were lost since the last call.
  Result<std::uint64_t> take_readings(const std::string& effector, std::vector<Reading>& out);

  // Takes the events since the last call, oldest first; returns how many were lost: at most 4,096 wait,
  // and 64 come in a tick.
  std::uint64_t take_events(std::vector<FeltEvent>& out);

 private:
  friend struct SessionRun;
  explicit Session(std::unique_ptr<SessionRun> run);
  std::unique_ptr<SessionRun> run_;
};

// A recording as rows of tick, time, probe, position, rotation (w first) and whether its device was ready.
Status export_recording(const std::filesystem::path& recording, const std::filesystem::path& csv);

}  // namespace pliant
