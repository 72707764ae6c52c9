#!/usr/bin/env python3
"""Calls every function of libpliant.so wrongly: it must say what is wrong, and not crash. And a session by ctypes.
Usage: every_function.py SOURCES LIBRARY LEVEL"""
import ctypes as c
import os
import sys
import threading

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(sys.argv[1], "bindings"))
from header import Header

header = Header(os.path.join(sys.argv[1], "include/pliant.h"))
library = c.CDLL(sys.argv[2])
PLAIN = {"int32_t": c.c_int32, "uint32_t": c.c_uint32, "uint64_t": c.c_uint64, "size_t": c.c_size_t,
         "double": c.c_double, "float": c.c_float, "uint8_t": c.c_uint8, "pliant_status": c.c_int32}
CALLBACKS = {name for name, _, _ in header.callbacks}
structs = {}


def ctype(kind):
    if kind == "const char*":
        return c.c_char_p
    if "*" in kind or kind == "function" or kind in CALLBACKS:
        return c.c_void_p
    return structs[kind] if kind in structs else PLAIN[kind]


for name, fields in header.structs:
    structs[name] = type(name, (c.Structure,), {"_fields_": [(field, ctype(kind)) for kind, field in fields]})
for name, result, arguments in header.functions:
    function = getattr(library, name)
    function.argtypes = [ctype(kind) for kind, _ in arguments]
    function.restype = None if result == "void" else ctype(result)

message = lambda: library.pliant_error_message().decode()
code = lambda: library.pliant_error_code().decode()


def done(status):
    assert status == 0, message()


scene, session = c.c_void_p(), c.c_void_p()
done(library.pliant_scene_load(sys.argv[3].encode(), None, c.byref(scene)))
done(library.pliant_session_open(scene, None, None, c.byref(session)))

# Each argument in turn is NULL, a stranger's pointer or NaN, the others are as good as they can be had.
SKIP = {"pliant_make_devices_safe", "pliant_make_devices_safe_on_signals", "pliant_version", "pliant_abi_version",
        "pliant_error_message", "pliant_error_code", "pliant_register_all_drivers"}
OPTIONAL = {"log", "user", "options", "progress", "at", "query", "b", "lost", "changed", "changed_count", "felt", "rows"}
ends = [name for name, _, _ in header.functions if name.endswith("_destroy")]
room = (c.c_uint8 * 65536)()
calls = wrong = 0


def good(kind, name):
    base = kind.replace("const ", "").replace("*", "").strip()
    if kind == "pliant_scene*":
        return scene
    if kind == "pliant_session*":
        return session
    if kind == "pliant_pictures*":
        return None
    if kind in CALLBACKS:
        return None
    if kind == "const char*":
        return b"none such"
    if "*" in kind:
        if base in structs and structs[base]._fields_[0][0] == "size":
            value = structs[base]()
            value.size = c.sizeof(value)
            kept.append(value)
            return c.addressof(value)
        return c.addressof(room)
    return structs[base]() if base in structs else 0


for name, _, arguments in header.functions:
    if name in SKIP or name in ends:
        continue
    for bad, (kind, argument) in enumerate(arguments):
        if "*" not in kind:
            continue
        strangers = [None]
        if kind in ("pliant_scene*", "pliant_session*", "pliant_pictures*"):
            other = session if kind == "pliant_scene*" else scene
            strangers += [other, c.addressof(room), 0x2000000000ffff]
        for stranger in strangers:
            kept = []
            values = [good(k, n) for k, n in arguments]
            values[bad] = stranger
            status = getattr(library, name)(*values)
            calls += 1
            if argument in OPTIONAL or (argument == "out" and ("capacity" in [n for _, n in arguments])):
                continue
            assert status != 0, f"{name}: {argument} = {stranger} was accepted"
            assert message() and "  " not in message(), f"{name}: {message()!r}"
            wrong += status == 2
    # Structs of another size.
    for bad, (kind, argument) in enumerate(arguments):
        base = kind.replace("const ", "").replace("*", "").strip()
        if kind.count("*") == 1 and base in structs and structs[base]._fields_[0][0] == "size":
            for size in (0, 3, 0xffffffff):
                kept = []
                values = [good(k, n) for k, n in arguments]
                other = structs[base]()
                other.size = size
                values[bad] = c.addressof(other)
                for i, (_, n) in enumerate(arguments):
                    if n == "capacity":
                        values[i] = 1
                status = getattr(library, name)(*values)
                assert status != 0, f"{name}: a {base} of size {size} was accepted"
print(f"{calls} wrong calls, {wrong} found at the border")

# NaN everywhere it can be put.
Pose, Vec3, Wrench = structs["pliant_pose"], structs["pliant_vec3"], structs["pliant_wrench"]
nan = float("nan")
effector, obj = c.c_char_p(), c.c_char_p()
done(library.pliant_session_effector(session, 0, c.byref(effector)))
done(library.pliant_session_object(session, 0, c.byref(obj)))
hit = structs["pliant_hit"](c.sizeof(structs["pliant_hit"]))
pose = Pose(Vec3(nan, 0, 0))
wrench = Wrench(Vec3(0, nan, 0))
for status in (library.pliant_session_move(session, effector, pose),
               library.pliant_session_set(session, obj, b"stiffness", nan),
               library.pliant_session_set_hand_force(session, effector, wrench),
               library.pliant_session_set_body_force(session, obj, wrench),
               library.pliant_session_push(session, obj, wrench),
               library.pliant_session_place(session, obj, pose),
               library.pliant_set_limit_factor(nan),
               library.pliant_session_closest_point(session, Vec3(nan, 0, 0), None, c.byref(hit)),
               library.pliant_session_ray(session, Vec3(0, 0, 0), Vec3(nan, 0, 0), None, c.byref(hit))):
    assert status != 0, "NaN was accepted"

# The stranger's order of calls.
assert library.pliant_scene_load(b"none.glb", None, c.byref(c.c_void_p())) == 1 and "none.glb" in message()
assert library.pliant_session_move(session, b"figner", Pose()) == 1 and effector.value.decode() in message(), message()
done(library.pliant_session_move(session, effector, Pose()))
done(library.pliant_session_start(session))
assert library.pliant_session_step(session, 1) == 1, "a step while the clocks run"
done(library.pliant_session_emergency_stop(session))
done(library.pliant_session_stop(session))
done(library.pliant_session_restart(session))

# A session on this thread, seen busy from another.
busy = threading.Event()
inside = []
Progress = c.CFUNCTYPE(c.c_int32, c.c_void_p, c.c_double, c.c_char_p)


def look(user, share, doing):
    if not inside:
        inside.append((library.pliant_scene_set(scene, b"a.b.c=1"), code()))
    return 0


third = c.c_void_p()
done(library.pliant_scene_destroy(scene))  # with what the wrong calls added
done(library.pliant_scene_load(sys.argv[3].encode(), None, c.byref(scene)))
done(library.pliant_session_open(scene, c.cast(Progress(look), c.c_void_p), None, c.byref(third)))
assert inside == [(2, "call.busy")], inside
stops = Progress(lambda user, share, doing: 1)
assert library.pliant_session_open(scene, c.cast(stops, c.c_void_p), None, c.byref(c.c_void_p())) == 1
for handle, destroy in ((third, "session"), (session, "session"), (scene, "scene")):
    function = getattr(library, f"pliant_{destroy}_destroy")
    done(function(handle))
    assert function(handle) == 2 and code() == "call.handle"
    assert function(None) == 0
