// The spring laws, shapes and linear solvers that ship: one line each, in the order of their enumerators
// (pliant/parameters.h). A line after the last enumerator needs none: its word in a level file is enough.
#pragma once

// LAW(word, arithmetic, step, reads): functions in shaders/shared/law.glsl.
//   word        name in level files
//   arithmetic  its functions are <arithmetic>_force, _slope, _potential, _keep and _between
//   step        SpringStep of the free surface
//   reads       keys of PLIANT_deformable that only some laws read
#define PLIANT_SPRING_LAWS(LAW)                                                                     \
  LAW(linear, linear, kExact, "")                                                                   \
  LAW(cubic, cubic, kPassive, "cubic")                                                              \
  LAW(exponential, exponential, kPassive, "stiffening")                                             \
  LAW(sls, linear, kArm, "relaxation.stiffness relaxation.time")                                    \
  LAW(table, table, kPassive, "table")                                                              \
  LAW(qlv_cubic, cubic, kPassiveArm, "cubic relaxation.stiffness relaxation.time")                  \
  LAW(qlv_exponential, exponential, kPassiveArm, "stiffening relaxation.stiffness relaxation.time") \
  LAW(qlv_table, table, kPassiveArm, "table relaxation.stiffness relaxation.time")

// SHAPE(word, form, parameter, cost, kernel...): functions in shaders/shared/shape.glsl and field.glsl.
//   form       radial: shape_<word>(u, parameter) gives value and slope; whole: field_<word> gives the target itself
//   parameter  ShapeParameter: the number that FieldSource carries
//   cost       [ns] per vertex, measured once (bench/results/studies/shapes.csv)
//   kernel     ShareKernel in units of the reach: weight, inner, outer, and their changes with `volume`; none: fitted
//              when the surface is prepared. Minimax fits; largest errors as a share of the depth: punch 0.18 (no
//              positive definite function has a flat bottom), hertz 0.053, gaussian 0.019, wendland 0, volume 0.059
//              without a rim to 0.10, kelvinlet 0.029.
#define PLIANT_SHAPES(SHAPE)                                              \
  SHAPE(punch, radial, kContactShare, 2.6, 0.2, 1.0, 1.3)                 \
  SHAPE(hertz, radial, kContactShare, 3.1, 0.7, 0.55, 1.45)               \
  SHAPE(gaussian, radial, kNone, 2.3, 0.15, 0.8, 0.9)                     \
  SHAPE(wendland, radial, kNone, 1.0, 1.0, 1.0, 1.0)                      \
  SHAPE(volume, radial, kVolume, 2.1, 0.05, 0.9, 1.4, 0.75, -0.15, -0.55) \
  SHAPE(kelvinlet, whole, kContactLength, 2.9, 0.5, 0.4, 1.4)

// SOLVER(word, cost, factorisation, column): make_<word> in the solver's own file (systems/soft/linear).
//   cost                   SolverCost, as engine/choice counts it
//   factorisation, column  [1] factors on the times of block_cholesky, of a direct solver
#define PLIANT_SOLVERS(SOLVER)                 \
  SOLVER(auto, kBest, 1.0, 1.0)                \
  SOLVER(block_cholesky, kDirect, 1.0, 1.0)    \
  SOLVER(eigen_cholesky, kDirect, 3.0, 2.0)    \
  SOLVER(cholmod, kDirect, 3.5, 3.5)           \
  SOLVER(conjugate_gradient, kIterative, 1, 1) \
  SOLVER(dense, kDense, 1.0, 1.0)
