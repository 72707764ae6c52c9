// Pliant's C interface: levels, sessions, forces, geometry, devices and pictures, for C11 and every language that calls
// C (C#, Rust, Julia, ...). Library: libpliant.so; `pkg-config --cflags --libs pliant`, or pliant::c in CMake.
//
//   pliant_scene* scene;
//   pliant_session* session;
//   if (pliant_scene_load("organ.glb", NULL, &scene) || pliant_session_open(scene, NULL, NULL, &session))
//     return fprintf(stderr, "%s\n", pliant_error_message()), 1;
//   pliant_pose pose = {{0, 0.01, 0}, {0, 0, 0, 1}};
//   pliant_wrench felt;
//   for (int i = 0; i < 1000; ++i) pliant_session_tick(session, &pose, &felt, 1);
//   pliant_session_destroy(session);
//   pliant_scene_destroy(scene);
//
// Units and frames: SI (m, kg, s, N, rad). World frame: right-handed, Y up. Rotations are unit quaternions from the
// object's to the world frame; one that is all zeros means "not turned". Unity's frame is left-handed: negate z of
// positions, forces and normals, and x and y of quaternions (bindings/unity does).
//
// Errors: a function that can fail returns PLIANT_OK (0) or another pliant_status; pliant_error_message() then has the
// sentence and pliant_error_code() the code (docs/codes.md), both as in C++. Outputs are unchanged after an error,
// except a count, which says how much room is needed. Every argument is checked: NULL, a wrong `size`, a destroyed
// handle, NaN and an unknown name are errors; nothing crashes, and no exception leaves the library. A pointer that is
// neither NULL nor valid cannot be recognised.
//
// Structs that start with `size` may grow in later versions: set it to sizeof the struct before every call, of an array
// in its first element, and the rest to zero for defaults: `pliant_reading r = {.size = sizeof r};`. The other
// structs never change.
//
// Lifetimes: a handle lives until its _destroy, which must be called once; NULL is allowed. A session copies its scene.
// Text and arrays that are returned belong to the library; their comments say how long they are valid. Text is UTF-8
// and ends with '\0'. Arrays that are passed in are copied during the call.
//
// Arrays out: `out` has room for `capacity` elements, and `*count` becomes the number that there are. If they do not
// fit, nothing is written and the call fails with the code "call.room". With `out` NULL and `capacity` 0 the call only
// counts, and succeeds.
//
// Threads: a scene, a session and its pictures are used by one thread at a time; a call while another one uses it fails
// with "call.busy" and changes nothing. Different sessions run on different threads at once. In real time a session has
// threads of its own, which never wait for the caller. Text of errors belongs to the calling thread.
#pragma once

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PLIANT_API __attribute__((visibility("default")))
#else
#define PLIANT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// Rises when a struct or function changes in a way that a compiled program would notice; the library's SOVERSION.
#define PLIANT_ABI_VERSION 0

typedef int32_t pliant_status;
enum {
  PLIANT_OK = 0,
  PLIANT_FAILED = 1,  // the library says why: file, name, device, state of the session
  PLIANT_MISUSED = 2  // the call itself is wrong: a NULL, a size, a handle, too little room ("call..." codes)
};

#define PLIANT_NONE 0xffffffffu  // an index that there is not

typedef struct pliant_scene pliant_scene;        // a level: loaded, or built by calls
typedef struct pliant_session pliant_session;    // a running level
typedef struct pliant_pictures pliant_pictures;  // draws a session

typedef struct pliant_vec3 {
  double x, y, z;
} pliant_vec3;

typedef struct pliant_quat {
  double x, y, z, w;  // [1] unit; all zeros: not turned
} pliant_quat;

typedef struct pliant_pose {
  pliant_vec3 position;  // [m] world
  pliant_quat rotation;  // object to world
} pliant_pose;

typedef struct pliant_wrench {
  pliant_vec3 force;   // [N] world
  pliant_vec3 torque;  // [N m] world
} pliant_wrench;

typedef struct pliant_path_row {
  double time;  // [s] ascending
  pliant_pose pose;
} pliant_path_row;

// Elements [first, first + count) of an array.
typedef struct pliant_range {
  uint32_t first, count;
} pliant_range;

// ---- The library and its errors

// "0.1.0", of the library that is loaded. Always valid.
PLIANT_API const char* pliant_version(void);
// PLIANT_ABI_VERSION of the library that is loaded: must equal the header's.
PLIANT_API uint32_t pliant_abi_version(void);

