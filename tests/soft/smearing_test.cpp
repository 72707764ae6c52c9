// Split contacts on a half-space of stuffed lattice: half a ball, ten cells deep, with the exact displacements of the
// half-space on its rim (methods.md 2.10).
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "components/bonded_layer.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/surface_samples.h"
#include "content/tets/tet_order.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"
#include "systems/soft/local/smearing_surface.h"

namespace pliant {
namespace {

constexpr double kCellOfBall = 1.0;  // [m]
constexpr double kBall = 10.0;       // [m]
constexpr double kStatic = 1e6;      // [s] of a step: inertia is nothing against stiffness

// Half a ball below the plane through the origin, whose normal is `up`.
Primitive half_ball(const dmat3& turn, dvec3 centre) {
  constexpr std::uint32_t kAround = 40, kRings = 10;
  Primitive p;
  const auto add = [&](dvec3 x) { p.position.push_back(vec3(centre + turn * x)); };
  add(dvec3(0));
  for (std::uint32_t r = 0; r < kRings; ++r)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const double down = M_PI / 2 * r / kRings, round = 2 * M_PI * k / kAround;
      add(kBall * dvec3(std::cos(down) * std::cos(round), -std::sin(down), std::cos(down) * std::sin(round)));
    }
  add(kBall * dvec3(0, -1, 0));
  const auto at = [&](std::uint32_t r, std::uint32_t k) { return 1 + r * kAround + k % kAround; };
  const auto last = static_cast<std::uint32_t>(p.position.size()) - 1;
  for (std::uint32_t k = 0; k < kAround; ++k) {
    p.index.insert(p.index.end(), {0, at(0, k + 1), at(0, k)});
    for (std::uint32_t r = 0; r + 1 < kRings; ++r)
      p.index.insert(p.index.end(),
                     {at(r, k), at(r, k + 1), at(r + 1, k), at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
    p.index.insert(p.index.end(), {last, at(kRings - 1, k), at(kRings - 1, k + 1)});
  }
  return p;
}

class LatticeHalfSpace {
 public:
  LatticeHalfSpace(double poisson, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> any;
    turn_ = glm::mat3_cast(normalize(dquat(any(random), any(random), any(random), any(random))));
    const dvec3 centre(0.3 * any(random), 0.3 * any(random), 0.3 * any(random));
    centre_ = centre;
    const Primitive surface = half_ball(turn_, centre);
    Result<BuiltMesh> mesh = build_mesh("half ball", {&surface, 1}, mat4(1.0f));
    EXPECT_TRUE(mesh.ok());
    Result<TetMesh> tets = fill_surface(mesh->mesh, {.cell = kCellOfBall});
    EXPECT_TRUE(tets.ok());
    tets_ = std::move(*tets);
    std::vector<NodeGroup> group;
    for (const dvec3 p : tets_.nodes)
      group.push_back(length(p - centre) > kBall - 0.6 * kCellOfBall ? NodeGroup::kPinned : NodeGroup::kFree);
    put_in_order(tets_, group);
    tets_.samples = sample_surface(mesh->mesh, tets_);
    // Nothing is held: no layer.
    TetMesh unheld = tets_;
    unheld.free_count = unheld.node_count();
    unheld_ = std::move(unheld);
    body_ = std::make_unique<Tissue>(tets_, material(poisson), tets_.free_count);
    solver_ = make_solver(SolverKind::kBlockCholesky, body_->moving());
    solver_->analyse(body_->inner());
    take(poisson);
  }
  // Of another Poisson's ratio.
  void take(double poisson) {
    if (surface_ && tissue_.poisson == poisson) return;
    tissue_ = {1.0, poisson};
    surface_ = std::make_unique<SmearingSurface>(unheld_, poisson);
    body_->set_material(material(poisson));
    body_->position() = tets_.nodes;
    body_->assemble(kStatic, dvec3(0));
    EXPECT_TRUE(solver_->factorise(body_->inner()));
  }
  const LocalElasticity& tissue() const { return tissue_; }
  const SmearingSurface& surface() const { return *surface_; }
  dvec3 place(double x, double z) const { return centre_ + turn_ * dvec3(x, 0, z); }
  dvec3 axis(int k) const { return turn_[k]; }  // 1: the outward normal

  SmearedLoad load_at(double x, double z, double own) const { return surface_->load_alone(place(x, z), axis(1), own); }
  // [m per N] Of the nodes, under a unit force along axis k (1: outward) at each load alone.
  std::vector<std::vector<dvec3>> under(std::span<const SmearedLoad> loads, int k) const {
    const std::uint32_t moving = body_->moving();
    Rows right = Rows::Zero(3 * moving, static_cast<Eigen::Index>(loads.size()));
    std::vector<std::vector<dvec3>> u(loads.size(), std::vector<dvec3>(tets_.node_count(), dvec3(0)));
    for (std::size_t l = 0; l < loads.size(); ++l) {
      for (std::uint32_t i = moving; i < tets_.node_count(); ++i) {
        u[l][i] = exact(tets_.nodes[i] - loads[l].place.at, k);
        body_->position()[i] = tets_.nodes[i] + u[l][i];
      }
      body_->find_forces();
      const auto column = static_cast<Eigen::Index>(l);
      right.col(column) = kStatic * kStatic * body_->elastic_force().head(3 * moving);
      for (const SmearedNode& part : loads[l].nodes)
        if (part.node < moving)
          for (int d = 0; d < 3; ++d) right(3 * part.node + d, column) += kStatic * kStatic * part.weight * axis(k)[d];
    }
    solver_->solve_many(right);
    for (std::size_t l = 0; l < loads.size(); ++l)
      for (std::uint32_t i = 0; i < moving; ++i)
        for (int d = 0; d < 3; ++d) u[l][i][d] = right(3 * i + d, static_cast<Eigen::Index>(l));
    return u;
  }
  static dvec3 read(const SmearedLoad& load, const std::vector<dvec3>& u) {
    dvec3 sum(0);
    for (const SmearedNode& part : load.nodes) sum += part.weight * u[part.node];
    return sum;
  }

 private:
  static TissueMaterial material(double poisson) {
    return {.young = 1.0, .poisson = poisson, .density = 1e-9, .strain = Strain::kLinear};
  }
  // Boussinesq's and Cerruti's solutions.
  dvec3 exact(dvec3 apart, int k) const {
    const dvec3 p = apart * turn_;
    const double x = p.x, y = p.z, z = -p.y, r = length(p), nu = tissue_.poisson;
    const double scale = 1 / (4 * M_PI * tissue_.shear());
    dvec3 u;  // x, along z of the frame, inwards
    if (k == 1) {
      const double flat = z / (r * r * r) - (1 - 2 * nu) / (r * (r + z));
      u = -dvec3(x * flat, y * flat, z * z / (r * r * r) + 2 * (1 - nu) / r);
    } else {
      const double a = k == 0 ? x : y, b = k == 0 ? y : x, r3 = r * r * r, q = r * (r + z) * (r + z);
      const double along = 1 / r + a * a / r3 + (1 - 2 * nu) * (1 / (r + z) - a * a / q);
      const double across = a * b / r3 - (1 - 2 * nu) * a * b / q;
      u = dvec3(k == 0 ? along : across, k == 0 ? across : along, a * z / r3 + (1 - 2 * nu) * a / (r * (r + z)));
    }
    return scale * (turn_ * dvec3(u.x, -u.z, u.y));
  }

  LocalElasticity tissue_;
  dmat3 turn_;
  dvec3 centre_{0};
  TetMesh tets_, unheld_;
  std::unique_ptr<SmearingSurface> surface_;
  std::unique_ptr<Tissue> body_;
  std::unique_ptr<LinearSolver> solver_;
};

// Rows 3, 4 and 11 of methods.md 2.10.
TEST(Smearing, ALatticeGivesThePunchOfTheHalfSpaceAnywhereOnIt) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    LatticeHalfSpace half(0.3, seed);
    for (const auto& [nu, within] : {std::pair{0.3, 0.01}, {0.45, 0.01}, {0.49, 0.025}}) {
      half.take(nu);
      double worst = 0.0, worst_aside = 0.0;
      std::mt19937 random(10 * seed);
      std::uniform_real_distribution<double> in_cell(-1.0, 1.0);
      std::vector<SmearedLoad> loads;
      for (int i = 0; i < 5; ++i) loads.push_back(half.load_at(in_cell(random), in_cell(random), 1.0));
      const auto pressed = half.under(loads, 1), dragged = half.under(loads, 0);
      for (std::size_t i = 0; i < loads.size(); ++i) {
        const LocalPlace& p = loads[i].place;
        const double down = dot(half.axis(1), half.read(loads[i], pressed[i]));
        EXPECT_NEAR(down * 2 * half.tissue().reduced() * p.smeared / p.lattice.normal, 1.0, nu < 0.47 ? 0.01 : 0.02);
        for (const double a : {0.1, 0.25, 0.5, 1.0}) {
          LocalPlace at = p;
          at.own = a;
          const double whole = down + local_normal_compliance(at, half.tissue(), nullptr);
          worst = std::max(worst, std::abs(1 / (whole * 2 * half.tissue().reduced() * a) - 1));
        }
        const double aside = dot(half.axis(0), half.read(loads[i], dragged[i]));
        for (const double a : {0.25, 0.5, 1.0}) {
          LocalPlace at = p;
          at.own = a;
          const double whole = aside + local_tangential_compliance(at, half.tissue());
          worst_aside = std::max(worst_aside, std::abs((2 - nu) / (8 * half.tissue().shear() * a) / whole - 1));
        }
      }
      EXPECT_LT(worst, within) << nu;
      EXPECT_LT(worst_aside, 0.015) << nu;
    }
  }
}

// Rows 10 and 13.
TEST(Smearing, NeighboursActOnEachOtherAsOnTheHalfSpace) {
  const LatticeHalfSpace half(0.45, 5);
  constexpr double kOwn = 0.5;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-2.0, 2.0), near(-0.05, 0.05);
  std::vector<SmearedLoad> loads;
  constexpr int kContacts = 24;
  for (int i = 0; i < kContacts; ++i) {
    double x = anywhere(random), z = anywhere(random);
    if (i % 2 == 1) {
      const dvec3 last = loads.back().place.at - half.place(0, 0);
      x = dot(last, half.axis(0)) + near(random), z = dot(last, half.axis(2)) + near(random);
    }
    loads.push_back(half.load_at(x, z, kOwn));
  }
  Eigen::MatrixXd W(kContacts, kContacts);
  double worst = 0.0;
  const double self = 1 / (2 * half.tissue().reduced() * kOwn);
  const auto pressed = half.under(loads, 1);
  for (int j = 0; j < kContacts; ++j) {
    const std::vector<dvec3>& u = pressed[static_cast<std::size_t>(j)];
    for (int i = 0; i < kContacts; ++i) {
      const LocalPlace &at = loads[i].place, &other = loads[j].place;
      const Block local = local_compliance(at, other, half.tissue(), nullptr);
      const dvec3 n = half.axis(1);
      double of = dot(n, half.read(loads[i], u));
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) of += n[r] * local(r, c) * n[c];
      W(i, j) = of;
      const double truth = h0(length(at.at - other.at), kSigmaOfRadius * kOwn) / (M_PI * half.tissue().reduced());
      worst = std::max(worst, std::abs(of - truth) / self);
    }
  }
  const Eigen::MatrixXd even = 0.5 * (W + W.transpose());
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(even).eigenvalues()[0];
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(least, -2e-3 * W(0, 0));  // the rim of this test is not quite symmetric
}

