// Schemes for a step of tissue, all with the engine's assembly (systems/soft/fem/tissue.h), so that they differ by the
// scheme alone. Levels use kEuler without contact (engine_step.h); the others are for comparison.
//
// Each is one implicit Euler stage of length h [s] from a start (x0, v0):
//   Euler     h = T      from the current state;
//   midpoint  h = T / 2  from the current state, then extrapolated by the same step;
//   BDF2      h = 2 T/3  from (4 x_n - x_(n-1)) / 3 and (4 v_n - v_(n-1)) / 3.
// Obstacles push by a penalty, implicit in the stage, with the normal of the linearisation point.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

enum class StepScheme { kEuler, kMidpoint, kMidpointTwice, kBdf2, kConverged };
const char* name_of(StepScheme scheme);

// An obstacle: a ball whose centre moves over time, or ground below a height.
struct Ball {
  double radius = 0.0;                       // [m]
  std::function<dvec3(double time)> middle;  // [m] at a time [s]
};
struct Ground {
  double height = 0.0;  // [m]
};
using Obstacle = std::variant<std::monostate, Ball, Ground>;

// Penetration [m] of a point into an obstacle at a time [s], and the outward direction.
struct Penetration {
  double depth = 0.0;  // [m] > 0
  dvec3 out{0};        // [1]
};
std::optional<Penetration> penetration(const Obstacle& obstacle, dvec3 place, double time);

struct TissueScene {
  std::string name;
  TetMesh mesh;  // free nodes first, then pinned
  TissueMaterial material;
  dvec3 gravity{0};   // [m/s2]
  dvec3 velocity{0};  // [m/s] initial velocity of the free nodes
  Obstacle obstacle;
  double stiffness = 500.0;  // [N/m] of the penalty, per node
  double seconds = 0.4;
};

class TissueRun {
 public:
  // The scene must outlive the object.
  TissueRun(const TissueScene& scene, StepScheme scheme);
  bool step(double T);  // false: no solution
  const std::vector<dvec3>& position() const { return tissue_.position(); }

 private:
  bool stage(double h, Vector& velocity);
  void push(double h, const std::vector<dvec3>& begin, bool first, Vector& right);

  const TissueScene& scene_;
  StepScheme scheme_;
  Tissue tissue_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<dvec3> x_before_, v_before_;  // previous state for BDF2; empty in the first step
  double time_ = 0.0;
};

}  // namespace pliant
