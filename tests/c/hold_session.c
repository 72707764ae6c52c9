// The C interface, used by a C11 program.
#include "hold_session.h"

#include <math.h>
#include <pliant.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int fail(void) {
  return fprintf(stderr, "%s [%s]\n", pliant_error_message(), pliant_error_code()), 1;
}

static pliant_pose along(double y, int tick) {
  const pliant_pose pose = {{0.002 * sin(0.02 * tick), y - 2e-5 * tick, 0.0}, {0, 0, 0, 0}};
  return pose;
}

int press_in_c(const char* level, double y, int ticks, felt_in_c* felt) {
  pliant_scene* scene = NULL;
  pliant_session* session = NULL;
  if (pliant_scene_load(level, NULL, &scene) || pliant_session_open(scene, NULL, NULL, &session)) return fail();
  uint32_t count = 0;
  const char* name = NULL;
  if (pliant_session_effector_count(session, &count) || pliant_session_effector(session, 0, &name)) return fail();
  pliant_reading reading = {.size = sizeof reading};
  for (int i = 0; i < ticks; ++i) {
    pliant_wrench wrench = {{0, 0, 0}, {0, 0, 0}};
    const pliant_pose pose = along(y, i);
    if (count == 1) {
      if (pliant_session_tick(session, &pose, &wrench, 1)) return fail();
    } else if (pliant_session_move(session, name, pose) || pliant_session_step(session, 1)) {
      return fail();
    }
    if (pliant_session_reading(session, name, &reading)) return fail();
    if (count == 1 && memcmp(&wrench.force, &reading.force, sizeof wrench.force) != 0) return 1;
    felt[i] = (felt_in_c){reading.force.x, reading.force.y, reading.force.z, reading.depth};
  }
  if (pliant_session_destroy(session) || pliant_scene_destroy(scene)) return fail();
  return 0;
}

#define EXPECT(condition)                                                                           \
  do {                                                                                              \
    if (!(condition)) return fprintf(stderr, "line %d: %s\n", __LINE__, pliant_error_message()), __LINE__; \
  } while (0)
#define DONE(call) EXPECT((call) == PLIANT_OK)

static int use_vertices(pliant_session* session, const char* object) {
  size_t vertices = 0, indices = 0, again = 0;
  DONE(pliant_session_vertices(session, object, NULL, 0, &vertices));
  DONE(pliant_session_triangles(session, object, NULL, 0, &indices));
  EXPECT(vertices > 3 && indices % 3 == 0);
  float* const positions = malloc(vertices * 12);
  float* const normals = malloc(vertices * 12);
  EXPECT(pliant_session_vertices(session, object, positions, vertices - 1, &again) == PLIANT_MISUSED);
  EXPECT(again == vertices && strcmp(pliant_error_code(), "call.room") == 0);
  DONE(pliant_session_vertices(session, object, positions, vertices, &again));
  DONE(pliant_session_normals(session, object, normals, vertices, &again));
  pliant_vec3 min, max;
  pliant_query query = {.size = sizeof query, .object = object};
  DONE(pliant_session_bounds(session, &query, &min, &max));
  for (size_t i = 0; i < vertices; ++i) {
    const float* const n = normals + 3 * i;
    EXPECT(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-5f);
    EXPECT(positions[3 * i] >= min.x - 1e-6 && positions[3 * i] <= max.x + 1e-6);
  }
  // The nearest point to a vertex is that vertex.
  pliant_hit hit = {.size = sizeof hit};
  DONE(pliant_session_closest_point(session, (pliant_vec3){positions[0], positions[1], positions[2]}, &query, &hit));
  EXPECT(hit.found && hit.distance < 1e-6);
  free(positions);
  free(normals);
  return 0;
}

static int use_stream(pliant_session* session, const char* surface) {
  pliant_geometry geometry = {.size = sizeof geometry};
  DONE(pliant_session_geometry(session, surface, &geometry));
  const float* stream = NULL;
  const pliant_range* changed = NULL;
  size_t count = 0, ranges = 0;
  DONE(pliant_session_stream(session, surface, &stream, &count, &changed, &ranges));
  EXPECT(ranges == 1 && changed[0].first == 0 && changed[0].count == count);  // all of it, the first time
  float deepest = 0.0f;
  for (uint32_t i = 0; i < geometry.vertex_count; ++i) {
    EXPECT(geometry.stream_vertex[i] < count);
    deepest = fminf(deepest, stream[4 * geometry.stream_vertex[i] + 3]);
  }
  EXPECT(deepest < -1e-4f);
  DONE(pliant_session_stream(session, surface, &stream, &count, &changed, &ranges));
  EXPECT(ranges == 0);  // without a tick
  float to_world[16];
  DONE(pliant_session_to_world(session, surface, to_world));
  EXPECT(to_world[15] == 1.0f);
  return 0;
}

