/* rand() and srand() of glibc instead of musl's, by -include: METIS orders a factor by them. */
#include <stdlib.h>
int glibc_rand(void);
void glibc_srand(unsigned seed);
#define rand glibc_rand
#define srand glibc_srand
