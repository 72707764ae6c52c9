// The study `coupling`: P2 section 5. Tissue and its handle in one implicit system, or one after the other (staggered),
// with the handle's nodes slaved to it or on springs (systems/soft/body/handle_tie.h). Small displacements of a bar.
#pragma once

#include <Eigen/Core>
#include <array>

namespace pliant {

enum class Coupled : std::uint8_t { kSlaved, kSprings, kStaggeredSlaved, kStaggeredSprings };
inline constexpr std::array kCoupledWays{Coupled::kSlaved, Coupled::kSprings, Coupled::kStaggeredSlaved,
                                         Coupled::kStaggeredSprings};
const char* name_of(Coupled way);

struct CouplingCase {
  double step = 1e-3;      // [s]
  double tie = 100.0;      // [1] stiffness of the springs, as kTieStiffness
  double heaviness = 1.0;  // [1] mass of the handle over that of the tissue that moves
};

// The bar: degrees of freedom of free nodes, then of the handle's, then of the handle.
class CoupledBar {
 public:
  explicit CoupledBar(int cells);  // along its length
  // Displacement of the handle's middle [m] after each of `steps` steps from a push across the free end. Empty:
  // unstable.
  std::vector<double> swing(Coupled way, const CouplingCase& c, int steps) const;

 private:
  Eigen::Index free_ = 0, held_ = 0;  // rows
  Eigen::MatrixXd stiffness_;         // [N/m] of all nodes
  Eigen::MatrixXd ride_;              // G of the handle's nodes, held_ x 6
  Eigen::VectorXd mass_;              // [kg] of all nodes, by row
  Eigen::VectorXd push_;              // [m/s] of free nodes
};

}  // namespace pliant