static int use_states(pliant_session* session, const char* probe) {
  const uint8_t* bytes = NULL;
  size_t count = 0;
  pliant_reading first = {.size = sizeof first}, second = {.size = sizeof second};
  DONE(pliant_session_save_state(session, &bytes, &count));
  uint8_t* const state = malloc(count);
  memcpy(state, bytes, count);
  DONE(pliant_session_step(session, 20));
  DONE(pliant_session_reading(session, probe, &first));
  DONE(pliant_session_restore_state(session, state, count));
  DONE(pliant_session_step(session, 20));
  DONE(pliant_session_reading(session, probe, &second));
  EXPECT(memcmp(&first, &second, sizeof first) == 0);
  state[count / 2] ^= 0x55;
  EXPECT(pliant_session_restore_state(session, state, count) != PLIANT_OK);
  EXPECT(pliant_session_restore_state(session, state, 3) != PLIANT_OK);
  free(state);
  return 0;
}

static int use_pictures(pliant_session* session) {
  pliant_pictures* pictures = NULL;
  DONE(pliant_pictures_headless(session, &pictures));
  pliant_view view = {.size = sizeof view};
  DONE(pliant_pictures_view(pictures, &view));
  uint8_t* const rgba = calloc(64 * 48, 4);
  DONE(pliant_pictures_picture(pictures, &view, 64, 48, rgba, 64 * 48 * 4));
  int colours = 0;
  for (int i = 4; i < 64 * 48 * 4; i += 4) colours += memcmp(rgba + i, rgba, 3) != 0;
  EXPECT(colours > 100);
  EXPECT(pliant_pictures_picture(pictures, &view, 65, 48, rgba, 64 * 48 * 4) == PLIANT_MISUSED);
  EXPECT(pliant_pictures_draw_texture(pictures, &view, 1, 64, 48) == PLIANT_MISUSED);
  pliant_pictures* second = NULL;
  EXPECT(pliant_pictures_headless(session, &second) == PLIANT_FAILED);
  EXPECT(pliant_pictures_in_current_context(session, &second) == PLIANT_FAILED);  // there is none
  DONE(pliant_session_restart(session));
  EXPECT(pliant_pictures_picture(pictures, &view, 64, 48, rgba, 64 * 48 * 4) == PLIANT_FAILED);
  DONE(pliant_pictures_destroy(pictures));
  free(rgba);
  return 0;
}

// A device at rest 3 mm inside the surface, which keeps the largest force that it was sent.
typedef struct device {
  double largest, last;
  int opened, closed, reads;
} device;
static device the_device;
static int32_t device_open(void* user, const char* id, void** out, char* sentence, size_t room) {
  if (strcmp(id, "broken") == 0) return snprintf(sentence, room, "it is broken; mend it"), 1;
  *out = user;
  ++((device*)user)->opened;
  return 0;
}
static int32_t device_read(void* user, pliant_device_sample* sample) {
  device* const d = user;
  const double y = ++d->reads < 200 ? 0.03 - 1.65e-4 * d->reads : -0.003;
  sample->pose.position = (pliant_vec3){0, y, 0};
  return 1;
}
static void device_write(void* user, const pliant_wrench* wrench) {
  device* const d = user;
  d->last = sqrt(wrench->force.x * wrench->force.x + wrench->force.y * wrench->force.y + wrench->force.z * wrench->force.z);
  d->largest = fmax(d->largest, d->last);
}
static void device_close(void* user) {
  ++((device*)user)->closed;
}

static int use_device(pliant_session* session, const char* probe) {
  const pliant_driver driver = {.size = sizeof driver, .renders_force = 1, .user = &the_device, .open = device_open,
                                .read = device_read, .write = device_write, .close = device_close};
  DONE(pliant_register_driver("in_c", &driver));
  EXPECT(pliant_register_driver("in_c", &driver) == PLIANT_FAILED);
  EXPECT(pliant_session_connect(session, probe, "in_c:broken") == PLIANT_FAILED);
  EXPECT(strstr(pliant_error_message(), "it is broken; mend it") != NULL);
  DONE(pliant_session_connect(session, probe, "in_c:one"));
  DONE(pliant_session_step(session, 600));
  pliant_device_report report = {.size = sizeof report};
  DONE(pliant_session_device_report(session, probe, &report));
  EXPECT(report.state == PLIANT_DEVICE_ACTIVE && report.cause[0] != '\0');
  EXPECT(the_device.largest > 0.1 && the_device.opened == 1);
  DONE(pliant_session_release(session, probe));
  EXPECT(the_device.last == 0.0 && the_device.closed == 1);
  return 0;
}

