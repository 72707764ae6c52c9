// As much of Godot as the extension uses, and a script that presses a level through it.
// Usage: host EXTENSION LEVEL
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../../bindings/godot/gdextension.h"

typedef struct packed {
  float* data;
  int64_t count;
} packed;
typedef struct variant {
  int type;
  union {
    uint8_t boolean;
    int64_t integer;
    double real;
    char* text;
    float vector[3];
    packed array;
  } of;
} variant;

static class_info registered;
static method_info methods[32];
static char* method_names[32];
static int method_count = 0, strings = 0, arrays = 0;  // alive
static void* made;

static char* copy(const char* text) {
  return strcpy(malloc(strlen(text) + 1), text);
}
static void name_new(void* to, const char* text, uint8_t is_static) {
  (void)is_static;
  *(const char**)to = text;
}
static void string_new(void* to, const char* text) {
  ++strings;
  *(char**)to = copy(text);
}
static void string_destroy(void* of) {
  char** const text = of;
  if (*text) --strings;
  free(*text);
  *text = NULL;
}
static int64_t string_to_utf8(const void* from, char* to, int64_t room) {
  const char* const text = *(char* const*)from;
  const size_t length = text ? strlen(text) : 0;
  memcpy(to, text ? text : "", length < (size_t)room ? length : (size_t)room);
  return (int64_t)length;
}
static void packed_resize(void* of, const void* const* arguments, void* result, int count) {
  packed* const array = of;
  if (!array->data) ++arrays;
  array->count = *(const int64_t*)arguments[0];
  array->data = realloc(array->data, 12 * (size_t)array->count);
  *(int64_t*)result = count - 1;
}
static void packed_destroy(void* of) {
  packed* const array = of;
  if (array->data) --arrays;
  free(array->data);
  memset(array, 0, sizeof *array);
}
static void* packed_index(void* of, int64_t index) {
  return ((packed*)of)->data + 3 * index;
}
static void nil(void* to) {
  memset(to, 0, sizeof(variant));
}
#define TO_VARIANT(name, kind, field)                      \
  static void name(void* to, void* from) {                 \
    ((variant*)to)->type = kind;                           \
    memcpy(&((variant*)to)->of, from, sizeof(field));      \
  }
TO_VARIANT(to_bool, TYPE_BOOL, uint8_t)
TO_VARIANT(to_vector, TYPE_VECTOR3, float[3])
static void to_string(void* to, void* from) {
  ((variant*)to)->type = TYPE_STRING;
  string_new(&((variant*)to)->of.text, *(char**)from);
}
static void to_array(void* to, void* from) {
  const packed* const array = from;
  packed* const mine = &((variant*)to)->of.array;
  ((variant*)to)->type = TYPE_PACKED_VECTOR3_ARRAY;
  memset(mine, 0, sizeof *mine);
  if (array->count == 0) return;
  int64_t ignored;
  const void* const arguments[] = {&array->count};
  packed_resize(mine, arguments, &ignored, 1);
  memcpy(mine->data, array->data, 12 * (size_t)array->count);
}
static any_function to_variant(int type) {
  return (any_function)(type == TYPE_BOOL      ? to_bool
                        : type == TYPE_VECTOR3 ? to_vector
                        : type == TYPE_STRING  ? to_string
                                               : to_array);
}
static void from_plain(void* to, void* from) {
  memcpy(to, &((variant*)from)->of, 12);
}
static void from_string(void* to, void* from) {
  string_new(to, ((variant*)from)->of.text);
}
static any_function from_variant(int type) {
  return (any_function)(type == TYPE_STRING ? from_string : from_plain);
}
static any_function destructor(int type) {
  return (any_function)(type == TYPE_STRING ? string_destroy : packed_destroy);
}
static any_function builtin(int type, const void* name, int64_t hash) {
  (void)hash;
  return type == TYPE_PACKED_VECTOR3_ARRAY && strcmp(*(const char* const*)name, "resize") == 0 ? (any_function)packed_resize : NULL;
}
static void register_class(void* library, const void* name, const void* parent, const class_info* info) {
  (void)library;
  if (strcmp(*(const char* const*)name, "PliantSession") == 0 && strcmp(*(const char* const*)parent, "RefCounted") == 0) registered = *info;
}
static void register_method(void* library, const void* name, const method_info* info) {
  (void)library;
  (void)name;
  method_names[method_count] = copy(*(char**)info->name);
  methods[method_count++] = *info;
}
static void unregister_class(void* library, const void* name) {
  (void)library;
  (void)name;
}
static void* construct(const void* name) {
  (void)name;
  return &made;
}
static void set_instance(void* object, const void* name, void* instance) {
  (void)name;
  *(void**)object = instance;
}

