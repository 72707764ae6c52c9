// The C program of the test: presses a level's first probe, by the C interface alone.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

// One tick's force [N], and the depth [m].
typedef struct felt_in_c {
  double x, y, z, depth;
} felt_in_c;

// Presses for `ticks` ticks along a path that starts at `y` [m]; `felt` has one entry per tick. 0: done; else a line is
// on stderr.
int press_in_c(const char* level, double y, int ticks, felt_in_c* felt);
// Calls in every part of the interface on a level with a body and a surface; the number of the first line that failed.
int use_all_in_c(const char* level);

#ifdef __cplusplus
}
#endif
