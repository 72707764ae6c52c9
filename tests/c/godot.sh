#!/usr/bin/env bash
# The extension for Godot, compiled and run in a host that stands for it. Usage: godot.sh SOURCES LIBRARY CC
set -euo pipefail
source=$1 library=$2 cc=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cc" -std=c11 -Wall -Wextra -Werror -pedantic -fPIC -shared -fvisibility=hidden -I"$source/include" \
  "$source/bindings/godot/pliant_godot.c" "$library" -Wl,-rpath,"$(dirname "$library")" -o "$work/libpliant_godot.so"
"$cc" -std=c11 -g -Wall -Wextra -Werror "$source/tests/c/godot/host.c" -lm -o "$work/host"
"$work/host" "$work/libpliant_godot.so" "$source/content/levels/minimal.gltf"
