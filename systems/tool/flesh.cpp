#include "systems/tool/flesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/assert.h"
#include "systems/tool/polar.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kFlat = 1e-9;     // [1] volume over the longest edge cubed below which a rest shape counts as flat
constexpr double kFeather = 1e-6;  // [1] of the mean: mass of a node that only flat elements hold, so that A is regular

// The four rest gradients b_i: rows of the inverse of the edges. Right for either orientation. Returns the volume, 0
// if the element is flat.
double rest_shape(const std::vector<dvec3>& nodes, const Tet& t, std::array<dvec3, 4>& b) {
  const dvec3 u = nodes[t[1]] - nodes[t[0]], v = nodes[t[2]] - nodes[t[0]], w = nodes[t[3]] - nodes[t[0]];
  const double six_volumes = dot(cross(u, v), w);
  const double longest2 =
      std::max({dot(u, u), dot(v, v), dot(w, w), dot(u - v, u - v), dot(u - w, u - w), dot(v - w, v - w)});
  if (!(std::abs(six_volumes) > 6 * kFlat * longest2 * std::sqrt(longest2))) return 0.0;
  b[1] = cross(v, w) / six_volumes;
  b[2] = cross(w, u) / six_volumes;
  b[3] = cross(u, v) / six_volumes;
  b[0] = -(b[1] + b[2] + b[3]);
  return std::abs(six_volumes) / 6;
}

// sum x_i b_i^T; as b_i sum to zero, node 0 is where differences start, which keeps digits far from the origin.
dmat3 gradient_of(const std::vector<dvec3>& x, const Tet& t, const std::array<dvec3, 4>& b) {
  const dvec3 u = x[t[1]] - x[t[0]], v = x[t[2]] - x[t[0]], w = x[t[3]] - x[t[0]];
  return {u * b[1].x + v * b[2].x + w * b[3].x, u * b[1].y + v * b[2].y + w * b[3].y,
          u * b[1].z + v * b[2].z + w * b[3].z};
}

