#!/usr/bin/env bash
# The C# declarations and the Unity component, compiled by Mono and run against a host that stands for Unity.
# Usage: unity.sh SOURCES LIBRARY
set -euo pipefail
source=$1 library=$2
command -v mcs >/dev/null && command -v mono >/dev/null || { echo "skipped: Mono is not installed (mono-mcs, mono-runtime)"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mcs -warnaserror -nowarn:649 -out:"$work/press.exe" "$source"/bindings/unity/*.cs "$source"/tests/c/unity/FakeUnity.cs
ln -s "$library" "$work/libpliant.so"
LD_LIBRARY_PATH=$work mono "$work/press.exe" "$source/content/levels" minimal.gltf
