// The split's analytic part against integrals over waves of the surface (methods.md 2.10).
#include "systems/soft/local/local_compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "components/bonded_layer.h"

namespace pliant {
namespace {

double over_waves(double s, double sigma, int order) {
  static const GaussRule rule = gauss_rule(600);
  const double most = 7.0 / sigma;
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.at.size(); ++i) {
    const double x = most * rule.at[i];
    sum += most * rule.weight[i] * std::cyl_bessel_j(order, x * s) * std::exp(-x * x * sigma * sigma);
  }
  return sum;
}

TEST(LocalCompliance, TheKernelsAreTheirIntegralsOverWaves) {
  for (const double sigma : {0.3, 1.0, 2.5})
    for (const double s : {0.0, 1e-3, 0.2, 1.0, 3.0, 7.0, 11.9, 12.1, 30.0}) {
      const double scale = 1 / std::max(s, sigma);
      EXPECT_NEAR(h0(s, sigma), over_waves(s, sigma, 0), 1e-10 * scale) << s << ' ' << sigma;
      EXPECT_NEAR(h1(s, sigma), over_waves(s, sigma, 1), 1e-10 * scale) << s << ' ' << sigma;
      EXPECT_NEAR(h2(s, sigma), over_waves(s, sigma, 2), 1e-10 * scale) << s << ' ' << sigma;
    }
}

LocalPlace place(dvec3 at, double own, double smeared, LatticeCompliance lattice = {.917, .853}) {
  return {at, dvec3(0, 1, 0), own, smeared, lattice, 0.0};
}

// Displacement per force between two Gaussian loads on the half-space y < 0, by the surface's response to waves e^(i k
// x) of traction: (1 - nu) / (G k) normal, (I - nu k k^T / k^2) / (G k) along it, and (1 - 2 nu) / (2 G k^2) i k
// between.
Block half_space_by_waves(dvec3 apart, double sigma, double shear, double nu) {
  static const GaussRule rule = gauss_rule(400);
  constexpr int kTurns = 512;
  const double most = 7.0 / sigma;
  Block out = Block::Zero();
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 2 * M_PI * turn / kTurns, c = std::cos(angle), d = std::sin(angle);
    const double path = apart.x * c + apart.z * d;
    double even = 0.0, odd = 0.0;
    for (std::size_t i = 0; i < rule.at.size(); ++i) {
      const double x = most * rule.at[i], g = most * rule.weight[i] * std::exp(-x * x * sigma * sigma);
      even += g * std::cos(x * path), odd += g * std::sin(x * path);
    }
    const double w = 1 / (2 * M_PI * kTurns * shear);  // 1 / (2 pi)^2 over one turn
    out(0, 0) += w * even * (1 - nu * c * c), out(2, 2) += w * even * (1 - nu * d * d);
    out(0, 2) -= w * even * nu * c * d, out(2, 0) -= w * even * nu * c * d;
    out(1, 1) += w * even * (1 - nu);
    const double mixed = w * odd * (1 - 2 * nu) / 2;
    out(0, 1) += mixed * c, out(1, 0) -= mixed * c;
    out(2, 1) += mixed * d, out(1, 2) -= mixed * d;
  }
  return out;
}

TEST(LocalCompliance, SelfAndPairTermsAreTheDifferenceOfTwoLoadsOnTheHalfSpace) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    const LocalElasticity tissue{7e3, nu};
    for (const double s : {0.0, 0.4, 1.7, 4.0}) {
      const dvec3 apart(0.6 * s, 0.0, 0.8 * s);
      // One lattice compliance for normal and tangent, so that one load serves for all of a block.
      const LocalPlace i = place(apart, 0.5, 1.5, {.9, .9}), j = place(dvec3(0.0), 0.8, 1.3, {.9, .9});
      const double own = std::sqrt(0.5 * (0.25 + 0.64) / M_PI),
                   smeared = std::sqrt(0.5 * (1.5 * 1.5 + 1.3 * 1.3) / M_PI) / 0.9;
      const Block right =
          half_space_by_waves(apart, own, tissue.shear(), nu) - half_space_by_waves(apart, smeared, tissue.shear(), nu);
      const Block is = local_compliance(i, j, tissue, nullptr);
      EXPECT_LT((is - right).cwiseAbs().maxCoeff(), 1e-10 / tissue.young) << nu << ' ' << s;
      EXPECT_LT((local_compliance(j, i, tissue, nullptr) - is.transpose()).cwiseAbs().maxCoeff(), 1e-16);
    }
    const LocalPlace at = place(dvec3(0), 0.5, 1.5);
    const Block self = local_self_compliance(at, tissue, nullptr);
    EXPECT_LT((self - local_compliance(at, at, tissue, nullptr)).cwiseAbs().maxCoeff(), 1e-10 / tissue.young);
    EXPECT_NEAR(self(1, 1), (1 / 0.5 - .917 / 1.5) / (2 * tissue.reduced()), 1e-16);
    EXPECT_NEAR(self(0, 0), (2 - nu) / (8 * tissue.shear()) * (1 / 0.5 - .853 / 1.5), 1e-16);
  }
}

