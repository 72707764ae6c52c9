#!/usr/bin/env python3
"""Text made from include/pliant.h. Usage: generate.py csharp|javascript|layout|prototypes HEADER

csharp: declarations for C# (bindings/unity/PliantNative.cs). javascript: layouts and constants for web/pliant.js, of
a WebAssembly module. layout: a C program that prints the size and the offsets
of every struct. prototypes: the functions, one a line. The last two are the ABI (tests/c/abi.txt)."""
import sys

from header import Header

NULLABLE = {"options", "at", "query"}  # a struct that may be NULL: in C# an array of one, or null
PLAIN = {"int32_t": "int", "uint32_t": "uint", "uint64_t": "ulong", "size_t": "ulong", "double": "double",
         "float": "float", "uint8_t": "byte", "void": "void", "pliant_status": "int"}
KEYWORDS = {"out", "ref", "in", "object", "params", "event"}


def word(name):
    return "@" + name if name in KEYWORDS else name


def field_type(header, kind):
    if kind == "function" or "*" in kind or kind in {name for name, _, _ in header.callbacks}:
        return "IntPtr"
    return PLAIN.get(kind, kind)


def parameter(header, kind, name, following):
    """`following`: names of the next parameters, which say whether a pointer is to an array."""
    structs = dict(header.structs)
    base = kind.replace("const ", "").replace("*", "").strip()
    stars = kind.count("*")
    array = bool({"capacity", "count", "vertices", "byte_count", "room"} & set(following[:2])) or name == "poses"
    if stars == 0:
        return f"{PLAIN.get(base, base)} {word(name)}"
    if stars == 2:
        return f"out IntPtr {word(name)}"
    if base == "char":
        return f"[MarshalAs(UnmanagedType.LPUTF8Str)] string {word(name)}"
    if base in header.opaque or kind == "void*":
        return f"IntPtr {word(name)}"
    if kind.startswith("const"):
        if base == "void":
            return f"byte[] {word(name)}"
        if name in NULLABLE or array or base not in structs:
            return f"{PLAIN.get(base, base)}[] {word(name)}"
        return f"ref {base} {word(name)}"
    if (array and name in ("out", "felt", "rgba")) or base == "float":
        return f"[In, Out] {PLAIN.get(base, base)}[] {word(name)}"
    if base in structs and structs[base][0] == ("uint32_t", "size"):
        return f"ref {base} {word(name)}"
    return f"out {PLAIN.get(base, base)} {word(name)}"


def parameters(header, args):
    names = [name for _, name in args]
    return ", ".join(parameter(header, kind, name, names[i + 1:]) for i, (kind, name) in enumerate(args))


def csharp(header):
    lines = ["// Made from include/pliant.h by bindings/generate.py. Units, frames, lifetimes and threads: there.",
             "using System;", "using System.Runtime.InteropServices;", "", "namespace Pliant", "{"]
    for name, fields in header.structs:
        lines += ["    [StructLayout(LayoutKind.Sequential)]", f"    public struct {name}", "    {"]
        lines += [f"        public {field_type(header, kind)} {word(field)};" for kind, field in fields]
        lines += ["    }", ""]
    for name, result, args in header.callbacks:
        given = ", ".join(f"{'IntPtr' if '*' in kind else PLAIN[kind]} {word(arg)}" for kind, arg in args)
        lines += ["    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]",
                  f"    public delegate {PLAIN[result]} {name}({given});", ""]
    lines += ["    public static class Native", "    {", '        const string Library = "pliant";', ""]
    for name, value in header.constants:
        lines.append(f"        public const {'uint' if value.endswith('u') else 'int'} {name} = {value};")
    lines.append("")
    for name, result, args in header.functions:
        returned = "IntPtr" if "*" in result else PLAIN[result]
        lines += ["        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]",
                  f"        public static extern {returned} {name}({parameters(header, args)});"]
    return "\n".join(lines + ["    }", "}"])


WASM_BYTES = {"int32_t": 4, "uint32_t": 4, "uint64_t": 8, "size_t": 4, "double": 8, "float": 4}  # anything else: a pointer


def javascript(header):
    lines = ["// Made from include/pliant.h by bindings/generate.py.", "export const structs = {"]
    sizes = {kind: (size, size) for kind, size in WASM_BYTES.items()}
    for name, fields in header.structs:
        at, align, places = 0, 1, []
        for kind, field in fields:
            size, needs = sizes.get(kind, (4, 4))
            at = -(-at // needs) * needs
            shown = kind if kind in sizes else "text" if kind == "const char*" else "pointer"
            places.append(f"{field}: [{at}, '{shown}']")
            at, align = at + size, max(align, needs)
        sizes[name] = (-(-at // align) * align, align)
        lines.append(f"  {name}: {{bytes: {sizes[name][0]}, fields: {{{', '.join(places)}}}}},")
    lines += ["};", "export const constants = {"]
    lines += [f"  {name}: {value.rstrip('u')}," for name, value in header.constants]
    return "\n".join(lines + ["};"])


def layout(header):
    lines = ["#include <pliant.h>", "#include <stdio.h>", "int main(void) {"]
    for name, fields in header.structs:
        lines.append(f'  printf("struct {name} %zu\\n", sizeof({name}));')
        for _, field in fields:
            lines.append(f'  printf("  %zu {field} %zu\\n", offsetof({name}, {field}), sizeof((({name}*)0)->{field}));')
    lines += [f'  printf("constant {name} %lld\\n", (long long){name});' for name, _ in header.constants]
    return "\n".join(lines + ["  return 0;", "}"])


def prototypes(header):
    return "\n".join(f"{result} {name}({', '.join(kind for kind, _ in args)})"
                     for name, result, args in sorted(header.callbacks + header.functions))


if __name__ == "__main__":
    makers = {"csharp": csharp, "javascript": javascript, "layout": layout, "prototypes": prototypes}
    if len(sys.argv) != 3 or sys.argv[1] not in makers:
        sys.exit(__doc__)
    print(makers[sys.argv[1]](Header(sys.argv[2])))
