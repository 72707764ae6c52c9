// The list of studies. A study is one line here and one file: study_NAME.cpp defines `Status study_NAME(OutputFolder&
// out, StudySize size, const Interrupt& interrupt)`. It stages NAME.csv, NAME.json, NAME.svg and NAME.png in `out`,
// prints its conclusions, and ends with an error when `interrupt` is requested.
#pragma once

#include <cstdint>

#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "runtime/result.h"

// clang-format off
#define PLIANT_STUDIES(STUDY) \
  STUDY(linearisation, "1 kHz force of a tool: held, linear, contacts solved again, against the full solve") \
  STUDY(walls, "where a virtual wall is stable: stiffness, damping, delay; closed forms, with and without the guard") \
  STUDY(hand, "a simulated hand touches the demo levels through every device profile; with and without guard at 1 and 10 ms") \
  STUDY(integrators, "steps of one vertex: eight schemes, every spring law, dt 1e-5 to 1e-1 s: ns against error; stability") \
  STUDY(shapes, "the surface of a press by every shape, against closed forms and blocks of tetrahedra") \
  STUDY(hardcases, "where haptic engines break: what must hold there, the verdict and the figure") \
  STUDY(surfaces, "facets, force shading, curved patches against spheres, tori, saddles: ripple, direction, work, us") \
  STUDY(fidelity, "one indentation by P1, every shape and law, and by the FEM at four resolutions: force and surface") \
  STUDY(time_step, "the soft step: Euler, midpoint, BDF2 and their length against a converged motion, four scenes") \
  STUDY(large_strain, "a cube squashed, pulled and sheared, by law and resolution, against quadratic tetrahedra: force") \
  STUDY(collision, "local walks, the tree and brute force, on meshes up to two million triangles: us against misses") \
  STUDY(coupling, "tissue and handle: one implicit system or staggered, springs or slaved nodes: stability, cost") \
  STUDY(scale, "a tick, a frame and a soft step, by vertices, moving vertices, tetrahedra and contacts: fitted powers")
// clang-format on

namespace pliant {

// Full: within ten minutes on two cores. Quick: within one. Small: the minimum of every part, for tests.
enum class StudySize : std::uint8_t { kFull, kQuick, kSmall };

#define STUDY(name, what) Status study_##name(OutputFolder& out, StudySize size, const Interrupt& interrupt);
PLIANT_STUDIES(STUDY)
#undef STUDY

}  // namespace pliant
