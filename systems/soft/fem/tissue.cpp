#include "systems/soft/fem/tissue.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/assert.h"
#include "runtime/tasks.h"
#include "systems/soft/linear/low_rank_solver.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoElement = 0xffffffffu;
constexpr double kFeather = 1e-6;  // [1] of the mean: mass of a node with only flat elements, so that A is regular

// `to` (row major) += K.
inline void add_block(double* __restrict to, const dmat3& K) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to[3 * i + j] += K[j][i];
}

dmat3 block_of(const LawBlocks& blocks, std::size_t n, std::size_t lane) {
  dmat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[j][i] = blocks.of[n][i][j][lane];
  return out;
}

// K' u of an element.
std::array<dvec3, 4> product(const LawBlocks& blocks, std::size_t lane, const std::array<dvec3, 4>& u) {
  std::array<dvec3, 4> out{};
  std::size_t n = 0;
  for (int k = 1; k < 4; ++k)
    for (int l = k; l < 4; ++l, ++n) {
      const dmat3 K = block_of(blocks, n, lane);
      out[k] += K * (u[l] - u[0]);
      if (l > k) out[l] += transpose(K) * (u[k] - u[0]);
    }
  out[0] = -(out[1] + out[2] + out[3]);
  return out;
}

}  // namespace

Tissue::Tissue(const TetMesh& mesh, const TissueMaterial& material, std::uint32_t moving)
    : mesh_(mesh),
      material_(material),
      moving_(moving),
      x_(mesh.nodes),
      v_(mesh.nodes.size(), dvec3(0)),
      cavities_(mesh) {
  ASSERT(moving >= mesh.free_count && moving <= mesh.pinned_begin());
  ASSERT(mesh.pinned_begin() <= mesh.node_count());
  ASSERT(material.young > 0 && material.density > 0 && material.poisson > -1 && material.poisson < 0.5);
  set_material(material);
  if (mesh.cells.empty())
    take_elements();
  else
    hexahedra_ = make_hexahedra(mesh);
  if (!mesh.factors.empty())
    for (const Hexahedron& hex : hexahedra_) relaxation_.push_back(hex.relaxation);
  take_masses();
  take_memory();
  lay_out();
  right_.setZero(3 * mesh.pinned_begin());
  force_.setZero(3 * mesh.node_count());
}

void Tissue::set_material(const TissueMaterial& now) {
  const double density = material_.density;
  const bool relaxes_else = !(now.prony == memory_.prony());
  material_ = now;
  material_.density = density;
  mu_ = now.young / (2 * (1 + now.poisson));
  lambda_ = now.young * now.poisson / ((1 + now.poisson) * (1 - 2 * now.poisson));
  law_ = now.strain == Strain::kLinear || !mesh_.cells.empty() ? nullptr : elastic_law(now.law);
  if (relaxes_else) take_memory();
  if (memory_.empty() || relaxes_else) return;
  std::vector<double> stress;
  find_stress(stress);
  memory_.replace(stress);
}

void Tissue::take_elements() {
  struct Element {
    Tet tet;
    ElementFactors factors;
  };
  std::vector<Element> elements;
  elements.reserve(mesh_.tets.size());
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    elements.push_back({mesh_.tets[t], mesh_.factors.empty() ? ElementFactors{} : mesh_.factors[t]});
    std::sort(elements[t].tet.begin(), elements[t].tet.end());  // a pair is then always in the upper triangle
  }
  std::sort(elements.begin(), elements.end(), [](const Element& a, const Element& b) { return a.tet < b.tet; });
  for (const Element& element : elements) {
    ASSERT(element.tet[3] < mesh_.node_count());
    std::array<dvec3, 3> b;
    const double volume = rest_shape(mesh_.nodes, element.tet, b);
    if (volume == 0.0) continue;
    if (packs_.empty() || packs_.back().count == kElementLanes) packs_.emplace_back();
    ElementPack& pack = packs_.back();
    const std::size_t lane = pack.count++;
    pack.node[lane] = element.tet;
    pack.volume[lane] = element.factors.stiffness * volume;  // forces are linear in both
    for (int k = 0; k < 3; ++k)
      for (int d = 0; d < 3; ++d) pack.gradient[k][d][lane] = b[k][d];
    pack.q[0][lane] = 1.0;
    if (mesh_.factors.empty()) continue;
    damping_.push_back(element.factors.damping);
    relaxation_.push_back(element.factors.relaxation);
  }
}