// Row 2: the surface without its dent, on a curved body that moves as a whole.
TEST(Smearing, UnderRigidMotionThePlaceOfACurvedBodyIsExact) {
  Primitive ball;
  {
    const Primitive half = half_ball(dmat3(1.0), dvec3(0));
    ball = half;
  }
  Result<BuiltMesh> mesh = build_mesh("ball", {&ball, 1}, mat4(1.0f));
  ASSERT_TRUE(mesh.ok());
  Result<TetMesh> tets = make_lattice(mesh->mesh, 2.5);
  ASSERT_TRUE(tets.ok());
  tets->samples = sample_surface(mesh->mesh, *tets);
  const SmearingSurface surface(*tets, 0.45);
  const dquat q = normalize(dquat(0.4, -0.7, 0.2, 0.55));
  const dvec3 by(3.0, -20.0, 7.0);
  std::vector<dvec3> moved;
  for (const dvec3 p : tets->nodes) moved.push_back(q * p + by);
  const dvec3 at = kBall * normalize(dvec3(1, -2, 0.5));
  SmearedLoad load = surface.load_at(at, normalize(at), 0.5);
  surface.follow(moved, load);
  EXPECT_GT(length(load.mean - at), 0.1);  // below the curved surface
  EXPECT_LT(length(load.to_world(at) - (q * at + by)), 1e-11);
  EXPECT_LT(length(load.to_rest(q * at + by) - at), 1e-11);
  double sum = 0.0;
  for (const SmearedNode& part : load.nodes) sum += part.weight;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

// Row 12: a punch of half a cell's radius, slid over two cells. Force and drag are those of its energy d^2 / 2 W(s).
TEST(Smearing, ASlidPunchNeitherRipplesNorDrags) {
  const LatticeHalfSpace half(0.45, 4);
  constexpr double kOwn = 0.5, kStep = 0.05;
  std::vector<SmearedLoad> loads;
  for (int i = 0; i <= 40; ++i) {
    const dvec3 at = half.place(-1.0 + kStep * i, 0.37 * (-1.0 + kStep * i));
    loads.push_back(half.surface().load_at(at, half.axis(1), kOwn));
  }
  const auto pressed = half.under(loads, 1);
  std::vector<double> whole;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const SmearedLoad& load = loads[i];
    const SmearedLoad* const one = &load;
    whole.push_back(dot(half.axis(1), half.read(load, pressed[i])) +
                    local_normal_compliance(load.place, half.tissue(), nullptr) +
                    half.surface().missing({&one, 1})(0, 0) / (M_PI * half.tissue().reduced()));
  }
  const auto [least, most] = std::minmax_element(whole.begin(), whole.end());
  EXPECT_LT(*most / *least - 1.0, 0.005);
  double drag = 0.0;
  const double along = kStep * std::hypot(1.0, 0.37);
  for (std::size_t i = 1; i + 1 < whole.size(); ++i)
    drag = std::max(drag, std::abs(0.5 * kOwn * (whole[i + 1] - whole[i - 1]) / (2 * along) / whole[i]));
  EXPECT_LT(drag, 0.005);
}