struct Symmetric {
  double xx, yy, zz, xy, xz, yz;
  dvec3 operator*(dvec3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

Symmetric symmetric_part(const dmat3& G) {
  return {G[0][0], G[1][1], G[2][2], 0.5 * (G[0][1] + G[1][0]), 0.5 * (G[0][2] + G[2][0]), 0.5 * (G[1][2] + G[2][1])};
}

Symmetric strain(const dmat3& G) {
  Symmetric e = symmetric_part(G);
  e.xx -= 1, e.yy -= 1, e.zz -= 1;
  return e;
}

// sigma of a strain, times a volume: lambda and mu come in with it.
Symmetric stress(const Symmetric& e, double lambda, double mu) {
  const double p = lambda * (e.xx + e.yy + e.zz), m = 2 * mu;
  return {m * e.xx + p, m * e.yy + p, m * e.zz + p, m * e.xy, m * e.xz, m * e.yz};
}

// `to` (row major) += p_i c_j^T + q_j c_i^T + d I, with p = V lambda c, q = V mu c, d = V mu b_i . b_j: one K'_ij.
inline void add_block(double* __restrict to, dvec3 pi, dvec3 cj, dvec3 qj, dvec3 ci, double d) {
  to[0] += pi.x * cj.x + qj.x * ci.x + d;
  to[1] += pi.x * cj.y + qj.x * ci.y;
  to[2] += pi.x * cj.z + qj.x * ci.z;
  to[3] += pi.y * cj.x + qj.y * ci.x;
  to[4] += pi.y * cj.y + qj.y * ci.y + d;
  to[5] += pi.y * cj.z + qj.y * ci.z;
  to[6] += pi.z * cj.x + qj.z * ci.x;
  to[7] += pi.z * cj.y + qj.z * ci.y;
  to[8] += pi.z * cj.z + qj.z * ci.z + d;
}

void add(Vector& to, std::uint32_t node, dvec3 f) {
  to[3 * node] += f.x, to[3 * node + 1] += f.y, to[3 * node + 2] += f.z;
}

}  // namespace

// K' enters A with T^2 + T beta, f_el the right-hand side with T.
struct Flesh::Scale {
  double T, stiffness;
};

Flesh::Flesh(const TetMesh& mesh, const FleshMaterial& material, std::uint32_t moving)
    : mesh_(mesh), material_(material), moving_(moving), x_(mesh.nodes), v_(mesh.nodes.size(), dvec3(0)) {
  ASSERT(moving >= mesh.free_count && moving <= mesh.pinned_begin());
  ASSERT(mesh.pinned_begin() <= mesh.node_count());
  ASSERT(material.young > 0 && material.density > 0 && material.poisson > -1 && material.poisson < 0.5);
  mu_ = material.young / (2 * (1 + material.poisson));
  lambda_ = material.young * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
  take_elements();
  lay_out();
  right_.setZero(3 * mesh.pinned_begin());
  force_.setZero(3 * mesh.node_count());
}

void Flesh::take_elements() {
  mass_.assign(mesh_.nodes.size(), 0.0);
  double total = 0.0;
  for (const Tet& tet : mesh_.tets) {
    Element element;
    element.node = tet;
    std::sort(element.node.begin(), element.node.end());
    ASSERT(element.node[3] < mesh_.node_count());
    element.volume = rest_shape(mesh_.nodes, element.node, element.gradient);
    if (element.volume == 0.0) continue;
    elements_.push_back(element);
    for (const std::uint32_t node : element.node) mass_[node] += material_.density * element.volume / 4;
    total += material_.density * element.volume;
  }
  const double feather =
      total > 0 ? kFeather * total / static_cast<double>(mass_.size()) : material_.density * kFeather;
  for (double& m : mass_)
    if (m == 0.0) m = feather;
  const auto on_border = [this](const Element& e) { return e.node[3] >= moving_; };
  std::stable_sort(elements_.begin(), elements_.end(), [&](const Element& a, const Element& b) {
    return std::pair(on_border(a), a.node) < std::pair(on_border(b), b.node);
  });
  inside_ = static_cast<std::size_t>(std::find_if(elements_.begin(), elements_.end(), on_border) - elements_.begin());
  rotation_.assign(elements_.size(), dquat(1, 0, 0, 0));
}

void Flesh::lay_out() {
  std::vector<Tet> stiff;
  for (const Element& element : elements_) stiff.push_back(element.node);
  inner_ = make_pattern(moving_, stiff);
  for (std::uint32_t row = 0; row < moving_; ++row)
    for (std::uint32_t k = inner_.diagonal[row] + 1; k < inner_.first[row + 1]; ++k)
      inner_mirror_.push_back({k, inner_.find(inner_.column[k], row)});

  // Pairs with a handle node that has no row of its own, sorted, each once; corner has its diagonal and both triangles.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  const std::uint32_t end = mesh_.pinned_begin();
  std::vector<Pair> outer, corner;
  for (std::uint32_t node = moving_; node < end; ++node) corner.emplace_back(node, node);
  for (const Element& element : elements_)
    for (const std::uint32_t i : element.node)
      for (const std::uint32_t j : element.node) {
        if (j < moving_ || j >= end || i >= end) continue;
        (i < moving_ ? outer : corner).emplace_back(i, j);
      }
  const auto list = [](std::vector<Pair>& pairs, std::vector<Entry>& entries) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const Pair& pair : pairs) entries.push_back({pair.first, pair.second, Block::Zero()});
  };
  list(outer, outer_);
  list(corner, corner_);
  const auto place = [](const std::vector<Pair>& pairs, std::uint32_t i, std::uint32_t j) {
    return static_cast<std::uint32_t>(std::lower_bound(pairs.begin(), pairs.end(), Pair(i, j)) - pairs.begin());
  };
  for (const Pair& pair : corner)
    if (pair.first < pair.second)
      corner_mirror_.push_back({place(corner, pair.first, pair.second), place(corner, pair.second, pair.first)});
  for (const Element& element : elements_) {
    Slots slots;
    std::size_t k = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a; b < 4; ++b) {
        const std::uint32_t i = element.node[a], j = element.node[b];
        slots[k++] = j >= end      ? kNone
                     : j < moving_ ? inner_.find(i, j)
                     : i < moving_ ? place(outer, i, j)
                                   : place(corner, i, j);
      }
    slots_.push_back(slots);
  }
}

double* Flesh::block(std::uint32_t row, std::uint32_t column, std::uint32_t slot) {
  if (slot == kNone) return nullptr;
  return column < moving_ ? inner_.value[slot].data()
         : row < moving_  ? outer_[slot].value.data()
                          : corner_[slot].value.data();
}

void Flesh::assemble(double T, dvec3 gravity, const std::vector<dvec3>* begin) {
  for (Block& value : inner_.value) value.setZero();
  for (Entry& entry : outer_) entry.value.setZero();
  for (Entry& entry : corner_) entry.value.setZero();
  right_.setZero();
  force_.setZero();
  const Scale scale{T, T * T + T * material_.beta};
  for (std::size_t e = 0; e < elements_.size(); ++e) add_element(e, scale, begin ? *begin : x_);
  mirror();
  add_masses(T, gravity);
}