// The last error of the calling thread. Text is valid until the thread's next call that fails; "" where there is none.
typedef struct pliant_error {
  uint32_t size;
  int32_t node;         // index of the level node concerned; -1: none
  const char* message;  // "WHERE: WHAT; CURE", the whole sentence
  const char* where;    // file, function or device
  const char* what;     // the fault
  const char* cure;     // the remedy
  const char* code;     // "file.missing"
  const char* pointer;  // JSON pointer within the file
} pliant_error;

PLIANT_API pliant_status pliant_last_error(pliant_error* out);
PLIANT_API const char* pliant_error_message(void);
PLIANT_API const char* pliant_error_code(void);

enum { PLIANT_LOG_INFO = 0, PLIANT_LOG_WARNING = 1, PLIANT_LOG_FATAL = 2 };
// One sentence. Called on any thread, never from a tick. Must return, and must not call Pliant.
typedef void (*pliant_log_function)(void* user, int32_t level, const char* sentence);
// Sends messages that no return value can report (warnings; before an abort) to `log`; NULL: to stderr again.
PLIANT_API pliant_status pliant_set_log(pliant_log_function log, void* user);
// Makes every open device safe, and stops all servos until the program ends. May be called from a signal handler.
PLIANT_API void pliant_make_devices_safe(void);
// Crashes, and SIGTERM, SIGINT and SIGHUP without a handler, first do so. Call once. Not within a host (Unity, a JVM)
// that has signal handlers of its own.
PLIANT_API void pliant_make_devices_safe_on_signals(void);
// Multiplies the limits on files, which keep a small file from exhausting the memory, by 1e-6 to 1000. Call once,
// before loading.
PLIANT_API pliant_status pliant_set_limit_factor(double factor);

// Progress of a long call, on the calling thread, at most some fifty times a second. `share` [1] never decreases.
// Return 0 to go on; any other value ends the call with an error. Must not call Pliant with the same handles.
typedef int32_t (*pliant_progress)(void* user, double share, const char* doing);

// ---- Scenes

typedef struct pliant_load_options {
  uint32_t size;
  double max_force;          // [N] limit on what a file may ask of devices; 0: 10
  pliant_progress progress;  // may be NULL
  void* user;                // first argument of `progress`
} pliant_load_options;

// A level (.gltf, .glb), or a mesh (.obj, .stl, .ply and others), which becomes a deformable surface. `options` may be
// NULL. A level without a probe needs pliant_scene_add_probe. Notes say what was read otherwise than expected.
PLIANT_API pliant_status pliant_scene_load(const char* path, const pliant_load_options* options, pliant_scene** out);
// The same of bytes in memory. `name` stands for the file in notes and errors; its extension says the format, which
// must be of one file ("organ.glb", "organ.stl"); a script or tetrahedra beside a level are not found.
PLIANT_API pliant_status pliant_scene_load_memory(const void* bytes, size_t byte_count, const char* name,
                                                  const pliant_load_options* options, pliant_scene** out);
// An empty one. Names of objects, probes and effects must be unique; pliant_session_open reports what is wrong.
PLIANT_API pliant_status pliant_scene_create(const char* name, pliant_scene** out);
// Sessions that were opened on it are unaffected.
PLIANT_API pliant_status pliant_scene_destroy(pliant_scene* scene);
// Writes .gltf (with a .bin beside it) or .glb, by the extension.
PLIANT_API pliant_status pliant_scene_save(pliant_scene* scene, const char* path);
// Of its loading. Text is valid until the scene is destroyed.
PLIANT_API pliant_status pliant_scene_note_count(pliant_scene* scene, size_t* count);
PLIANT_API pliant_status pliant_scene_note(pliant_scene* scene, size_t index, const char** out);

// Triangles. Arrays other than `position` and `index` are NULL or have an entry per vertex.
typedef struct pliant_mesh {
  uint32_t size;
  uint32_t vertex_count;
  uint32_t index_count;     // three times the number of triangles
  const float* position;    // [m] x, y, z per vertex, object frame
  const uint32_t* index;    // three per triangle, counter-clockwise from outside
  const float* normal;      // [1] x, y, z for shading; NULL: computed
  const float* uv;          // u, v
  const float* stiffness;   // [1] painted factors of a deformable surface ...
  const float* friction;    // [1]
  const float* damping;     // [1]
  const float* relaxation;  // [1]
  const float* pinned;      // [1] 0 to 1: pinned vertices of a soft body
  const float* handle;      // [1] 0 to 1: vertices attached to a tool's handle
} pliant_mesh;

