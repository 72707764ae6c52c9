// PliantSession for Godot 4.2 and later: a RefCounted that runs a level.
//
//   var session = PliantSession.new()
//   if not session.open(ProjectSettings.globalize_path("res://organ.glb")): push_error(session.error())
//   session.move("finger", probe.global_position); session.start()
//   # per frame: session.move(...), session.force("finger"), session.vertices("organ")
//
// Godot's frame is Pliant's (right-handed, Y up, metres). `open` takes a path of the system. A method that fails returns false, 0 or an empty array, and
// error() the sentence.
#include <pliant.h>
#include <stdlib.h>
#include <string.h>

#include "gdextension.h"

typedef struct string_name {
  void* data;
} string_name;
typedef struct string {
  void* data;
} string;
typedef struct packed_array {
  void* data[2];
} packed_array;

static struct {
  void* library;
  void (*string_name_new)(void* to, const char* text, uint8_t is_static);
  void (*string_new)(void* to, const char* text);
  int64_t (*string_to_utf8)(const void* from, char* to, int64_t room);
  void (*string_destroy)(void* of);
  void (*packed_destroy)(void* of);
  void (*variant_new_nil)(void* to);
  void* (*packed_index)(void* of, int64_t index);
  void (*packed_resize)(void* of, const void* const* arguments, void* result, int count);
  void (*register_class)(void* library, const void* name, const void* parent, const class_info* info);
  void (*register_method)(void* library, const void* name, const method_info* info);
  void (*unregister_class)(void* library, const void* name);
  void* (*construct)(const void* name);
  void (*set_instance)(void* object, const void* name, void* instance);
  any_function (*to_variant)(int type);
  any_function (*from_variant)(int type);
  string_name class_name, parent_name, empty_name;
  string empty;
} host;

typedef struct instance {
  pliant_scene* scene;
  pliant_session* session;
} instance;

// Arguments and results of a call, as Godot passes them by pointer.
typedef union value {
  uint8_t boolean;
  int64_t integer;
  double real;
  string text;
  float vector[3];
  packed_array array;
} value;

typedef char text[512];
static const char* text_of(const void* argument, text to) {
  const int64_t length = host.string_to_utf8(argument, to, sizeof(text) - 1);
  to[length < 0 ? 0 : length < (int64_t)sizeof(text) ? length : (int64_t)sizeof(text) - 1] = '\0';
  return to;
}

static void close_session(instance* of) {
  pliant_session_destroy(of->session);
  pliant_scene_destroy(of->scene);
  of->session = NULL;
  of->scene = NULL;
}

static void open_method(instance* of, const void* const* arguments, void* result) {
  text path;
  close_session(of);
  const pliant_status status = pliant_scene_load(text_of(arguments[0], path), NULL, &of->scene);
  *(uint8_t*)result = status == PLIANT_OK && pliant_session_open(of->scene, NULL, NULL, &of->session) == PLIANT_OK;
}
static void connect_method(instance* of, const void* const* arguments, void* result) {
  text effector, driver;
  *(uint8_t*)result = pliant_register_all_drivers() == PLIANT_OK &&
                      pliant_session_connect(of->session, text_of(arguments[0], effector),
                                             text_of(arguments[1], driver)) == PLIANT_OK;
}
static void move_method(instance* of, const void* const* arguments, void* result) {
  text effector;
  const float* const at = arguments[1];
  const pliant_pose pose = {{at[0], at[1], at[2]}, {0, 0, 0, 1}};
  *(uint8_t*)result = pliant_session_move(of->session, text_of(arguments[0], effector), pose) == PLIANT_OK;
}
static void step_method(instance* of, const void* const* arguments, void* result) {
  const int64_t ticks = *(const int64_t*)arguments[0];
  *(uint8_t*)result = ticks > 0 && pliant_session_step(of->session, (uint64_t)ticks) == PLIANT_OK;
}
static void start_method(instance* of, const void* const* arguments, void* result) {
  (void)arguments;
  *(uint8_t*)result = pliant_session_start(of->session) == PLIANT_OK;
}
static void stop_method(instance* of, const void* const* arguments, void* result) {
  (void)arguments;
  *(uint8_t*)result = pliant_session_stop(of->session) == PLIANT_OK;
}
static void set_parameter_method(instance* of, const void* const* arguments, void* result) {
  text object, key;
  *(uint8_t*)result = pliant_session_set(of->session, text_of(arguments[0], object), text_of(arguments[1], key),
                                         *(const double*)arguments[2]) == PLIANT_OK;
}
static void force_method(instance* of, const void* const* arguments, void* result) {
  text effector;
  pliant_reading reading = {.size = sizeof reading};
  float* const to = result;
  memset(to, 0, 3 * sizeof *to);
  if (pliant_session_reading(of->session, text_of(arguments[0], effector), &reading)) return;
  to[0] = (float)reading.force.x;
  to[1] = (float)reading.force.y;
  to[2] = (float)reading.force.z;
}
// Positions and normals: Vector3 is three floats, one after the other.
static void fill(instance* of, const void* object_argument, void* result,
                 pliant_status (*get)(pliant_session*, const char*, float*, size_t, size_t*)) {
  text object;
  size_t count = 0;
  if (get(of->session, text_of(object_argument, object), NULL, 0, &count) || count == 0) return;
  const int64_t size = (int64_t)count;
  const void* const arguments[] = {&size};
  int64_t error = 0;
  host.packed_resize(result, arguments, &error, 1);
  float* const to = error == 0 ? host.packed_index(result, 0) : NULL;
  if (to) get(of->session, object, to, count, &count);
}
static void vertices_method(instance* of, const void* const* arguments, void* result) {
  fill(of, arguments[0], result, pliant_session_vertices);
}
static void normals_method(instance* of, const void* const* arguments, void* result) {
  fill(of, arguments[0], result, pliant_session_normals);
}
static void error_method(instance* of, const void* const* arguments, void* result) {
  (void)of;
  (void)arguments;
  host.string_destroy(result);
  host.string_new(result, pliant_error_message());
}

