#!/usr/bin/env bash
# The binary interface of libpliant.so is the committed one, what is made from its header is as committed, and what its
# header and docs/embedding.md show compiles.
# Usage: abi.sh SOURCES LIBRARY CC [--write]
set -euo pipefail
source=$1 library=$2 cc=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1
make() { python3 "$source/bindings/generate.py" "$1" "$source/include/pliant.h"; }
make layout >"$work/layout.c"
"$cc" -std=c11 -Wall -Wextra -Werror -pedantic -I"$source/include" "$work/layout.c" -o "$work/layout"
{
  echo "# Binary interface of libpliant.so: exported symbols, prototypes, structs (offset, field, size), constants."
  echo "# A change of an existing line needs another PLIANT_ABI_VERSION. Written by tests/c/abi.sh ... --write."
  nm -D --defined-only "$library" | sed -nE 's/^[0-9a-f]+ ([A-Z]) (.*)$/symbol \1 \2/p' | LC_ALL=C sort
  make prototypes
  "$work/layout"
} >"$work/abi.txt"
make csharp >"$work/PliantNative.cs"
if [[ ${4:-} == --write ]]; then
  cp "$work/abi.txt" "$source/tests/c/abi.txt"
  cp "$work/PliantNative.cs" "$source/bindings/unity/PliantNative.cs"
fi
# Every exported function is declared, and the other way round.
diff <(sed -nE 's/^symbol T ([a-z_0-9]+)@.*$/\1/p' "$work/abi.txt" | sort) \
     <(make prototypes | sed -nE 's/^.* \**(pliant_[a-z_0-9]+)\(.*/\1/p' | grep -vxE 'pliant_(log_function|progress)' | sort) ||
  { echo "the header and the library have different functions"; exit 1; }
diff "$source/tests/c/abi.txt" "$work/abi.txt" || { echo "the ABI changed (<: committed): see its first lines"; exit 1; }
diff "$source/bindings/unity/PliantNative.cs" "$work/PliantNative.cs" >/dev/null ||
  { echo "bindings/unity/PliantNative.cs is not what the header gives; run tests/c/abi.sh ... --write"; exit 1; }
# Each ```c block, and the program in the header's first comment, as the body of a function.
awk -v head='#include <pliant.h>\n#include <stdio.h>\n#include <stdlib.h>\nint more_pictures(void);' '
  BEGIN { print head }
  /^```c$/ { printf "int shown_%d(pliant_session* session, pliant_pose pose);\nint shown_%d(pliant_session* session, pliant_pose pose) {(void)pose;(void)session;{\n", ++n, n; inside = 1; next }
  /^```$/ { if (inside) print "}return 0;}"; inside = 0; next }
  inside' "$source/docs/embedding.md" >"$work/shown.c"
{
  echo 'int in_header(void);int in_header(void) {'
  sed -nE '/^#pragma/q; s|^//   (.*)|\1|p' "$source/include/pliant.h"
  echo 'return 0;}'
} >>"$work/shown.c"
[[ $(grep -c '^int shown' "$work/shown.c") -ge 4 ]] || { echo "docs/embedding.md shows no C"; exit 1; }
"$cc" -std=c11 -Wall -Wextra -Werror -pedantic -I"$source/include" -fsyntax-only "$work/shown.c"