typedef struct pliant_placement {
  uint32_t size;
  pliant_pose pose;
  pliant_vec3 scale;  // [1]; all zeros: 1
} pliant_placement;

// Parameters have the defaults of the level format; pliant_scene_set changes them. `at` NULL: at the origin.
PLIANT_API pliant_status pliant_scene_add_surface(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                                  const pliant_placement* at);
PLIANT_API pliant_status pliant_scene_add_soft_body(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                                    const pliant_placement* at);
PLIANT_API pliant_status pliant_scene_add_rigid_body(pliant_scene* scene, const char* name, const pliant_mesh* mesh,
                                                     const pliant_placement* at);
// Makes a soft or rigid body a tool, which is moved by its handle.
PLIANT_API pliant_status pliant_scene_add_handle(pliant_scene* scene, const char* body);
// A point probe; "NAME.probe.radius=0.004" makes it a sphere.
PLIANT_API pliant_status pliant_scene_add_probe(pliant_scene* scene, const char* name, const pliant_placement* at);
// Acts on probes in space; "NAME.effect.kind=viscosity" and its other keys say how. `rows` (may be NULL, `count` 0):
// the path that the kind `guidance` follows, in the effect's frame.
PLIANT_API pliant_status pliant_scene_add_effect(pliant_scene* scene, const char* name, const pliant_placement* at,
                                                 const pliant_path_row* rows, size_t count);
// Connects two bodies of the scene, or `a` and the world (`b` NULL). "NAME.joint.kind=hinge" and its other keys say
// how.
PLIANT_API pliant_status pliant_scene_add_joint(pliant_scene* scene, const char* name, const char* a, const char* b,
                                                const pliant_placement* at);
// One key of the level format, "NODE.EXTENSION.KEY=VALUE" (docs/level-format.md): "organ.deformable.stiffness=500",
// "scene.simulation.touch_rate=2000". The error lists the valid names.
PLIANT_API pliant_status pliant_scene_set(pliant_scene* scene, const char* assignment);

// ---- Sessions

// Copies the scene and allocates all that a tick needs, which takes seconds for a large one. `progress` may be NULL.
PLIANT_API pliant_status pliant_session_open(pliant_scene* scene, pliant_progress progress, void* user,
                                             pliant_session** out);
// Stops it; every device gets zero force.
PLIANT_API pliant_status pliant_session_destroy(pliant_session* session);

// Names, valid until the session is destroyed. Effectors: probes, then tools. Objects: surfaces, soft and rigid bodies.
PLIANT_API pliant_status pliant_session_effector_count(pliant_session* session, uint32_t* count);
PLIANT_API pliant_status pliant_session_effector(pliant_session* session, uint32_t index, const char** out);
PLIANT_API pliant_status pliant_session_object_count(pliant_session* session, uint32_t* count);
PLIANT_API pliant_status pliant_session_object(pliant_session* session, uint32_t index, const char** out);
// Conversions and defaults that were not expected. Text is valid until the next call with the session.
PLIANT_API pliant_status pliant_session_note_count(pliant_session* session, size_t* count);
PLIANT_API pliant_status pliant_session_note(pliant_session* session, size_t index, const char** out);

// ---- Time. Lockstep: ticks run inside the call, in virtual time; the same poses give the same bits. Real time: from
// pliant_session_start to pliant_session_stop the session's own threads run the ticks, 1000 a second.

// A tick in lockstep: effector i goes to poses[i] and feels felt[i], the force and torque on the hand. `count` is the
// number of effectors. `felt` may be NULL.
PLIANT_API pliant_status pliant_session_tick(pliant_session* session, const pliant_pose* poses, pliant_wrench* felt,
                                             size_t count);