typedef struct method {
  const char* name;
  void (*act)(instance*, const void* const*, void*);
  int result;
  int arguments[3];
  const char* argument_names[3];
} method;
static const method kMethods[] = {
    {"open", open_method, TYPE_BOOL, {TYPE_STRING}, {"path"}},
    {"connect_device", connect_method, TYPE_BOOL, {TYPE_STRING, TYPE_STRING}, {"effector", "driver"}},
    {"move", move_method, TYPE_BOOL, {TYPE_STRING, TYPE_VECTOR3}, {"effector", "position"}},
    {"step", step_method, TYPE_BOOL, {TYPE_INT}, {"ticks"}},
    {"start", start_method, TYPE_BOOL, {0}, {0}},
    {"stop", stop_method, TYPE_BOOL, {0}, {0}},
    {"set_parameter", set_parameter_method, TYPE_BOOL, {TYPE_STRING, TYPE_STRING, TYPE_FLOAT}, {"object", "key", "value"}},
    {"force", force_method, TYPE_VECTOR3, {TYPE_STRING}, {"effector"}},
    {"vertices", vertices_method, TYPE_PACKED_VECTOR3_ARRAY, {TYPE_STRING}, {"object"}},
    {"normals", normals_method, TYPE_PACKED_VECTOR3_ARRAY, {TYPE_STRING}, {"object"}},
    {"error", error_method, TYPE_STRING, {0}, {0}},
};

static uint32_t argument_count(const method* of) {
  uint32_t count = 0;
  while (count < 3 && of->arguments[count] != TYPE_NIL) ++count;
  return count;
}

static void ptrcall(void* userdata, void* of, const void* const* arguments, void* result) {
  const method* const called = userdata;
  called->act(of, arguments, result);
}

// The same from variants.
static void call(void* userdata, void* of, const void* const* arguments, int64_t count, void* result,
                 call_error* error) {
  const method* const called = userdata;
  const uint32_t expected = argument_count(called);
  host.variant_new_nil(result);
  error->error = count < expected ? 4 : count > expected ? 3 : 0;
  error->argument = error->expected = (int32_t)expected;
  if (error->error != 0) return;
  value given[3], back;
  const void* pointers[3] = {&given[0], &given[1], &given[2]};
  for (uint32_t i = 0; i < expected; ++i) {
    void (*const convert)(void*, void*) = (void (*)(void*, void*))host.from_variant(called->arguments[i]);
    convert(&given[i], (void*)arguments[i]);
  }
  memset(&back, 0, sizeof back);  // of a String and an array: empty
  called->act(of, pointers, &back);
  void (*const convert)(void*, void*) = (void (*)(void*, void*))host.to_variant(called->result);
  convert(result, &back);
  if (called->result == TYPE_STRING) host.string_destroy(&back.text);
  if (called->result == TYPE_PACKED_VECTOR3_ARRAY) host.packed_destroy(&back.array);
  for (uint32_t i = 0; i < expected; ++i)
    if (called->arguments[i] == TYPE_STRING) host.string_destroy(&given[i].text);
}

