// The part of Godot's C interface for extensions (4.2 and later) that pliant_godot.c uses, under names of our own: the
// types of gdextension_interface.h, which `godot --dump-gdextension-interface` writes.
#pragma once

#include <stddef.h>
#include <stdint.h>

enum {
  TYPE_NIL = 0,
  TYPE_BOOL = 1,
  TYPE_INT = 2,
  TYPE_FLOAT = 3,
  TYPE_STRING = 4,
  TYPE_VECTOR3 = 9,
  TYPE_PACKED_VECTOR3_ARRAY = 36
};

typedef void (*any_function)(void);
typedef any_function (*get_function)(const char* name);

typedef struct call_error {
  int error;  // 0: none; 2: invalid argument; 3: too many; 4: too few
  int32_t argument, expected;
} call_error;

typedef struct property_info {
  int type;
  void *name, *class_name;  // StringName
  uint32_t hint;
  void* hint_string;  // String
  uint32_t usage;
} property_info;

typedef void (*method_call)(void* method, void* instance, const void* const* arguments, int64_t count, void* result,
                            call_error* error);
typedef void (*method_ptrcall)(void* method, void* instance, const void* const* arguments, void* result);

typedef struct method_info {
  void* name;  // StringName
  void* userdata;
  method_call call;
  method_ptrcall ptrcall;
  uint32_t flags;  // 1: normal
  uint8_t has_result;
  property_info* result;
  int result_metadata;
  uint32_t argument_count;
  property_info* arguments;
  int* argument_metadata;
  uint32_t default_count;
  void** defaults;
} method_info;

// GDExtensionClassCreationInfo2.
typedef struct class_info {
  uint8_t is_virtual, is_abstract, is_exposed;
  any_function set, get, get_property_list, free_property_list, property_can_revert, property_get_revert,
      validate_property, notification, to_string, reference, unreference;
  void* (*create)(void* userdata);
  void (*free)(void* userdata, void* instance);
  any_function recreate, get_virtual, get_virtual_data, call_virtual_with_data, get_rid;
  void* userdata;
} class_info;

enum { LEVEL_SCENE = 2 };
typedef struct extension_initialization {
  int minimum_level;
  void* userdata;
  void (*initialize)(void* userdata, int level);
  void (*deinitialize)(void* userdata, int level);
} extension_initialization;