// Ticks in lockstep with the sources as they are. A device keeps its last force until the next call.
PLIANT_API pliant_status pliant_session_step(pliant_session* session, uint64_t ticks);
PLIANT_API pliant_status pliant_session_start(pliant_session* session);
// Devices ramp down, and return gently.
PLIANT_API pliant_status pliant_session_pause(pliant_session* session, int32_t paused);
// The error says what ended the threads before.
PLIANT_API pliant_status pliant_session_stop(pliant_session* session);
PLIANT_API pliant_status pliant_session_is_running(pliant_session* session, int32_t* out);
// Back to the initial state at time 0. Keeps sources and parameters; pictures end. After an error in a tick only this
// works.
PLIANT_API pliant_status pliant_session_restart(pliant_session* session);
PLIANT_API pliant_status pliant_session_time(pliant_session* session, double* seconds);

// ---- The source of a probe or tool. Each has one; a second one is an error until pliant_session_release.

// Sets the target pose. In real time, call it once a frame: the motion is spread over the time since the last call; the
// first pose must be set before pliant_session_start, and after 0.25 s without one the probe counts as lost (no force).
PLIANT_API pliant_status pliant_session_move(pliant_session* session, const char* effector, pliant_pose pose);
// A path in time, linear between rows. It stays at the last row, or starts again (`repeats`).
PLIANT_API pliant_status pliant_session_follow(pliant_session* session, const char* effector,
                                               const pliant_path_row* rows, size_t count, int32_t repeats);
// A generated path over the surfaces.
PLIANT_API pliant_status pliant_session_orbit(pliant_session* session, const char* effector);
// A haptic device: "DRIVER" or "DRIVER:ID", from pliant_device or a level's `id`.
PLIANT_API pliant_status pliant_session_connect(pliant_session* session, const char* effector, const char* driver);
// Removes the source: no force.
PLIANT_API pliant_status pliant_session_release(pliant_session* session, const char* effector);

// ---- Parameters between ticks: names as in the level format; docs/embedding.md lists those that can be set. The error
// says whether the object, the key or the value is wrong.
PLIANT_API pliant_status pliant_session_set(pliant_session* session, const char* object, const char* key, double value);
PLIANT_API pliant_status pliant_session_set_word(pliant_session* session, const char* object, const char* key,
                                                 const char* word);
PLIANT_API pliant_status pliant_session_set_values(pliant_session* session, const char* object, const char* key,
                                                   const double* values, size_t count);
PLIANT_API pliant_status pliant_session_get(pliant_session* session, const char* object, const char* key, double* out);

// Sliders that the level offers: the arguments of pliant_session_set, a label, and bounds in the key's unit. Text is
// valid until the session is destroyed.
typedef struct pliant_slider {
  uint32_t size;
  const char* object;
  const char* key;
  const char* name;
  const char* unit;  // "": none
  double low, high;
  double step;  // 0: continuous
} pliant_slider;

PLIANT_API pliant_status pliant_session_slider_count(pliant_session* session, size_t* count);
PLIANT_API pliant_status pliant_session_slider(pliant_session* session, size_t index, pliant_slider* out);

// ---- Results. In real time: of the newest tick that was published.

typedef struct pliant_reading {
  uint32_t size;
  int32_t ready;         // 0: its source is lost or unknown; the force is zero
  int32_t touching;      // 1: in contact
  uint32_t object;       // of the strongest contact, into the session's objects; PLIANT_NONE: none
  uint32_t contacts;     // number of a probe's contacts with surfaces (pliant_session_contacts)
  uint64_t tick;         // number of the tick, from 1
  double time;           // [s]
  pliant_vec3 position;  // [m] world: of a probe; of a tool, of its device
  pliant_vec3 force;     // [N] world, on the hand, after every limit
  pliant_vec3 torque;    // [N m] world, on the hand; tools alone
  pliant_vec3 normal;    // [1] world, outward, of the strongest contact
  double depth;          // [m] below the undeformed surface, of the strongest contact
} pliant_reading;

PLIANT_API pliant_status pliant_session_reading(pliant_session* session, const char* effector, pliant_reading* out);

// A contact of a probe with a deformable surface.
typedef struct pliant_contact {
  uint32_t size;
  int32_t sliding;       // 1: slides; 0: sticks
  uint32_t object;       // into the session's objects
  uint32_t triangle;     // of the object, as in pliant_session_triangles
  uint32_t vertex;       // its corner nearest to `position`
  pliant_vec3 position;  // [m] world, on the undeformed surface
  pliant_vec3 normal;    // [1] world, outward
  pliant_vec3 force;     // [N] world, on the probe, before limits
  double depth;          // [m] below the undeformed surface
} pliant_contact;