static any_function get(const char* name) {
  static const struct {
    const char* name;
    any_function function;
  } known[] = {{"string_name_new_with_latin1_chars", (any_function)name_new},
               {"string_new_with_utf8_chars", (any_function)string_new},
               {"string_to_utf8_chars", (any_function)string_to_utf8},
               {"variant_new_nil", (any_function)nil},
               {"packed_vector3_array_operator_index", (any_function)packed_index},
               {"classdb_register_extension_class2", (any_function)register_class},
               {"classdb_register_extension_class_method", (any_function)register_method},
               {"classdb_unregister_extension_class", (any_function)unregister_class},
               {"classdb_construct_object", (any_function)construct},
               {"object_set_instance", (any_function)set_instance},
               {"get_variant_from_type_constructor", (any_function)to_variant},
               {"get_variant_to_type_constructor", (any_function)from_variant},
               {"variant_get_ptr_destructor", (any_function)destructor},
               {"variant_get_ptr_builtin_method", (any_function)builtin}};
  for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
    if (strcmp(known[i].name, name) == 0) return known[i].function;
  return NULL;
}

static variant text(const char* of) {
  variant made_of = {.type = TYPE_STRING};
  string_new(&made_of.of.text, of);
  return made_of;
}

// As a script calls it: by variants, which it frees.
static variant call(const char* name, int count, variant a, variant b) {
  variant result;
  const void* const arguments[] = {&a, &b};
  call_error error = {-1, 0, 0};
  for (int i = 0; i < method_count; ++i)
    if (strcmp(method_names[i], name) == 0) methods[i].call(methods[i].userdata, made, arguments, count, &result, &error);
  if (error.error != 0) fprintf(stderr, "%s: error %d\n", name, error.error), exit(1);
  if (a.type == TYPE_STRING) string_destroy(&a.of.text);
  if (b.type == TYPE_STRING) string_destroy(&b.of.text);
  return result;
}

static void expect(int condition, const char* of) {
  if (!condition) fprintf(stderr, "failed: %s\n", of), exit(1);
}

int main(int argc, char** argv) {
  const variant none = {.type = TYPE_NIL};
  void* const library = argc == 3 ? dlopen(argv[1], RTLD_NOW) : NULL;
  if (!library) return fprintf(stderr, "%s\n", dlerror()), 1;
  uint8_t (*init)(get_function, void*, extension_initialization*);
  *(void**)&init = dlsym(library, "pliant_godot_init");
  extension_initialization out;
  expect(init && init(get, &made, &out), "the entry");
  for (int level = 0; level <= 3; ++level) out.initialize(out.userdata, level);
  expect(registered.create && method_count == 11, "the class");
  const int strings_before = strings;
  registered.create(registered.userdata);

  expect(!call("open", 1, text("none.glb"), none).of.boolean, "a level that is not there");
  variant said = call("error", 0, none, none);
  expect(strstr(said.of.text, "none.glb") != NULL, said.of.text);
  string_destroy(&said.of.text);
  expect(!call("step", 1, (variant){.type = TYPE_INT, .of.integer = 1}, none).of.boolean, "a step without a level");
  if (!call("open", 1, text(argv[2]), none).of.boolean) return fprintf(stderr, "%s\n", call("error", 0, none, none).of.text), 1;

  variant rest = call("vertices", 1, text("sheet"), none);
  expect(rest.of.array.count > 3, "the vertices");
  float top = -1.0f;
  for (int64_t i = 0; i < rest.of.array.count; ++i) top = fmaxf(top, rest.of.array.data[3 * i + 1]);
  variant force = none;
  for (int i = 0; i <= 300; ++i) {
    const variant at = {.type = TYPE_VECTOR3, .of.vector = {0, top + 0.001f - 1e-5f * (float)i, 0}};
    expect(call("move", 2, text("tip"), at).of.boolean, "move");
    expect(call("step", 1, (variant){.type = TYPE_INT, .of.integer = 1}, none).of.boolean, "step");
  }
  force = call("force", 1, text("tip"), none);
  expect(force.of.vector[1] > 0.1f, "the force");
  packed_destroy(&rest.of.array);
  registered.free(registered.userdata, made);
  expect(strings == strings_before && arrays == 0, "a string or an array was not freed");
  out.deinitialize(out.userdata, LEVEL_SCENE);
  printf("the force was %.3f N\n", force.of.vector[1]);
  return 0;
}
