#!/usr/bin/env bash
# The Unreal module compiles against types that stand for Unreal's. Usage: unreal.sh SOURCES CXX
set -euo pipefail
source=$1 cxx=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/Components" "$work/GameFramework" "$work/Modules"
for header in Components/SceneComponent.h CoreMinimal.h PliantComponent.generated.h GameFramework/Actor.h ProceduralMeshComponent.h \
    Modules/ModuleManager.h; do
  echo '#include "FakeUnreal.h"' >"$work/$header"
done
for file in "$source"/bindings/unreal/Pliant/Source/PliantUnreal/*.cpp; do
  "$cxx" -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I"$work" -I"$source/tests/c/unreal" -I"$source/include" "$file"
done
