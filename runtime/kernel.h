// PLIANT_KERNEL before a function compiles it twice, for plain x86-64 and for AVX2; the loader chooses. Without
// contraction both give the same bits. Sanitizers do not work with this mechanism, so they get the plain version.
#pragma once

#if defined(__x86_64__) && !defined(PLIANT_SANITIZED) && !defined(__clang__)
#define PLIANT_KERNEL __attribute__((target_clones("avx2", "default")))
#else
#define PLIANT_KERNEL
#endif
