// native_forces LEVEL TICKS OUT [PICTURE]: the readings of every effector and tick of a level in lockstep, by the native library,
// as bytes of pliant_reading, effector after effector; the median of a tick [us] and the CPU time of all [s] go to
// stdout. PICTURE gets the bytes of a picture after these ticks, of 320 x 180. forces.mjs and page.mjs compare.
#include <pliant.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int failed(const char* what) {
  fprintf(stderr, "native_forces: %s: %s\n", what, pliant_error_message());
  return 1;
}

enum { kWidth = 320, kHeight = 180, kRoom = 4 * kWidth * kHeight };

static int draw(pliant_pictures* pictures, const char* file) {
  static uint8_t rgba[kRoom];
  pliant_view view = {.size = sizeof view};
  if (pliant_pictures_view(pictures, &view) ||
      pliant_pictures_picture(pictures, &view, kWidth, kHeight, rgba, kRoom))
    return failed("picture");
  FILE* const out = fopen(file, "wb");
  return out && fwrite(rgba, 1, kRoom, out) == kRoom && fclose(out) == 0 ? 0 : 1;
}

int main(int count, char** words) {
  if (count != 4 && count != 5) return 2;
  const size_t ticks = (size_t)atol(words[2]);
  pliant_scene* scene;
  pliant_session* session;
  uint32_t effectors;
  if (pliant_scene_load(words[1], NULL, &scene) || pliant_session_open(scene, NULL, NULL, &session)) return failed(words[1]);
  pliant_pictures* pictures = NULL;
  if (count == 5 && pliant_pictures_headless(session, &pictures)) return failed("pictures");
  const clock_t begin = clock();
  if (pliant_session_keep_readings(session, ticks) || pliant_session_step(session, ticks)) return failed("ticks");
  const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
  if (pliant_session_effector_count(session, &effectors)) return failed("effectors");
  pliant_reading* const rows = calloc(ticks, sizeof *rows);
  FILE* const out = fopen(words[3], "wb");
  if (!rows || !out) return 1;
  for (uint32_t e = 0; e < effectors; ++e) {
    const char* name;
    size_t taken = 0;
    uint64_t lost = 0;
    memset(rows, 0, ticks * sizeof *rows);
    rows[0].size = sizeof *rows;
    if (pliant_session_effector(session, e, &name) ||
        pliant_session_take_readings(session, name, rows, ticks, &taken, &lost) || taken != ticks)
      return failed("readings");
    fwrite(rows, sizeof *rows, ticks, out);
  }
  pliant_figures figures = {.size = sizeof figures};
  if (pliant_session_figures(session, &figures)) return failed("figures");
  printf("%.3f %.3f\n", figures.p50_us, seconds);
  if (fclose(out)) return 1;
  return count == 5 ? draw(pictures, words[4]) : 0;
}
