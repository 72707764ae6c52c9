/* The additive feedback generator of glibc's rand() (random_r.c, TYPE_3): r[i] = r[i-3] + r[i-31] of 32 bits, without the lowest. */
#include <stdint.h>

static uint32_t ring[31];
static int at = -1;

int glibc_rand(void);
void glibc_srand(unsigned seed);

void glibc_srand(unsigned seed) {
  int32_t word = seed ? (int32_t)seed : 1;
  for (int i = 0; i < 31; ++i) {
    ring[i] = (uint32_t)word;
    word = (int32_t)((16807 * (int64_t)word) % 2147483647); /* Schrage's form gives the same */
    if (word < 0) word += 2147483647;
  }
  at = 3;
  for (int i = 0; i < 310; ++i) glibc_rand();
}

int glibc_rand(void) {
  if (at < 0) glibc_srand(1);
  /* ring[at] is r[i - 31]; r[i - 3] stands 28 further. */
  const uint32_t next = ring[at] + ring[(at + 28) % 31];
  ring[at] = next;
  at = (at + 1) % 31;
  return (int)(next >> 1);
}