// At most 16.
PLIANT_API pliant_status pliant_session_contacts(pliant_session* session, const char* effector, pliant_contact* out,
                                                 size_t capacity, size_t* count);

typedef struct pliant_contact_side {
  uint32_t object;            // into the session's objects; PLIANT_NONE: a probe
  uint32_t effector;          // into the session's effectors; PLIANT_NONE: neither probe nor tool
  uint32_t triangle, vertex;  // of the object; PLIANT_NONE: of a probe
} pliant_contact_side;

// A contact of soft or rigid bodies (tools and probes among them) in the newest soft step.
typedef struct pliant_body_contact {
  uint32_t size;
  int32_t sliding;
  pliant_contact_side a, b;
  pliant_vec3 position;  // [m] world
  pliant_vec3 normal;    // [1] world, towards `a`
  pliant_vec3 force;     // [N] world, on `a`, with friction; its reaction is on `b`
  double depth;          // [m] below 0: distance
} pliant_body_contact;

// At most 512.
PLIANT_API pliant_status pliant_session_body_contacts(pliant_session* session, pliant_body_contact* out,
                                                      size_t capacity, size_t* count);

// The force of tissue and contacts on a tool's handle in the newest soft step.
typedef struct pliant_handle_reading {
  uint32_t size;
  const char* tool;  // name; valid until the session is destroyed
  pliant_pose pose;
  pliant_wrench wrench;  // about the handle's centre
} pliant_handle_reading;

PLIANT_API pliant_status pliant_session_handles(pliant_session* session, pliant_handle_reading* out, size_t capacity,
                                                size_t* count);

enum { PLIANT_EVENT_BROKE = 0, PLIANT_EVENT_YIELDED = 1, PLIANT_EVENT_CROSSED = 2 };

// A layer that broke, tissue that yielded, a detent that was crossed. Text is valid until the next
// pliant_session_take_events.
typedef struct pliant_event {
  uint32_t size;
  int32_t kind;   // PLIANT_EVENT_...
  int32_t index;  // of the layer, from 0; of the detent reached
  uint64_t tick;
  double time;           // [s]
  const char* probe;     // name of the effector
  const char* object;    // name of the surface or effect
  const char* layer;     // name of the layer; "": none
  const char* sentence;  // "needle broke layer skin of organ at 0.420 s, 1.20 N"
  pliant_vec3 position;  // [m] world
  double value;          // [N] force at which it broke or yielded
} pliant_event;

// Takes at most `capacity` events since the last call, oldest first; `*count`: how many were taken, `*lost` (may be
// NULL): how many were dropped, since at most 4096 wait. Call again while `*count` equals `capacity`.
PLIANT_API pliant_status pliant_session_take_events(pliant_session* session, pliant_event* out, size_t capacity,
                                                    size_t* count, uint64_t* lost);

// Keeps the readings of the last `ticks` ticks of every effector, to be taken: for a log at 1 kHz in real time. 0:
// none.
PLIANT_API pliant_status pliant_session_keep_readings(pliant_session* session, uint64_t ticks);
// Takes at most `capacity` of them, oldest first; as pliant_session_take_events.
PLIANT_API pliant_status pliant_session_take_readings(pliant_session* session, const char* effector,
                                                      pliant_reading* out, size_t capacity, size_t* count,
                                                      uint64_t* lost);

typedef struct pliant_figures {
  uint32_t size;
  uint64_t ticks;
  double p50_us, p99_us, max_us;  // [us] duration of a tick
  uint64_t overruns;              // in real time: ticks that started late
  uint64_t soft_steps;
} pliant_figures;

PLIANT_API pliant_status pliant_session_figures(pliant_session* session, pliant_figures* out);

// A deviation from the force law: clipped, withheld or slew-limited forces, dropped contacts. Text is valid until the
// next pliant_session_find.
typedef struct pliant_note {
  uint32_t size;
  const char* message;  // the whole sentence
  const char* code;     // "force.clipped" (docs/codes.md)
  const char* of;       // name of the probe, tool, body or device; "": the whole
} pliant_note;

// Collects all so far. Not in real time while it runs.
PLIANT_API pliant_status pliant_session_find(pliant_session* session, size_t* count);
PLIANT_API pliant_status pliant_session_finding(pliant_session* session, size_t index, pliant_note* out);

// ---- Vertices and triangles of an object as the program or file gave it. Floats x, y, z per vertex; `capacity` and
// `count` are vertices.