TEST(LocalCompliance, OnABondedLayerItIsHayesPunchLessTheSmearedLoad) {
  const LayerKernel layer(0.45);
  // lambda of methods.md 2.10 by quadrature elsewhere (thickness over radius, nu 0.45).
  for (const auto& [ratio, share] : {std::pair{0.5, .133}, {1.0, .307}, {2.0, .549}, {4.0, .751}, {8.0, .872}})
    EXPECT_NEAR(layer.share(1.0, ratio), share, 6e-4) << ratio;
  for (const double thickness : {0.7, 2.0})
    for (const double s : {0.0, 0.13, 0.9, 3.3})
      for (const double sigma : {0.02, 0.3, 0.8})
        EXPECT_NEAR(layer.below(s, sigma, thickness), LayerKernel::by_quadrature(s, sigma, thickness, 0.45),
                    1e-5 / thickness)
            << thickness << ' ' << s << ' ' << sigma;

  const LocalElasticity tissue{1e4, 0.45};
  LocalPlace at = place(dvec3(0), 1.0, 1.5), beside = place(dvec3(0, 0, 2), 1.0, 1.5);
  at.thickness = beside.thickness = 2.0;
  const double punch = 1 / (2 * tissue.reduced() * bonded_layer_factor(0.5, 0.45));
  EXPECT_NEAR(local_normal_compliance(at, tissue, &layer),
              punch - .917 * layer.share(1.5, 2.0) / 1.5 / (2 * tissue.reduced()), 1e-4 * punch);
  for (double ratio = 0.01; ratio < 4.0; ratio *= 1.3)
    EXPECT_NEAR(layer.punch(ratio) / bonded_layer_factor(ratio, 0.45), 1.0, 1e-4) << ratio;
  const LocalPlace far = place(dvec3(0, 0, 5.9), 1.0, 1.5);
  LocalPlace far_layer = far;
  far_layer.thickness = 2.0;
  const double alone = local_compliance(at, far_layer, tissue, &layer)(1, 1);
  EXPECT_LT(std::abs(alone), 0.02 * std::abs(local_compliance(place(dvec3(0), 1, 1.5), far, tissue, nullptr)(1, 1)) +
                                 1e-3 * punch);  // nothing reaches so far on a layer
}

TEST(LocalCompliance, SixtyContactsHalfOfThemCoincidentHaveNoNegativeEigenvalue) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-2.0, 2.0), near(-1e-3, 1e-3);
  const LocalElasticity tissue{1e4, 0.45};
  for (const bool turned : {false, true}) {
    std::vector<LocalPlace> all;
    for (int i = 0; i < 60; ++i) {
      dvec3 at(anywhere(random), 0.0, anywhere(random));
      if (i % 2 == 1) at = all.back().at + dvec3(near(random), 0.0, near(random));
      all.push_back(place(at, 0.5, 1.5));
      if (turned) all.back().normal = normalize(dvec3(0.2 * at.x, 1.0, 0.2 * at.z));
    }
    Eigen::MatrixXd L(180, 180);
    for (int i = 0; i < 60; ++i)
      for (int j = 0; j < 60; ++j)
        L.block<3, 3>(3 * i, 3 * j) =
            local_compliance(all[static_cast<std::size_t>(i)], all[static_cast<std::size_t>(j)], tissue, nullptr);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (L + L.transpose()));
    EXPECT_LT((L - L.transpose()).cwiseAbs().maxCoeff(), 1e-12 * L(0, 0));
    EXPECT_GT(eigen.eigenvalues()[0], -(turned ? 1e-2 : 1e-9) * L(0, 0));
  }
}

TEST(LatticeCalibration, BetweenItsRowsItIsBetweenThem) {
  EXPECT_NEAR(lattice_compliance(0.45, 1.5).normal, .917, 1e-12);
  EXPECT_NEAR(lattice_compliance(0.45, 2.5).tangential, .937, 1e-12);
  EXPECT_NEAR(lattice_compliance(0.0, 3.0).normal, .983, 1e-12);
  EXPECT_NEAR(lattice_compliance(0.495, 2.0).tangential, .721, 1e-12);
  for (double nu = 0.3; nu < 0.494; nu += 0.007)
    for (double radius = 1.5; radius < 6.0; radius += 0.21) {
      const LatticeCompliance here = lattice_compliance(nu, radius), stiffer = lattice_compliance(nu + 0.004, radius),
                              wider = lattice_compliance(nu, radius + 0.1);
      EXPECT_GT(here.normal, stiffer.normal);
      EXPECT_LT(here.normal, wider.normal);
      EXPECT_LT(here.tangential, here.normal);
      EXPECT_LT(wider.normal, 1.0);
    }
}

}  // namespace
}  // namespace pliant