// Rows 9 and 17: a flat punch of points on the lattice, by anchors and by one column for each of them.
TEST(Smearing, APunchOfPointsIsAPunchAndAnchorsDoNotChangeIt) {
  const LatticeHalfSpace half(0.45, 6);
  for (const auto& [punch, rings] : {std::pair{0.5, 2}, {1.0, 2}, {2.0, 4}}) {
    std::vector<dvec2> at;
    std::vector<double> area;
    for (int r = 0; r < rings; ++r) {  // rings of equal areas
      const int count = r == 0 ? 4 : 8 * r;
      const auto edge = [rings = rings, punch = punch](int ring) {
        double points = 0;
        for (int q = 0; q < ring; ++q) points += q == 0 ? 4 : 8 * q;
        double all = 0;
        for (int q = 0; q < rings; ++q) all += q == 0 ? 4 : 8 * q;
        return punch * std::sqrt(points / all);
      };
      const double inner = edge(r), outer = edge(r + 1), mean = std::sqrt(0.5 * (inner * inner + outer * outer));
      for (int i = 0; i < count; ++i) {
        const double turn = 2 * M_PI * (i + 0.5 * r) / count;
        at.push_back(mean * dvec2(std::cos(turn), std::sin(turn)));
        area.push_back(M_PI * (outer * outer - inner * inner) / count);
      }
    }
    const auto count = static_cast<Eigen::Index>(at.size());
    const auto force = [&](bool by_anchors) {
      std::vector<SmearedLoad> loads;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const double own = kFlatOfDisc * std::sqrt(area[i] / M_PI);
        const dvec3 x = half.place(at[i].x, at[i].y);
        loads.push_back(by_anchors ? half.surface().load_at(x, half.axis(1), own)
                                   : half.surface().load_alone(x, half.axis(1), own));
      }
      std::vector<const SmearedLoad*> all;
      for (const SmearedLoad& load : loads) all.push_back(&load);
      const Eigen::MatrixXd missing = half.surface().missing(all) / (M_PI * half.tissue().reduced());
      Eigen::MatrixXd W(count, count);
      const auto pressed = half.under(loads, 1);
      for (Eigen::Index j = 0; j < count; ++j) {
        const SmearedLoad& from = loads[static_cast<std::size_t>(j)];
        const std::vector<dvec3>& u = pressed[static_cast<std::size_t>(j)];
        for (Eigen::Index i = 0; i < count; ++i) {
          const SmearedLoad& to = loads[static_cast<std::size_t>(i)];
          const Block local = i == j ? local_self_compliance(to.place, half.tissue(), nullptr)
                                     : local_compliance(to.place, from.place, half.tissue(), nullptr);
          W(i, j) = dot(half.axis(1), half.read(to, u)) + missing(i, j);
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) W(i, j) += half.axis(1)[r] * local(r, c) * half.axis(1)[c];
        }
      }
      return W.lu().solve(Vector::Ones(count)).sum();
    };
    const double truth = 2 * half.tissue().reduced() * punch, alone = force(false), anchored = force(true);
    EXPECT_NEAR(anchored, alone, 0.005 * alone) << punch;
    EXPECT_NEAR(anchored, truth, 0.035 * truth) << punch;  // 3 % are the points' own: rings of equal areas
  }
}