// Deformed positions [m], world frame.
PLIANT_API pliant_status pliant_session_vertices(pliant_session* session, const char* object, float* out,
                                                 size_t capacity, size_t* count);
// Unit normals [1] of the deformed mesh, world frame: of the triangles around a vertex, weighted by their areas.
PLIANT_API pliant_status pliant_session_normals(pliant_session* session, const char* object, float* out,
                                                size_t capacity, size_t* count);
// Forces of contacts [N], world frame.
PLIANT_API pliant_status pliant_session_vertex_forces(pliant_session* session, const char* object, float* out,
                                                      size_t capacity, size_t* count);
// Indices into these vertices, three per triangle, counter-clockwise from outside. `capacity`, `count`: of indices.
PLIANT_API pliant_status pliant_session_triangles(pliant_session* session, const char* object, uint32_t* out,
                                                  size_t capacity, size_t* count);

// ---- For a renderer: geometry once, and per picture the stream and the frame of a deformable surface.
//   position = P0 + stream.w * N0;  normal = N0 + stream.xyz;  then `to_world`

// The drawn surface, at rest, object frame. Valid until the session is destroyed, or the next call for this object.
typedef struct pliant_geometry {
  uint32_t size;
  uint32_t vertex_count;
  uint32_t index_count;
  const float* position;          // [m] P0: x, y, z per vertex
  const float* normal;            // [1] N0: x, y, z
  const float* shading_normal;    // [1] x, y, z
  const float* uv;                // u, v; NULL: it has none
  const uint32_t* stream_vertex;  // per vertex, its index in the stream
  const uint32_t* index;          // three per triangle
} pliant_geometry;

PLIANT_API pliant_status pliant_session_geometry(pliant_session* session, const char* object, pliant_geometry* out);
// nx, ny, nz [1] and the height h [m] (below 0: pressed in) per vertex of the stream. `*stream` is valid until the next
// call for this object, or the session's end. `*changed` (`changed`, `changed_count` may be NULL): the ranges that
// changed since the last call, ascending; all of it the first time.
PLIANT_API pliant_status pliant_session_stream(pliant_session* session, const char* object, const float** stream,
                                               size_t* count, const pliant_range** changed, size_t* changed_count);
// Object frame to world, 16 floats, column by column.
PLIANT_API pliant_status pliant_session_to_world(pliant_session* session, const char* object, float* out);

// ---- Queries, on the deformed state

typedef struct pliant_query {
  uint32_t size;
  int32_t rest;        // 1: the undeformed shape
  const char* object;  // name; NULL: all objects
  double within;       // [m] search radius; 0: unlimited
} pliant_query;

typedef struct pliant_hit {
  uint32_t size;
  int32_t found;            // 0: nothing within reach; the rest is zero
  uint32_t object;          // into the session's objects
  uint32_t triangle;        // as in pliant_session_triangles
  pliant_vec3 barycentric;  // [1] of its corners
  pliant_vec3 position;     // [m] world
  pliant_vec3 normal;       // [1] world, outward
  double distance;          // [m]
} pliant_hit;

// `query` may be NULL.
PLIANT_API pliant_status pliant_session_closest_point(pliant_session* session, pliant_vec3 point,
                                                      const pliant_query* query, pliant_hit* out);
PLIANT_API pliant_status pliant_session_ray(pliant_session* session, pliant_vec3 from, pliant_vec3 direction,
                                            const pliant_query* query, pliant_hit* out);
PLIANT_API pliant_status pliant_session_bounds(pliant_session* session, const pliant_query* query, pliant_vec3* min,
                                               pliant_vec3* max);

// ---- Forces from outside, constant until changed (zero removes them), and impulses, applied once. World frame.

// On the hand that holds the effector, beside its contact force; torque for tools alone.
PLIANT_API pliant_status pliant_session_set_hand_force(pliant_session* session, const char* effector,
                                                       pliant_wrench wrench);
// On a moving body: at its centre of mass, or [N] on one vertex.
PLIANT_API pliant_status pliant_session_set_body_force(pliant_session* session, const char* body, pliant_wrench wrench);
PLIANT_API pliant_status pliant_session_set_point_force(pliant_session* session, const char* body, uint32_t vertex,
                                                        pliant_vec3 force);
// [N s], [N m s]
PLIANT_API pliant_status pliant_session_push(pliant_session* session, const char* body, pliant_wrench impulse);
PLIANT_API pliant_status pliant_session_push_at(pliant_session* session, const char* body, uint32_t vertex,
                                                pliant_vec3 impulse);