void Flesh::add_element(std::size_t e, const Scale& scale, const std::vector<dvec3>& begin) {
  const Element& element = elements_[e];
  const dmat3 F = gradient_of(x_, element.node, element.gradient);
  if (material_.strain == Strain::kCorotational) extract_rotation(F, rotation_[e]);
  const dmat3 R = mat3_cast(rotation_[e]);
  std::array<dvec3, 4> c;
  for (int i = 0; i < 4; ++i) c[i] = R * element.gradient[i];

  const double lambda = element.volume * lambda_, mu = element.volume * mu_;
  const Symmetric sigma = stress(strain(F * transpose(R)), lambda, mu);
  std::array<dvec3, 4> f;
  for (int i = 0; i < 4; ++i) f[i] = -(sigma * c[i]), add(force_, element.node[i], f[i]);
  if (&begin != &x_) {  // f_el + K' (x - begin): the stress of where the step began, turned as the guess is
    const Symmetric linear =
        stress(strain(gradient_of(begin, element.node, element.gradient) * transpose(R)), lambda, mu);
    for (int i = 0; i < 4; ++i) f[i] = -(linear * c[i]);
  }
  for (int i = 0; i < 4; ++i)
    if (element.node[i] < mesh_.pinned_begin()) add(right_, element.node[i], scale.T * f[i]);

  const double l = scale.stiffness * lambda, m = scale.stiffness * mu;
  const Slots& slots = slots_[e];
  std::size_t k = 0;
  for (int i = 0; i < 4; ++i) {
    const dvec3 p = l * c[i];
    for (int j = i; j < 4; ++j, ++k) {
      double* const to = block(element.node[i], element.node[j], slots[k]);
      if (to) add_block(to, p, c[j], m * c[j], c[i], m * dot(c[i], c[j]));
    }
  }
  if (element.node[3] >= mesh_.pinned_begin()) add_told(element, c, scale);
}

// Pinned nodes have no rows: what A says of their velocities goes to the right. sum_p K'_ip v_p is -f of the strain
// that those velocities make.
void Flesh::add_told(const Element& element, const std::array<dvec3, 4>& c, const Scale& scale) {
  dmat3 L(0);
  for (int i = 0; i < 4; ++i)
    if (element.node[i] >= mesh_.pinned_begin()) L += outerProduct(v_[element.node[i]], c[i]);
  const double factor = scale.stiffness * element.volume;
  const Symmetric sigma = stress(symmetric_part(L), factor * lambda_, factor * mu_);
  for (int i = 0; i < 4; ++i)
    if (element.node[i] < mesh_.pinned_begin()) add(right_, element.node[i], -(sigma * c[i]));
}

// Only upper blocks were added to. Diagonal ones are symmetric but for rounding; a solver may read either half.
void Flesh::mirror() {
  const auto even = [](Block& b) { b(1, 0) = b(0, 1), b(2, 0) = b(0, 2), b(2, 1) = b(1, 2); };
  for (const std::uint32_t k : inner_.diagonal) even(inner_.value[k]);
  for (Entry& entry : corner_)
    if (entry.row == entry.column) even(entry.value);
  for (const auto& [upper, lower] : inner_mirror_) inner_.value[lower] = inner_.value[upper].transpose();
  for (const auto& [upper, lower] : corner_mirror_) corner_[lower].value = corner_[upper].value.transpose();
}

void Flesh::add_masses(double T, dvec3 gravity) {
  const double damped = 1 + T * material_.alpha;
  for (std::uint32_t i = 0; i < mesh_.pinned_begin(); ++i) add(right_, i, mass_[i] * (v_[i] + T * gravity));
  for (std::uint32_t i = 0; i < moving_; ++i) inner_.value[inner_.diagonal[i]].diagonal().array() += mass_[i] * damped;
  for (Entry& entry : corner_)
    if (entry.row == entry.column) entry.value.diagonal().array() += mass_[entry.row] * damped;
}

double Flesh::elastic_energy() const {
  double energy = 0.0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const dmat3 F = gradient_of(x_, element.node, element.gradient);
    dquat q = rotation_[e];
    if (material_.strain == Strain::kCorotational) extract_rotation(F, q);
    const Symmetric eps = strain(F * transpose(mat3_cast(q)));
    const double trace = eps.xx + eps.yy + eps.zz;
    const double square =
        eps.xx * eps.xx + eps.yy * eps.yy + eps.zz * eps.zz + 2 * (eps.xy * eps.xy + eps.xz * eps.xz + eps.yz * eps.yz);
    energy += element.volume * (mu_ * square + 0.5 * lambda_ * trace * trace);
  }
  return energy;
}

}  // namespace pliant