// Row 6: a flat punch on a layer bonded to a rigid base, with the layer's kernel.
TEST(Smearing, OnBondedLayersThePunchIsHayesPunch) {
  constexpr double kOwn = 0.5, kWide = 14.0, kNu = 0.45;
  for (const double thickness : {2.25, 3.0, 6.0}) {
    Primitive block;
    for (int i = 0; i < 8; ++i)
      block.position.emplace_back(i & 1 ? 0.5 * kWide + 0.03 : -0.5 * kWide, i & 2 ? 0.0 : -thickness,
                                  i & 4 ? 0.5 * kWide : -0.5 * kWide - 0.05);
    block.index = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                   1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7};
    Result<BuiltMesh> mesh = build_mesh("layer", {&block, 1}, mat4(1.0f));
    ASSERT_TRUE(mesh.ok());
    Result<TetMesh> tets = fill_surface(mesh->mesh, {.cell = kCellOfBall});
    ASSERT_TRUE(tets.ok());
    std::vector<NodeGroup> group;
    for (const dvec3 p : tets->nodes) group.push_back(p.y < -thickness + 1e-6 ? NodeGroup::kPinned : NodeGroup::kFree);
    put_in_order(*tets, group);
    tets->samples = sample_surface(mesh->mesh, *tets);
    const SmearingSurface surface(*tets, kNu);
    Tissue body(*tets, TissueMaterial{.young = 1.0, .poisson = kNu, .density = 1e-9, .strain = Strain::kLinear},
                tets->free_count);
    body.assemble(kStatic, dvec3(0));
    const std::unique_ptr<LinearSolver> solver = make_solver(SolverKind::kBlockCholesky, body.moving());
    solver->analyse(body.inner());
    ASSERT_TRUE(solver->factorise(body.inner()));
    const LocalElasticity tissue{1.0, kNu};
    for (const dvec2 place : {dvec2(0.0, 0.0), dvec2(0.41, -0.63)}) {
      const SmearedLoad load = surface.load_at(dvec3(place.x, 0, place.y), dvec3(0, 1, 0), kOwn);
      const SmearedLoad* const one = &load;
      EXPECT_NEAR(load.place.thickness, thickness < 6.0 ? thickness : 0.0, 1e-6);
      Rows right = Rows::Zero(3 * body.moving(), 1);
      for (const SmearedNode& part : load.nodes)
        if (part.node < body.moving()) right(3 * part.node + 1, 0) += kStatic * part.weight;
      solver->solve_many(right);
      double whole = local_normal_compliance(load.place, tissue, &surface.layer()) +
                     surface.missing({&one, 1})(0, 0) / (M_PI * tissue.reduced());
      for (const SmearedNode& part : load.nodes)
        if (part.node < body.moving()) whole += kStatic * part.weight * right(3 * part.node + 1, 0);
      const double truth = 2 * tissue.reduced() * kOwn * bonded_layer_factor(kOwn / thickness, kNu);
      EXPECT_NEAR(1 / whole, truth, 0.02 * truth) << thickness;
    }
  }
}

}  // namespace
}  // namespace pliant
