// Schemes for a step of tissue, all on the engine's own assembly (systems/soft/fem/tissue.h), so that they differ by
// the scheme alone. Levels step as kEuler does where nothing is touched (engine_step.h); the others are here to be
// compared.
//
// Each is one implicit Euler stage, of length h [s] from a beginning (x0, v0):
//   Euler     h = T      from where the tissue is;
//   midpoint  h = T / 2  from where it is, then the same again without asking;
//   BDF2      h = 2 T/3  from (4 x_n - x_(n-1)) / 3 and (4 v_n - v_(n-1)) / 3.
// What the tissue meets pushes by a penalty, implicit in the stage, its normal as it was when linearised.
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

// What the tissue meets: a ball whose middle goes by the time, or ground below a height.
struct Ball {
  double radius = 0.0;                       // [m]
  std::function<dvec3(double time)> middle;  // [m] at a time [s]
};
struct Ground {
  double height = 0.0;  // [m]
};
using Obstacle = std::variant<std::monostate, Ball, Ground>;

// How deep a place [m] is in an obstacle at a time [s], and which way out.
struct Penetration {
  double depth = 0.0;  // [m] > 0
  dvec3 out{0};        // [1]
};
std::optional<Penetration> penetration(const Obstacle& obstacle, dvec3 place, double time);

struct TissueScene {
  std::string name;
  TetMesh mesh;  // the free nodes first, then the pinned
  TissueMaterial material;
  dvec3 gravity{0};   // [m/s2]
  dvec3 velocity{0};  // [m/s] of the free nodes when it begins
  Obstacle obstacle;
  double stiffness = 500.0;  // [N/m] of the penalty, a node
  double seconds = 0.4;
};

class TissueRun {
 public:
  // The scene must outlive it.
  TissueRun(const TissueScene& scene, StepScheme scheme);
  bool step(double T);  // false: not to be solved
  const std::vector<dvec3>& position() const { return tissue_.position(); }

 private:
  bool stage(double h, Vector& velocity);
  void push(double h, const std::vector<dvec3>& begin, bool first, Vector& right);

  const TissueScene& scene_;
  StepScheme scheme_;
  Tissue tissue_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<dvec3> x_before_, v_before_;  // of BDF2; empty: none yet
  double time_ = 0.0;
};

}  // namespace pliant