// ---- Objects between ticks; not tools
PLIANT_API pliant_status pliant_session_place(pliant_session* session, const char* object, pliant_pose pose);
PLIANT_API pliant_status pliant_session_take_out(pliant_session* session, const char* object);
PLIANT_API pliant_status pliant_session_put_back(pliant_session* session, const char* object);
PLIANT_API pliant_status pliant_session_is_out(pliant_session* session, const char* object, int32_t* out);
// The objects of another scene, in lockstep. Names and counts are to be read again.
PLIANT_API pliant_status pliant_session_add(pliant_session* session, pliant_scene* more);

// ---- States of lockstep runs, for any session of the same scene

// `*bytes` is valid until the next call of this function or the session's end.
PLIANT_API pliant_status pliant_session_save_state(pliant_session* session, const uint8_t** bytes, size_t* count);
// After it, the same poses give the same bits. It runs the state's ticks again, and checks bytes of any origin.
PLIANT_API pliant_status pliant_session_restore_state(pliant_session* session, const uint8_t* bytes, size_t count);

// ---- Recordings: the pose of every effector at every tick

// `replace` 0: an existing file is an error. Written at pliant_session_end_recording, or the session's end.
PLIANT_API pliant_status pliant_session_record(pliant_session* session, const char* path, int32_t replace);
PLIANT_API pliant_status pliant_session_end_recording(pliant_session* session);
// The recording becomes the source of every effector, in lockstep.
PLIANT_API pliant_status pliant_session_replay(pliant_session* session, const char* path);
PLIANT_API pliant_status pliant_export_recording(const char* recording, const char* csv);

// ---- Devices

// Registers the drivers that ship (docs/devices.md). Call before pliant_list_devices and pliant_session_connect.
PLIANT_API pliant_status pliant_register_all_drivers(void);

typedef struct pliant_device_info {
  uint32_t size;
  int32_t renders_force, renders_torque, senses_rotation;
  const char* driver;   // "DRIVER:ID" opens it: `driver` and `id`
  const char* id;       // "": the driver's name alone
  const char* name;     // for people
  const char* missing;  // why it cannot be opened, and the remedy; "": it can
  double max_force;     // [N] 0: not stated
  double rate;          // [Hz] of its servo; 0: it runs on the touch clock
} pliant_device_info;

// Looks for devices, which takes some milliseconds. pliant_device reads the calling thread's list; text is valid until
// its next pliant_list_devices.
PLIANT_API pliant_status pliant_list_devices(size_t* count);
PLIANT_API pliant_status pliant_device(size_t index, pliant_device_info* out);

enum {
  PLIANT_DEVICE_DISCONNECTED = 0,
  PLIANT_DEVICE_IDLE = 1,
  PLIANT_DEVICE_ARMED = 2,
  PLIANT_DEVICE_ACTIVE = 3,  // the only one with force
  PLIANT_DEVICE_TRIPPED = 4  // latched until pliant_session_arm
};

// Safety of the next device that is connected to an effector. A device's own limits hold beside it.
typedef struct pliant_guard {
  uint32_t size;
  int32_t by_hand;      // 1: force only after pliant_session_arm
  uint32_t dead_man;    // bit mask of buttons of which one must be held; 0: none
  double max_force;     // [N] 0: the device's
  double max_torque;    // [N m] 0: the device's
  double max_velocity;  // [m/s] 0: the device's, else 2
  double slew;          // [N/s] of rising force; 0: 2000
  double ramp;          // [s] in which the force comes in; 0: 0.2
} pliant_guard;

typedef struct pliant_device_sample {
  uint32_t size;
  int32_t ready;      // 0: its state is unknown: no force
  pliant_pose pose;   // [m] in its workspace, world axes
  double grip;        // [1] 0 to 1
  double time;        // [s] of sensing, monotonic clock; 0: now
  double battery;     // [1] 0 to 1; below 0: unknown
  uint32_t buttons;   // bit mask of pressed buttons
  uint32_t warnings;  // 1: warm; 2: battery low
} pliant_device_sample;