void Tissue::take_masses() {
  std::vector<double> volume = mesh_.volume;
  if (volume.empty()) {
    volume.assign(mesh_.nodes.size(), 0.0);
    std::vector<Tet> tets = mesh_.tets;
    for (Tet& tet : tets) std::sort(tet.begin(), tet.end());
    std::sort(tets.begin(), tets.end());
    std::array<dvec3, 3> gradient;
    for (const Tet& tet : tets)
      for (const std::uint32_t node : tet) volume[node] += rest_shape(mesh_.nodes, tet, gradient) / 4;
  }
  double total = 0.0;
  mass_.clear();
  for (const double each : volume) {
    mass_.push_back(material_.density * each);
    total += mass_.back();
  }
  const double feather =
      total > 0 ? kFeather * total / static_cast<double>(mass_.size()) : material_.density * kFeather;
  for (double& m : mass_)
    if (!(m > 0.0)) m = feather;
}

void Tissue::lay_out() {
  std::vector<Tet> stiff;
  for (const ElementPack& pack : packs_)
    stiff.insert(stiff.end(), pack.node.begin(), pack.node.begin() + static_cast<std::ptrdiff_t>(pack.count));
  for (const Hexahedron& hex : hexahedra_)
    for (const Tet& pairs : pairs_of(hex.node)) stiff.push_back(pairs);
  inner_ = make_pattern(moving_, stiff);
  for (std::uint32_t row = 0; row < moving_; ++row)
    for (std::uint32_t k = inner_.diagonal[row] + 1; k < inner_.first[row + 1]; ++k)
      inner_mirror_.push_back({k, inner_.find(inner_.column[k], row)});

  // Pairs with a handle node that has no row, sorted, each once; corner has its diagonal and both triangles.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  const std::uint32_t end = mesh_.pinned_begin();
  std::vector<Pair> outer, corner;
  for (std::uint32_t node = moving_; node < end; ++node) corner.emplace_back(node, node);
  for (const Tet& tet : stiff)
    for (const std::uint32_t i : tet)
      for (const std::uint32_t j : tet) {
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
  const auto slots_of = [&](const auto& node, auto& slots) {
    std::size_t k = 0;
    for (std::size_t a = 0; a < node.size(); ++a)
      for (std::size_t b = a; b < node.size(); ++b) {
        const std::uint32_t i = node[a], j = node[b];
        slots[k++] = j >= end      ? kNoElement
                     : j < moving_ ? inner_.find(i, j)
                     : i < moving_ ? place(outer, i, j)
                                   : place(corner, i, j);
      }
  };
  for (const ElementPack& pack : packs_)
    for (std::size_t lane = 0; lane < pack.count; ++lane) slots_of(pack.node[lane], slots_.emplace_back());
  for (const Hexahedron& hex : hexahedra_) slots_of(hex.node, hex_slots_.emplace_back());
  share_packs();
}

double* Tissue::block(std::uint32_t row, std::uint32_t column, std::uint32_t slot) {
  if (slot == kNoElement) return nullptr;
  return column < moving_ ? inner_.value[slot].data()
         : row < moving_  ? outer_[slot].value.data()
                          : corner_[slot].value.data();
}

void Tissue::visit(std::size_t number, const std::vector<dvec3>& x, ElementVisit& out) const {
  const ElementPack& pack = packs_[number];
  take_edges(pack, x, out);
  if (law_) {
    take_law_forces(pack, law_, {mu_, lambda_, material_.stiffening}, out);
    if (memory_.empty()) return;
    take_rotations(pack, out);
    return add_history(number, out);
  }
  if (material_.strain == Strain::kCorotational)
    take_rotations(pack, out);
  else
    std::memcpy(out.q, pack.q, sizeof out.q);
  turn_gradients(pack, out);
  take_forces(pack, lambda_, mu_, out);
  if (!memory_.empty()) add_history(number, out);
}

void Tissue::assemble(double T, dvec3 gravity, const std::vector<dvec3>* begin) {
  for (Block& value : inner_.value) value.setZero();
  for (Entry& entry : outer_) entry.value.setZero();
  for (Entry& entry : corner_) entry.value.setZero();
  right_.setZero();
  force_.setZero();
  const Scale scale{T, material_.beta};
  if (!relaxed_) memory_.begin(T), step_ = T;
  if (law_) {
    assemble_law(scale, begin);
    add_fibres(T, begin);
    mirror();
    return add_masses(T, gravity, begin);
  }
  turn_packs();
  run_tasks(shares_.size(), [&](std::size_t i, unsigned) { assemble_share(shares_[i], scale, begin); });
  add_cells(scale, begin);
  add_fibres(T, begin);
  mirror();
  add_masses(T, gravity, begin);
}

// The right-hand side has f_el + K' (x - begin), the forces linearised about x, at the beginning of the step; and, of
// pinned nodes, their velocities as displacements: A times these.
void Tissue::assemble_law(const Scale& scale, const std::vector<dvec3>* begin) {
  const LawConstants constants{mu_, lambda_, material_.stiffening};
  const std::uint32_t end = mesh_.pinned_begin();
  ElementVisit now;
  LawBlocks blocks;
  const Slots* slots = slots_.data();
  const double* damping = damping_.data();
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    ElementPack& pack = packs_[p];
    take_edges(pack, x_, now);
    take_law_forces(pack, law_, constants, now);
    take_rotations(pack, now);
    take_law_blocks(pack, law_, constants, now, blocks);
    if (!memory_.empty()) add_history(p, now);
    std::memcpy(pack.q, now.q, sizeof now.q);
    for (std::size_t lane = 0; lane < pack.count; ++lane, ++slots) {
      const Tet& tet = pack.node[lane];
      const double share = pack_share(p, lane), stiffness = scale.stiffness(damping_.empty() ? 1.0 : *damping++, share);
      add_law_blocks(tet, lane, *slots, stiffness, blocks);
      std::array<dvec3, 4> shift{};  // K' times these is on the right
      if (begin)
        for (int i = 0; i < 4; ++i) shift[i] = scale.T * share * (x_[tet[i]] - (*begin)[tet[i]]);
      if (tet[3] >= end)
        for (int i = 0; i < 4; ++i)
          if (tet[i] >= end) shift[i] -= stiffness * v_[tet[i]];
      std::array<dvec3, 4> pull{};
      if (begin || tet[3] >= end) pull = product(blocks, lane, shift);
      for (int i = 0; i < 4; ++i) {
        const dvec3 f = lane_of(now.f[i], lane);
        add(force_, tet[i], f);
        if (tet[i] < end) add(right_, tet[i], scale.T * f + pull[i]);
      }
    }
  }
}

