// Registered spring laws, shapes and linear solvers (pliant/surface_law.h, pliant/linear_solver.h). They use the values
// after the last enumerator of their kind. Reading takes no lock: an entry never changes once it exists.
#pragma once

#include "pliant/linear_solver.h"
#include "pliant/surface_law.h"

namespace pliant {

inline constexpr SpringLaw kLastSpring = SpringLaw::kStandardLinearSolid;
inline constexpr Shape kLastShape = Shape::kKelvinlet;
inline constexpr SolverKind kLastSolver = SolverKind::kDense;

// nullptr for built-in ones and for unused values.
const SpringFunction* registered_spring(SpringLaw law);
const ShapeFunction* registered_shape(Shape shape);
const SolverFactory* registered_solver(SolverKind kind);
const char* registered_word(SpringLaw law);
const char* registered_word(Shape shape);
const char* registered_word(SolverKind kind);

// The word for each in level files, registered ones included; nullptr past the last. A new enumerator without a word
// does not compile (-Wswitch).
inline const char* word_of(SpringLaw law) {
  switch (law) {
    case SpringLaw::kLinear:
      return "linear";
    case SpringLaw::kCubic:
      return "cubic";
    case SpringLaw::kExponential:
      return "exponential";
    case SpringLaw::kStandardLinearSolid:
      return "sls";
  }
  return registered_word(law);
}

inline const char* word_of(Shape shape) {
  switch (shape) {
    case Shape::kPunch:
      return "punch";
    case Shape::kHertz:
      return "hertz";
    case Shape::kGaussian:
      return "gaussian";
    case Shape::kWendland:
      return "wendland";
    case Shape::kVolume:
      return "volume";
    case Shape::kKelvinlet:
      return "kelvinlet";
  }
  return registered_word(shape);
}

inline const char* word_of(SolverKind kind) {
  switch (kind) {
    case SolverKind::kAuto:
      return "auto";
    case SolverKind::kBlockCholesky:
      return "block_cholesky";
    case SolverKind::kEigenCholesky:
      return "eigen_cholesky";
    case SolverKind::kCholmod:
      return "cholmod";
    case SolverKind::kConjugateGradient:
      return "conjugate_gradient";
    case SolverKind::kDense:
      return "dense";
  }
  return registered_word(kind);
}

}  // namespace pliant
