#include "systems/soft/fem/hexahedra.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "systems/soft/fem/polar.h"

namespace pliant {
namespace {

// [1] Of the shear that grows along its own axis. With all of it a square bar of four cells is 6 % too stiff in
// torsion, since its section cannot warp between nodes; without it, the cells would twist freely.
constexpr double kTwist = 0.5;

double corner_sign(std::size_t corner, int axis) {
  return corner >> axis & 1 ? 1.0 : -1.0;
}

// h_a of a corner.
double corner_product(std::size_t corner, int a) {
  return a == 3 ? corner_sign(corner, 0) * corner_sign(corner, 1) * corner_sign(corner, 2)
                : corner_sign(corner, (a + 1) % 3) * corner_sign(corner, (a + 2) % 3);
}

// Stiffness of the assumed strain: of q_a along d with itself, and of q_f along d with q_d along f (bend), q_d along d
// with q_f along f (twist).
struct RestStiffness {
  double own[3][4] = {};                     // [N/m] d, a
  double bend[3][3] = {}, twist[3][3] = {};  // [N/m] d, f
};

RestStiffness rest_stiffness(const Hexahedron& hex, double lambda, double mu) {
  RestStiffness out;
  const double plate = 4 * mu * (lambda + mu) / (lambda + 2 * mu), nu = lambda / (2 * (lambda + mu));
  for (int e = 0; e < 3; ++e) {
    const int d = (e + 1) % 3, f = (e + 2) % 3;
    const double V = hex.volume * hex.spread[e], od = hex.over[d], of = hex.over[f];
    out.own[d][f] += V * plate * od * od;
    out.own[f][d] += V * plate * of * of;
    out.bend[d][f] = out.bend[f][d] = V * plate * nu * od * of;
    const double shear = kTwist * V * mu;
    out.own[d][d] += shear * of * of;
    out.own[f][f] += shear * od * od;
    out.twist[d][f] = out.twist[f][d] = shear * od * of;
    out.own[e][3] += hex.volume * mu * hex.over[e] * hex.over[e] * hex.spread[d] * hex.spread[f];
  }
  return out;
}

dmat3 mean_deformation(const Hexahedron& hex, const std::vector<dvec3>& x) {
  dmat3 F(0.0);
  for (std::size_t i = 1; i < 8; ++i) F += outerProduct(x[hex.node[i]] - x[hex.node[0]], hex.gradient[i]);
  return F;
}

// eps in the world frame, q_a in the cell's.
struct CellStrain {
  dmat3 mean;
  std::array<dvec3, 4> q{};
};

CellStrain cell_strain(const Hexahedron& hex, const std::vector<dvec3>& x, const HexVisit& v) {
  CellStrain out;
  dmat3 G(0.0);
  for (std::size_t i = 1; i < 8; ++i) {
    const dvec3 edge = x[hex.node[i]] - x[hex.node[0]];
    G += outerProduct(edge, v.c[i]);
    for (std::size_t a = 0; a < 4; ++a) out.q[a] += hex.rest[a][i] * edge;
  }
  out.mean = 0.5 * (G + transpose(G)) - dmat3(1.0);
  for (dvec3& each : out.q) each = each * v.R;
  return out;
}

// Of q_a, in the cell's frame.
std::array<dvec3, 4> rest_forces(const RestStiffness& rest, const std::array<dvec3, 4>& q) {
  std::array<dvec3, 4> force{};
  for (int d = 0; d < 3; ++d) {
    for (std::size_t a = 0; a < 4; ++a) force[a][d] += rest.own[d][a] * q[a][d];
    for (int f = 0; f < 3; ++f) {
      if (f == d) continue;
      const auto ad = static_cast<std::size_t>(d), af = static_cast<std::size_t>(f);
      force[af][d] += rest.bend[d][f] * q[ad][f];
      force[ad][d] += rest.twist[d][f] * q[af][f];
    }
  }
  return force;
}

}  // namespace

std::array<Tet, 6> pairs_of(const std::array<std::uint32_t, 8>& n) {
  return {{{n[0], n[1], n[2], n[3]},
           {n[4], n[5], n[6], n[7]},
           {n[0], n[1], n[4], n[5]},
           {n[2], n[3], n[6], n[7]},
           {n[0], n[1], n[6], n[7]},
           {n[2], n[3], n[4], n[5]}}};
}

std::vector<Hexahedron> make_hexahedra(const TetMesh& mesh) {
  std::vector<Hexahedron> out;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const LatticeCell& cell = mesh.cells[c];
    // Mean gradients in the cell's own coordinates, then of the parallelepiped nearest to it.
    std::array<dvec3, 8> own, B;
    dmat3 J(0.0);  // columns: x by each coordinate
    for (std::size_t k = 0; k < 8; ++k) {
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        own[k][d] = 0.125 * corner_sign(k, d) *
                    (1 + corner_sign(k, e) * cell.mean[e] + corner_sign(k, f) * cell.mean[f] +
                     corner_sign(k, e) * corner_sign(k, f) * cell.products[d]);
      }
      J += outerProduct(mesh.nodes[cell.nodes[k]] - mesh.nodes[cell.nodes[0]], own[k]);
    }
    const double volume = 8 * glm::determinant(J) * cell.share;
    if (!(volume > 0.0)) continue;
    const dmat3 to_world = glm::transpose(glm::inverse(J));
    for (std::size_t k = 0; k < 8; ++k) B[k] = to_world * own[k];
    std::array<std::size_t, 8> order;
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cell.nodes[a] < cell.nodes[b]; });
    Hexahedron hex;
    hex.volume = volume * (mesh.factors.empty() ? 1.0 : mesh.factors[c].stiffness);
    hex.damping = mesh.factors.empty() ? 1.0 : mesh.factors[c].damping;
    hex.relaxation = mesh.factors.empty() ? 1.0 : mesh.factors[c].relaxation;
    hex.spread = cell.spread;
    for (int d = 0; d < 3; ++d) hex.over[d] = 1.0 / length(J[d]);
    for (int a = 0; a < 4; ++a) {
      dvec3 along(0);
      for (std::size_t k = 0; k < 8; ++k)
        along += corner_product(k, a) * (mesh.nodes[cell.nodes[k]] - mesh.nodes[cell.nodes[0]]);
      for (std::size_t i = 0; i < 8; ++i)
        hex.rest[static_cast<std::size_t>(a)][i] = (corner_product(order[i], a) - dot(along, B[order[i]])) / 8;
    }
    for (std::size_t i = 0; i < 8; ++i) {
      hex.node[i] = cell.nodes[order[i]];
      hex.gradient[i] = B[order[i]];
    }
    out.push_back(hex);
  }
  std::sort(out.begin(), out.end(), [](const Hexahedron& a, const Hexahedron& b) { return a.node < b.node; });
  return out;
}