void Tissue::add_law_blocks(const Tet& tet, std::size_t lane, const Slots& slots, double stiffness,
                            const LawBlocks& blocks) {
  dmat3 row[3], first(0);  // sums over the rows of nodes 1, 2, 3
  for (dmat3& sum : row) sum = dmat3(0);
  std::size_t n = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = k; l < 3; ++l, ++n) {
      const dmat3 K = stiffness * block_of(blocks, n, lane);
      row[k] += K;
      if (l > k) row[l] += transpose(K);
      if (double* const to = block(tet[k + 1], tet[l + 1], slots[4 + n])) add_block(to, K);
    }
  for (int l = 0; l < 3; ++l) {
    first += row[l];
    if (double* const to = block(tet[0], tet[l + 1], slots[static_cast<std::size_t>(l) + 1]))
      add_block(to, -transpose(row[l]));
  }
  if (double* const to = block(tet[0], tet[0], slots[0])) add_block(to, first);
}

dquat Tissue::turned(const Hexahedron& hex, const std::vector<dvec3>& x) const {
  return material_.strain == Strain::kCorotational ? rotation_of(hex, x) : hex.q;
}

void Tissue::add_cells(const Scale& scale, const std::vector<dvec3>* begin) {
  const std::uint32_t end = mesh_.pinned_begin();
  HexVisit now;
  for (std::size_t e = 0; e < hexahedra_.size(); ++e) {
    Hexahedron& hex = hexahedra_[e];
    hex.q = turned(hex, x_);
    turn_cell(hex, hex.q, now);
    find_cell_forces(hex, x_, lambda_, mu_, now);
    find_cell_stiffness(hex, lambda_, mu_, now);
    add_cell_memory(e, x_, now);
    for (std::size_t i = 0; i < 8; ++i) add(force_, hex.node[i], now.f[i]);
    const double stiffness = scale.stiffness(hex.damping, cell_share(e));
    std::size_t k = 0;
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = i; j < 8; ++j, ++k) {
        const dmat3 K = stiffness * now.K[k];
        if (double* const to = block(hex.node[i], hex.node[j], hex_slots_[e][k])) add_block(to, K);
        // As in add_prescribed().
        if (hex.node[i] < end && hex.node[j] >= end) add(right_, hex.node[i], -(K * v_[hex.node[j]]));
      }
    if (begin) {
      find_cell_forces(hex, *begin, lambda_, mu_, now);
      add_cell_memory(e, *begin, now);
    }
    for (std::size_t i = 0; i < 8; ++i)
      if (hex.node[i] < end) add(right_, hex.node[i], scale.T * now.f[i]);
  }
}