typedef struct pliant_device_report {
  uint32_t size;
  int32_t state;      // PLIANT_DEVICE_...
  const char* cause;  // of the last change of state, with its remedy; valid until the next call with the session
  double force;       // [N] written last
  double max_force;   // [N] limit of the moment; 0: none
  double heat;        // [1] at 1 the force is lowered to its continuous limit
  double sample_age;  // [s] below 0: no sample yet
  pliant_device_sample sample;  // the newest
  pliant_wrench wanted, sent;
  uint64_t periods, missed;  // of its servo
  double rate;               // [Hz] measured
} pliant_device_report;

PLIANT_API pliant_status pliant_session_guard(pliant_session* session, const char* effector, const pliant_guard* guard);
PLIANT_API pliant_status pliant_session_device_report(pliant_session* session, const char* effector,
                                                      pliant_device_report* out);
PLIANT_API pliant_status pliant_session_arm(pliant_session* session, const char* effector);
PLIANT_API pliant_status pliant_session_disarm(pliant_session* session, const char* effector);
// Removes the force of every device until each is armed. From any thread, also while another call uses the session; it
// waits only for one that connects, releases, restarts or ends it.
PLIANT_API pliant_status pliant_session_emergency_stop(pliant_session* session);

// A driver of the program's own. `read` and `write` run on one clock, at 1 kHz or at `rate`, and must return at once.
typedef struct pliant_driver {
  uint32_t size;
  int32_t senses_rotation, renders_force, renders_torque;
  double max_force;      // [N] 0: not stated
  double max_torque;     // [N m] 0: not stated
  double max_stiffness;  // [N/m] largest stable one; 0: not stated
  double max_velocity;   // [m/s] if faster, its force ends until armed; 0: not stated
  double rate;           // [Hz] of a servo with a thread of its own; 0: on the touch clock
  void* user;            // first argument of `open`
  // Opens a device, sets `*device` and returns 0; or writes a sentence of at most `room` bytes and returns another
  // value.
  int32_t (*open)(void* user, const char* id, void** device, char* sentence, size_t room);
  // 1: a new sample; 0: none since the last call; below 0: the device failed, which ends the run. `sample` comes with
  // its defaults.
  int32_t (*read)(void* device, pliant_device_sample* sample);
  // The force on the hand, after every limit; the last one is zero.
  void (*write)(void* device, const pliant_wrench* wrench);
  void (*close)(void* device);
} pliant_driver;

// `name`: not in use, without ':'. It stays until the program ends, and `user` with it.
PLIANT_API pliant_status pliant_register_driver(const char* name, const pliant_driver* driver);

// ---- Pictures by Pliant's renderer. Made while the session stands still; drawn in lockstep and in real time. They end
// with the session and at pliant_session_restart: destroy them, and make new ones.

typedef struct pliant_view {
  uint32_t size;
  pliant_vec3 eye, target;  // [m] world
  pliant_vec3 up;
  double yfov;  // [rad] vertical field of view
} pliant_view;

// Without window and display: on the GPU, or by Mesa's software renderer.
PLIANT_API pliant_status pliant_pictures_headless(pliant_session* session, pliant_pictures** out);
// In the OpenGL 4.5 core or ES 3.0 context that is current on this thread, now and in every later call.
PLIANT_API pliant_status pliant_pictures_in_current_context(pliant_session* session, pliant_pictures** out);
PLIANT_API pliant_status pliant_pictures_destroy(pliant_pictures* pictures);
// The level's camera, or one that shows every surface.
PLIANT_API pliant_status pliant_pictures_view(pliant_pictures* pictures, pliant_view* out);
// sRGB, four bytes per pixel, rows from top to bottom; `room`: bytes at `rgba`, at least 4 * width * height.
PLIANT_API pliant_status pliant_pictures_picture(pliant_pictures* pictures, const pliant_view* view, int32_t width,
                                                 int32_t height, uint8_t* rgba, size_t room);
// Into a framebuffer, or into a two-dimensional texture (GL_RGBA8 or GL_SRGB8_ALPHA8 of that size) of the current
// context, whose first row is the lowest. Only for pictures in the current context. Framebuffer 0 is the window's.
PLIANT_API pliant_status pliant_pictures_draw(pliant_pictures* pictures, const pliant_view* view, uint32_t framebuffer,
                                              int32_t width, int32_t height);
PLIANT_API pliant_status pliant_pictures_draw_texture(pliant_pictures* pictures, const pliant_view* view,
                                                      uint32_t texture, int32_t width, int32_t height);

#ifdef __cplusplus
}
#endif