static void* create(void* userdata) {
  (void)userdata;
  void* const object = host.construct(&host.parent_name);
  host.set_instance(object, &host.class_name, calloc(1, sizeof(instance)));
  return object;
}

static void destroy(void* userdata, void* of) {
  (void)userdata;
  close_session(of);
  free(of);
}

static property_info property(int type, string_name* name) {
  return (property_info){type, name, &host.empty_name, 0, &host.empty, 6};
}

static void register_methods(void) {
  for (size_t i = 0; i < sizeof kMethods / sizeof kMethods[0]; ++i) {
    const method* const of = &kMethods[i];
    string_name name, names[3];
    property_info arguments[3];
    int metadata[3] = {0, 0, 0};
    const uint32_t count = argument_count(of);
    host.string_name_new(&name, of->name, 1);
    for (uint32_t k = 0; k < count; ++k) {
      host.string_name_new(&names[k], of->argument_names[k], 1);
      arguments[k] = property(of->arguments[k], &names[k]);
    }
    property_info result = property(of->result, &host.empty_name);
    const method_info info = {.name = &name, .userdata = (void*)of, .call = call, .ptrcall = ptrcall, .flags = 1,
                              .has_result = 1, .result = &result, .argument_count = count, .arguments = arguments,
                              .argument_metadata = metadata};
    host.register_method(host.library, &host.class_name, &info);
  }
}

static void initialize(void* userdata, int level) {
  (void)userdata;
  if (level != LEVEL_SCENE) return;
  host.string_name_new(&host.class_name, "PliantSession", 1);
  host.string_name_new(&host.parent_name, "RefCounted", 1);
  host.string_name_new(&host.empty_name, "", 1);
  host.string_new(&host.empty, "");
  const class_info info = {.is_exposed = 1, .create = create, .free = destroy};
  host.register_class(host.library, &host.class_name, &host.parent_name, &info);
  register_methods();
}

static void deinitialize(void* userdata, int level) {
  (void)userdata;
  if (level == LEVEL_SCENE) host.unregister_class(host.library, &host.class_name);
}

// Copies a function pointer of the host; 0: it has none of that name.
#define GET(field, name) (memcpy(&host.field, &(any_function){get(name)}, sizeof(any_function)), host.field != NULL)

__attribute__((visibility("default"))) uint8_t pliant_godot_init(get_function get, void* library,
                                                                 extension_initialization* out);
uint8_t pliant_godot_init(get_function get, void* library, extension_initialization* out) {
  host.library = library;
  any_function (*destructor)(int) = NULL;
  any_function (*builtin)(int, const void*, int64_t) = NULL;
  memcpy(&destructor, &(any_function){get("variant_get_ptr_destructor")}, sizeof destructor);
  memcpy(&builtin, &(any_function){get("variant_get_ptr_builtin_method")}, sizeof builtin);
  if (!destructor || !builtin || !GET(string_name_new, "string_name_new_with_latin1_chars") ||
      !GET(string_new, "string_new_with_utf8_chars") || !GET(string_to_utf8, "string_to_utf8_chars") ||
      !GET(variant_new_nil, "variant_new_nil") || !GET(packed_index, "packed_vector3_array_operator_index") ||
      !GET(register_class, "classdb_register_extension_class2") ||
      !GET(register_method, "classdb_register_extension_class_method") ||
      !GET(unregister_class, "classdb_unregister_extension_class") || !GET(construct, "classdb_construct_object") ||
      !GET(set_instance, "object_set_instance") || !GET(to_variant, "get_variant_from_type_constructor") ||
      !GET(from_variant, "get_variant_to_type_constructor"))
    return 0;
  string_name resize;
  host.string_name_new(&resize, "resize", 1);
  memcpy(&host.string_destroy, &(any_function){destructor(TYPE_STRING)}, sizeof(any_function));
  memcpy(&host.packed_destroy, &(any_function){destructor(TYPE_PACKED_VECTOR3_ARRAY)}, sizeof(any_function));
  memcpy(&host.packed_resize, &(any_function){builtin(TYPE_PACKED_VECTOR3_ARRAY, &resize, 848867239)}, sizeof(any_function));
  *out = (extension_initialization){LEVEL_SCENE, NULL, initialize, deinitialize};
  return host.string_destroy && host.packed_destroy && host.packed_resize;
}
