// Spring laws, shapes and linear solvers: those that ship (built_in.h), then those that a program registers
// (pliant/surface_law.h, pliant/linear_solver.h). Reading takes no lock: an entry never changes once it exists.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>

#include "components/built_in.h"
#include "pliant/linear_solver.h"
#include "pliant/surface_law.h"

namespace pliant {

// How the free surface moves under a law (methods.md 1.2).
enum class SpringStep : std::uint8_t {
  kExact,      // linear: exact for a constant force
  kArm,        // linear with a Maxwell arm: exact, with a memory per vertex
  kPassive,    // any other: discrete gradient, or backward Euler
  kPassiveArm  // the same beside a Maxwell arm that stretches by the law's force: quasi-linear viscoelasticity
};
struct SpringRow {
  const char* word;
  SpringStep step;
  const char* reads;  // keys, separated by spaces
};

// The number that FieldSource::parameter carries for a shape.
enum class ShapeParameter : std::uint8_t {
  kNone,           // not read
  kContactShare,   // [1] (contact radius / reach)^2
  kContactLength,  // [m] contact radius
  kVolume          // [1] coefficient that conserves volume on the mesh
};
struct ShapeRow {
  const char* word;
  ShapeParameter parameter;
  double ns;                       // [ns] per vertex
  std::array<double, 6> kernel{};  // weight, inner, outer; their changes with `volume`; 0: none
};

enum class SolverCost : std::uint8_t { kBest, kDirect, kIterative, kDense };
struct SolverRow {
  const char* word;
  SolverCost cost;
  double factorisation, column;
};

#define PLIANT_ROW(word, arithmetic, step, reads) SpringRow{#word, SpringStep::step, reads},
inline constexpr SpringRow kSpringRows[] = {PLIANT_SPRING_LAWS(PLIANT_ROW)};
#undef PLIANT_ROW
#define PLIANT_ROW(word, form, parameter, ns, ...) ShapeRow{#word, ShapeParameter::parameter, ns, {__VA_ARGS__}},
inline constexpr ShapeRow kShapeRows[] = {PLIANT_SHAPES(PLIANT_ROW)};
#undef PLIANT_ROW
#define PLIANT_ROW(word, cost, factorisation, column) SolverRow{#word, SolverCost::cost, factorisation, column},
inline constexpr SolverRow kSolverRows[] = {PLIANT_SOLVERS(PLIANT_ROW)};
#undef PLIANT_ROW

// nullptr for those that ship and for unused values.
const SpringFunction* registered_spring(SpringLaw law);
const ShapeFunction* registered_shape(Shape shape);
const SolverFactory* registered_solver(SolverKind kind);
const char* registered_word(SpringLaw law);
const char* registered_word(Shape shape);
const char* registered_word(SolverKind kind);

// Its row. A registered one has the row of its kind: it may read any constant, and is stepped passively.
inline constexpr SpringRow kRegisteredSpring{"", SpringStep::kPassive, "cubic stiffening"};
inline constexpr ShapeRow kRegisteredShape{"", ShapeParameter::kNone, 20.0};
inline constexpr SolverRow kRegisteredSolver{"", SolverCost::kDirect, 1.0, 1.0};
constexpr const SpringRow& row_of(SpringLaw law) {
  const auto place = static_cast<std::size_t>(law);
  return place < std::size(kSpringRows) ? kSpringRows[place] : kRegisteredSpring;
}
constexpr const ShapeRow& row_of(Shape shape) {
  const auto place = static_cast<std::size_t>(shape);
  return place < std::size(kShapeRows) ? kShapeRows[place] : kRegisteredShape;
}
constexpr const SolverRow& row_of(SolverKind kind) {
  const auto place = static_cast<std::size_t>(kind);
  return place < std::size(kSolverRows) ? kSolverRows[place] : kRegisteredSolver;
}

// The word for each in level files, registered ones included; nullptr past the last.
inline const char* word_of(SpringLaw law) {
  const char* const word = row_of(law).word;
  return *word ? word : registered_word(law);
}
inline const char* word_of(Shape shape) {
  const char* const word = row_of(shape).word;
  return *word ? word : registered_word(shape);
}
inline const char* word_of(SolverKind kind) {
  const char* const word = row_of(kind).word;
  return *word ? word : registered_word(kind);
}

// Whether a law reads this key of PLIANT_deformable.
bool reads_key(SpringLaw law, const char* key);

}  // namespace pliant
