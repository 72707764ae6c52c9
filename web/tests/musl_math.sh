#!/usr/bin/env bash
# musl_math.sh LIBRARY OUT: every function of glibc's libm that LIBRARY calls, natively compiled from the source that the
# module has it from, emscripten's musl. Loaded by LD_PRELOAD, it leaves forces.mjs one difference less: that of libm.
set -euo pipefail
library=$(realpath "$1") out=$(realpath -m "$2")
cd /usr/share/emscripten/system/lib/libc/musl/src/math
# Of which others are made: helpers, tables, and what those call.
sources=$(ls __*.c *_data.c | grep -v 'l\.c$')
sources+=$'\n'$(printf '%s.c\n' atan atanf exp expm1 lgamma_r log signgam)
for name in $(nm -D --undefined-only "$library" | sed -nE 's/^ +U ([a-z0-9]+)@GLIBC_.*/\1/p'); do
  [[ ! -e $name.c ]] || sources+=$'\n'$name.c
done
headers=$(mktemp -d)
trap 'rm -rf "$headers"' EXIT
cp ../internal/libm.h "$headers"
touch "$headers/fp_arch.h"
# musl's own names, and those of __sin, __cos and __tan, which glibc's <math.h> has too.
cat >"$headers/musl.h" <<'TEXT'
#define _GNU_SOURCE
#include <math.h>
#define hidden __attribute__((visibility("hidden")))
#define weak_alias(old, new)
#define predict_true(x) __builtin_expect(!!(x), 1)
#define predict_false(x) __builtin_expect(x, 0)
#define __sin musl_sin
#define __cos musl_cos
#define __tan musl_tan
#define __sinl musl_sinl
#define __cosl musl_cosl
#define __tanl musl_tanl
TEXT
cc -O2 -fPIC -shared -ffp-contract=off -fno-builtin -w -include "$headers/musl.h" -I"$headers" -I. \
  $(sort -u <<<"$sources") -Wl,--no-undefined -lm -o "$out"
