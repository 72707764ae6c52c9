#include "systems/soft/fem/cavity.h"

#include <cmath>

namespace pliant {
namespace {

void add_node(Vector& to, std::uint32_t node, dvec3 f) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  to[i] += f.x, to[i + 1] += f.y, to[i + 2] += f.z;
}

double dot_nodes(const Vector& g, const std::vector<dvec3>& x, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t n = from; n < to; ++n)
    for (int k = 0; k < 3; ++k) sum += g[3 * static_cast<Eigen::Index>(n) + k] * x[n][k];
  return sum;
}

}  // namespace

Cavities::Cavities(const TetMesh& mesh) : cavities_(mesh.cavities) {
  for (std::size_t c = 0; c < count(); ++c) rest_.push_back(volume(c, mesh.nodes));
}

// Relative to a corner, for precision far from the origin.
double Cavities::volume(std::size_t cavity, const std::vector<dvec3>& x) const {
  const std::vector<uvec3>& wall = cavities_[cavity].wall;
  const dvec3 o = x[wall.front().x];
  double six = 0.0;
  for (const uvec3& t : wall) six += dot(x[t.x] - o, cross(x[t.y] - o, x[t.z] - o));
  return six / 6;
}

Vector Cavities::gradient(std::size_t cavity, const std::vector<dvec3>& x) const {
  Vector g = Vector::Zero(3 * static_cast<Eigen::Index>(x.size()));
  const std::vector<uvec3>& wall = cavities_[cavity].wall;
  const dvec3 o = x[wall.front().x];
  for (const uvec3& t : wall) {
    const dvec3 a = x[t.x] - o, b = x[t.y] - o, c = x[t.z] - o;
    add_node(g, t.x, cross(b, c) / 6.0), add_node(g, t.y, cross(c, a) / 6.0), add_node(g, t.z, cross(a, b) / 6.0);
  }
  return g;
}

double Cavities::pressure(std::size_t cavity, const std::vector<dvec3>& x) const {
  return cavities_[cavity].pressure + cavities_[cavity].bulk * (1.0 - volume(cavity, x) / rest_[cavity]);
}

double Cavities::energy(const std::vector<dvec3>& x) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < count(); ++c) {
    const double V = volume(c, x), d = V - rest_[c];
    sum += 0.5 * cavities_[c].bulk * d * d / rest_[c] - cavities_[c].pressure * V;
  }
  return sum;
}

void Cavities::add_forces(const std::vector<dvec3>& x, Vector& force) const {
  for (std::size_t c = 0; c < count(); ++c) force += pressure(c, x) * gradient(c, x);
}

void Cavities::assemble(double T, std::uint32_t moving, const std::vector<dvec3>& x, const std::vector<dvec3>& v,
                        const std::vector<dvec3>* begin, Rows& columns, Vector& right) const {
  columns.setZero(3 * static_cast<Eigen::Index>(moving), static_cast<Eigen::Index>(count()));
  for (std::size_t c = 0; c < count(); ++c) {
    const Vector g = gradient(c, x);
    const double stiffness = cavities_[c].bulk / rest_[c];  // [N/m5]
    columns.col(static_cast<Eigen::Index>(c)) = T * std::sqrt(stiffness) * g.head(columns.rows());
    double along = -T * dot_nodes(g, v, moving, x.size());
    if (begin) along += dot_nodes(g, x, 0, x.size()) - dot_nodes(g, *begin, 0, x.size());
    right += T * (pressure(c, x) + stiffness * along) * g.head(right.size());
  }
}

}  // namespace pliant