dquat rotation_of(const Hexahedron& hex, const std::vector<dvec3>& x) {
  dquat q = hex.q;
  extract_rotation(mean_deformation(hex, x), q);
  return q;
}

void turn_cell(const Hexahedron& hex, const dquat& q, HexVisit& visit) {
  visit.R = glm::mat3_cast(q);
  for (std::size_t i = 0; i < 8; ++i) visit.c[i] = visit.R * hex.gradient[i];
}

void find_cell_forces(const Hexahedron& hex, const std::vector<dvec3>& x, double lambda, double mu, HexVisit& v) {
  const CellStrain strain = cell_strain(hex, x, v);
  const dmat3& eps = strain.mean;
  const double trace = eps[0][0] + eps[1][1] + eps[2][2];
  const dmat3 sigma = 2 * mu * eps + dmat3(lambda * trace);
  v.energy = 0.0;
  for (int k = 0; k < 3; ++k) v.energy += 0.5 * hex.volume * dot(sigma[k], eps[k]);
  std::array<dvec3, 4> force = rest_forces(rest_stiffness(hex, lambda, mu), strain.q);
  for (std::size_t a = 0; a < 4; ++a) {
    v.energy += 0.5 * dot(force[a], strain.q[a]);
    force[a] = v.R * force[a];
  }
  for (std::size_t i = 0; i < 8; ++i) {
    v.f[i] = -hex.volume * (sigma * v.c[i]);
    for (std::size_t a = 0; a < 4; ++a) v.f[i] -= hex.rest[a][i] * force[a];
  }
}

