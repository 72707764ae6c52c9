#include "systems/soft/fem/element_history.h"

namespace pliant {
namespace {

constexpr double kSureTurn = 1e-7;  // [1] det(G) over its mean cubed: below it, the rotation is uncertain

dmat3 lane_gradient(const ElementVisit& visit, std::size_t lane) {
  dmat3 F;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) F[column][row] = visit.F[column][row][lane];
  return F;
}

dmat3 lane_rotation(const ElementVisit& visit, std::size_t lane) {
  return glm::mat3_cast(dquat(visit.q[0][lane], visit.q[1][lane], visit.q[2][lane], visit.q[3][lane]));
}

dmat3 symmetric_part(const dmat3& m) {
  return 0.5 * (m + transpose(m));
}

dmat3 biot_stress(ElasticLaw law, const LawConstants& m, const dmat3& U) {
  if (!law) {
    const dmat3 eps = U - dmat3(1.0);
    return 2 * m.mu * eps + dmat3(m.lambda * (eps[0][0] + eps[1][1] + eps[2][2]));
  }
  const dmat3 cof(cross(U[1], U[2]), cross(U[2], U[0]), cross(U[0], U[1]));
  const Density psi = law(m, dot(U[0], U[0]) + dot(U[1], U[1]) + dot(U[2], U[2]), dot(U[0], cof[0]));
  return 2 * psi.I * U + psi.J * cof;
}

// P of the history.
dmat3 history_stress(const dmat3& R, const dmat3& U, const dmat3& H) {
  const double trace = U[0][0] + U[1][1] + U[2][2];
  const dmat3 G = dmat3(trace) - U, HU = H * U;
  const double mean = 2.0 * trace / 3.0, det = glm::determinant(G);
  if (!(trace > 0.0 && det > kSureTurn * mean * mean * mean)) return R * H;
  const dvec3 axial = 0.5 * dvec3(HU[1][2] - HU[2][1], HU[2][0] - HU[0][2], HU[0][1] - HU[1][0]);
  const dvec3 w = 2.0 * (glm::inverse(G) * axial);
  return R * (H - dmat3(0, w.z, -w.y, -w.z, 0, w.x, w.y, -w.x, 0));
}

}  // namespace

void find_pack_stress(const ElementPack& pack, ElasticLaw law, const LawConstants& material, const ElementVisit& visit,
                      double* stress) {
  for (std::size_t l = 0; l < kElementLanes; ++l) {
    dmat3 S(0.0);
    if (l < pack.count)
      S = biot_stress(law, material, symmetric_part(transpose(lane_rotation(visit, l)) * lane_gradient(visit, l)));
    const double of[kStresses] = {S[0][0], S[1][1], S[2][2], S[1][0], S[2][0], S[2][1]};
    for (std::size_t k = 0; k < kStresses; ++k) stress[k * kElementLanes + l] = of[k];
  }
}

void add_pack_history(const ElementPack& pack, const double* history, const ElementLanes& share, ElementVisit& visit) {
  for (std::size_t l = 0; l < pack.count; ++l) {
    const auto h = [&](std::size_t k) { return history[k * kElementLanes + l]; };
    const dmat3 H(h(0), h(3), h(4), h(3), h(1), h(5), h(4), h(5), h(2)), R = lane_rotation(visit, l);
    const dmat3 U = symmetric_part(transpose(R) * lane_gradient(visit, l));
    visit.energy[l] *= share[l];
    for (int k = 0; k < 3; ++k) visit.energy[l] += pack.volume[l] * dot(H[k], U[k]);
    const dmat3 P = history_stress(R, U, H);
    dvec3 sum(0);
    for (int k = 0; k < 3; ++k) {
      const dvec3 b(pack.gradient[k][0][l], pack.gradient[k][1][l], pack.gradient[k][2][l]);
      const dvec3 f = -pack.volume[l] * (P * b);
      sum += f;
      for (int d = 0; d < 3; ++d) visit.f[k + 1][d][l] = share[l] * visit.f[k + 1][d][l] + f[d];
    }
    for (int d = 0; d < 3; ++d) visit.f[0][d][l] = share[l] * visit.f[0][d][l] - sum[d];
  }
}

}  // namespace pliant