static int use_code_level(void) {
  static const float corners[] = {-0.05f, 0, -0.05f, -0.05f, 0, 0.05f, 0.05f, 0, -0.05f, 0.05f, 0, 0.05f};
  static const uint32_t indices[] = {0, 1, 2, 2, 1, 3};
  pliant_mesh mesh = {.size = sizeof mesh, .vertex_count = 4, .index_count = 6, .position = corners, .index = indices};
  pliant_scene* scene = NULL;
  pliant_session* session = NULL;
  DONE(pliant_scene_create("table", &scene));
  DONE(pliant_scene_add_surface(scene, "skin", &mesh, NULL));
  DONE(pliant_scene_add_probe(scene, "finger", NULL));
  DONE(pliant_scene_set(scene, "skin.deformable.stiffness=500"));
  EXPECT(pliant_scene_set(scene, "skin.deformable.stifness=500") == PLIANT_FAILED);
  EXPECT(strstr(pliant_error_message(), "stiffness") != NULL);
  mesh.vertex_count = 3;
  EXPECT(pliant_scene_add_surface(scene, "torn", &mesh, NULL) == PLIANT_MISUSED);
  DONE(pliant_session_open(scene, NULL, NULL, &session));
  DONE(pliant_scene_destroy(scene));
  double stiffness = 0.0;
  DONE(pliant_session_get(session, "skin", "stiffness", &stiffness));
  EXPECT(stiffness == 500.0);
  pliant_wrench felt = {{0, 0, 0}, {0, 0, 0}};
  DONE(pliant_session_keep_readings(session, 1000));
  for (int i = 0; i < 400; ++i) {
    const pliant_pose pose = along(0.003, i);
    DONE(pliant_session_tick(session, &pose, &felt, 1));
  }
  pliant_contact contact[16] = {{.size = sizeof contact[0]}};
  size_t count = 0;
  DONE(pliant_session_contacts(session, "finger", contact, 16, &count));
  EXPECT(count == 1 && fabs(contact[0].normal.y - 1.0) < 1e-9 && felt.force.y > 1.0);
  pliant_reading kept[300] = {{.size = sizeof kept[0]}};
  uint64_t lost = 1;
  DONE(pliant_session_take_readings(session, "finger", kept, 300, &count, &lost));
  EXPECT(count == 300 && lost == 0 && kept[0].tick + 299 == kept[299].tick);
  DONE(pliant_session_take_readings(session, "finger", kept, 300, &count, &lost));
  EXPECT(count == 100);
  DONE(pliant_session_release(session, "finger"));
  DONE(pliant_session_restart(session));
  const int line = use_device(session, "finger");
  DONE(pliant_session_destroy(session));
  return line;
}

int use_all_in_c(const char* level) {
  // From memory: the same level as from the file.
  FILE* const file = fopen(level, "rb");
  EXPECT(file != NULL);
  static uint8_t bytes[1 << 22];
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  pliant_scene* scene = NULL;
  pliant_session* session = NULL;
  EXPECT(pliant_scene_load_memory(bytes, size / 2, "half.glb", NULL, &scene) == PLIANT_FAILED);
  EXPECT(strstr(pliant_error_message(), "half.glb") == pliant_error_message());
  DONE(pliant_scene_load_memory(bytes, size, "organ.glb", NULL, &scene));
  DONE(pliant_session_open(scene, NULL, NULL, &session));
  const char *probe = NULL, *surface = NULL;
  DONE(pliant_session_effector(session, 0, &probe));
  DONE(pliant_session_object(session, 0, &surface));
  EXPECT(pliant_session_object(session, 99, &surface) == PLIANT_MISUSED);
  DONE(pliant_session_orbit(session, probe));
  pliant_reading reading = {.size = sizeof reading};
  for (int i = 0; i < 2000 && !(reading.depth > 5e-4); ++i) {
    DONE(pliant_session_step(session, 1));
    DONE(pliant_session_reading(session, probe, &reading));
  }
  EXPECT(reading.touching);
  int line = use_vertices(session, surface);
  if (line == 0) line = use_stream(session, surface);
  if (line == 0) line = use_states(session, probe);
  if (line == 0) line = use_pictures(session);
  DONE(pliant_session_release(session, probe));
  if (line == 0) line = use_code_level();
  DONE(pliant_session_destroy(session));
  DONE(pliant_scene_destroy(scene));
  return line;
}
