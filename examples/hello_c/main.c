// Loads a level, presses its first probe onto it, and prints the force on the hand: the C interface alone.
// Usage: hello_c LEVEL.glb
#include <pliant.h>
#include <stdio.h>

static int fail(void) {
  return fprintf(stderr, "%s\n", pliant_error_message()), 1;
}

int main(int argc, char** argv) {
  if (argc < 2) return fprintf(stderr, "usage: %s LEVEL.glb\n", argv[0]), 2;
  pliant_scene* scene;
  pliant_session* session;
  if (pliant_scene_load(argv[1], NULL, &scene) || pliant_session_open(scene, NULL, NULL, &session)) return fail();
  const char* probe;
  pliant_vec3 low, high;
  if (pliant_session_effector(session, 0, &probe) || pliant_session_bounds(session, NULL, &low, &high)) return fail();

  pliant_reading reading = {.size = sizeof reading};
  for (int i = 0; i <= 600; ++i) {  // from 1 mm above the top, 10 um a tick
    const pliant_pose pose = {{0.5 * (low.x + high.x), high.y + 0.001 - 1e-5 * i, 0.5 * (low.z + high.z)}, {0, 0, 0, 1}};
    if (pliant_session_move(session, probe, pose) || pliant_session_step(session, 1) ||
        pliant_session_reading(session, probe, &reading))
      return fail();
    if (i % 100 == 0) printf("%.3f s  depth %5.2f mm  force %.3f N\n", reading.time, 1e3 * reading.depth, reading.force.y);
  }
  pliant_session_destroy(session);
  pliant_scene_destroy(scene);
  return 0;
}