void Tissue::find_forces() {
  force_.setZero();
  ElementVisit now;
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    ElementPack& pack = packs_[p];
    visit(p, x_, now);
    if (!law_) std::memcpy(pack.q, now.q, sizeof now.q);
    for (std::size_t lane = 0; lane < pack.count; ++lane)
      for (int i = 0; i < 4; ++i) add(force_, pack.node[lane][i], lane_of(now.f[i], lane));
  }
  HexVisit of_cell;
  for (std::size_t e = 0; e < hexahedra_.size(); ++e) {
    Hexahedron& hex = hexahedra_[e];
    hex.q = turned(hex, x_);
    turn_cell(hex, hex.q, of_cell);
    find_cell_forces(hex, x_, lambda_, mu_, of_cell);
    add_cell_memory(e, x_, of_cell);
    for (std::size_t i = 0; i < 8; ++i) add(force_, hex.node[i], of_cell.f[i]);
  }
  cavities_.add_forces(x_, force_);
  add_fibre_forces(force_);
}

void Tissue::add_masses(double T, dvec3 gravity, const std::vector<dvec3>* begin) {
  const double damped = 1 + T * material_.alpha;
  for (std::uint32_t i = 0; i < mesh_.pinned_begin(); ++i) add(right_, i, mass_[i] * (v_[i] + T * gravity));
  for (std::uint32_t i = 0; i < moving_; ++i) inner_.value[inner_.diagonal[i]].diagonal().array() += mass_[i] * damped;
  for (Entry& entry : corner_)
    if (entry.row == entry.column) entry.value.diagonal().array() += mass_[entry.row] * damped;
  if (cavities_.empty()) return;
  cavities_.add_forces(x_, force_);
  cavities_.assemble(T, moving_, x_, v_, begin, low_rank_, right_);
}

void Tissue::multiply(const Vector& x, Vector& out) const {
  inner_.multiply(x, out);
  if (low_rank_.cols() > 0) out += low_rank_ * (low_rank_.transpose() * x);
}

std::unique_ptr<LinearSolver> solver_of(const Tissue& tissue, std::unique_ptr<LinearSolver> solver) {
  if (tissue.cavities().empty()) return solver;
  return std::make_unique<LowRankSolver>(std::move(solver), tissue.low_rank());
}

double Tissue::elastic_energy(const std::vector<dvec3>& position) const {
  double energy = cavities_.energy(position) + fibre_energy(position);
  ElementVisit now;
  for (std::size_t p = 0; p < packs_.size(); ++p) {
    visit(p, position, now);
    for (std::size_t lane = 0; lane < packs_[p].count; ++lane) energy += now.energy[lane];
  }
  HexVisit of_cell;
  for (std::size_t e = 0; e < hexahedra_.size(); ++e) {
    turn_cell(hexahedra_[e], turned(hexahedra_[e], position), of_cell);
    find_cell_forces(hexahedra_[e], position, lambda_, mu_, of_cell);
    add_cell_memory(e, position, of_cell);
    energy += of_cell.energy;
  }
  return energy;
}

}  // namespace pliant