void find_cell_stress(const Hexahedron& hex, const std::vector<dvec3>& x, double lambda, double mu, const HexVisit& v,
                      double* stress) {
  const CellStrain strain = cell_strain(hex, x, v);
  const dmat3 eps = transpose(v.R) * strain.mean * v.R;
  const dmat3 S = 2 * mu * eps + dmat3(lambda * (eps[0][0] + eps[1][1] + eps[2][2]));
  const double mean[6] = {S[0][0], S[1][1], S[2][2], S[1][0], S[2][0], S[2][1]};
  std::copy(mean, mean + 6, stress);
  const std::array<dvec3, 4> force = rest_forces(rest_stiffness(hex, lambda, mu), strain.q);
  for (int a = 0; a < 4; ++a)
    for (int d = 0; d < 3; ++d) stress[6 + 3 * a + d] = force[static_cast<std::size_t>(a)][d];
}

void add_cell_history(const Hexahedron& hex, const std::vector<dvec3>& x, const double* h, double share, HexVisit& v) {
  const CellStrain strain = cell_strain(hex, x, v);
  const dmat3 H = v.R * dmat3(h[0], h[3], h[4], h[3], h[1], h[5], h[4], h[5], h[2]) * transpose(v.R);
  v.energy *= share;
  for (int k = 0; k < 3; ++k) v.energy += hex.volume * dot(H[k], strain.mean[k]);
  std::array<dvec3, 4> force;
  for (std::size_t a = 0; a < 4; ++a) {
    force[a] = dvec3(h[6 + 3 * a], h[7 + 3 * a], h[8 + 3 * a]);
    v.energy += dot(force[a], strain.q[a]);
    force[a] = v.R * force[a];
  }
  for (std::size_t i = 0; i < 8; ++i) {
    v.f[i] = share * v.f[i] - hex.volume * (H * v.c[i]);
    for (std::size_t a = 0; a < 4; ++a) v.f[i] -= hex.rest[a][i] * force[a];
  }
}

void find_cell_stiffness(const Hexahedron& hex, double lambda, double mu, HexVisit& v) {
  const RestStiffness rest = rest_stiffness(hex, lambda, mu);
  const dmat3 back = transpose(v.R);
  std::size_t pair = 0;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = i; j < 8; ++j, ++pair) {
      dmat3 own(0.0);  // [column][row]
      for (int d = 0; d < 3; ++d) {
        const auto ad = static_cast<std::size_t>(d);
        for (std::size_t a = 0; a < 4; ++a) own[d][d] += rest.own[d][a] * hex.rest[a][i] * hex.rest[a][j];
        for (int f = 0; f < 3; ++f) {
          if (f == d) continue;
          const auto af = static_cast<std::size_t>(f);
          own[f][d] += rest.bend[d][f] * hex.rest[af][i] * hex.rest[ad][j] +
                       rest.twist[d][f] * hex.rest[ad][i] * hex.rest[af][j];
        }
      }
      const dvec3 ci = v.c[i], cj = v.c[j];
      v.K[pair] = v.R * own * back +
                  hex.volume * (lambda * outerProduct(ci, cj) + mu * (outerProduct(cj, ci) + dmat3(dot(ci, cj))));
    }
}

}  // namespace pliant
