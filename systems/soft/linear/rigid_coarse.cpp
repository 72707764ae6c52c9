#include "systems/soft/linear/rigid_coarse.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoGroup = 0xffffffff;
constexpr std::uint32_t kGroupNodes = 40;  // fewer: better corrections, but a more expensive coarse system
constexpr double kFaintest = 1e-8;         // [1] of a group's rotational stiffness, added to it

// Adjacency lists, in both directions.
std::vector<std::vector<std::uint32_t>> neighbours(const HalfPattern& pattern) {
  std::vector<std::vector<std::uint32_t>> out(pattern.size());
  for (std::uint32_t i = 0; i < pattern.size(); ++i)
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k) {
      out[i].push_back(pattern.column[k]);
      out[pattern.column[k]].push_back(i);
    }
  return out;
}

// Balls of nodes grown breadth first; small remainders join a neighbour.
std::vector<std::uint32_t> grow_groups(const HalfPattern& pattern, std::uint32_t& count) {
  const auto next_to = neighbours(pattern);
  std::vector<std::uint32_t> group(pattern.size(), kNoGroup), ball;
  count = 0;
  for (std::uint32_t seed = 0; seed < pattern.size(); ++seed) {
    if (group[seed] != kNoGroup) continue;
    ball.assign(1, seed);
    group[seed] = count;
    std::uint32_t other = kNoGroup;
    for (std::size_t head = 0; head < ball.size(); ++head)
      for (const std::uint32_t j : next_to[ball[head]]) {
        if (group[j] == kNoGroup && ball.size() < kGroupNodes) group[j] = count, ball.push_back(j);
        if (group[j] < count) other = group[j];
      }
    if (ball.size() < kGroupNodes / 3 && other != kNoGroup)
      for (const std::uint32_t i : ball) group[i] = other;
    else
      ++count;
  }
  return group;
}

// w x arm as a matrix on w.
Block turn_matrix(dvec3 arm) {
  Block R;
  R << 0, arm.z, -arm.y, -arm.z, 0, arm.x, arm.y, -arm.x, 0;
  return R;
}

}  // namespace

void RigidCoarse::analyse(const HalfPattern& pattern) {
  group_ = grow_groups(pattern, groups_);
  std::vector<std::array<std::uint32_t, 4>> pairs;
  const auto couple = [&](std::uint32_t a, std::uint32_t b) { pairs.push_back({2 * a, 2 * a + 1, 2 * b, 2 * b + 1}); };
  for (std::uint32_t g = 0; g < groups_; ++g) couple(g, g);
  for (std::uint32_t i = 0; i < pattern.size(); ++i)
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k)
      if (group_[i] != group_[pattern.column[k]]) couple(group_[i], group_[pattern.column[k]]);
  matrix_ = make_pattern(2 * groups_, pairs);
  mirror_.clear();
  for (std::uint32_t row = 0; row < matrix_.size; ++row)
    for (std::uint32_t k = matrix_.diagonal[row]; k < matrix_.first[row + 1]; ++k)
      mirror_.emplace_back(k, matrix_.find(matrix_.column[k], row));
  slot_.clear();
  for (std::uint32_t i = 0; i < pattern.size(); ++i) {
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k)
      slot_.push_back(find_slot(group_[i], group_[pattern.column[k]]));
    own_.push_back(find_slot(group_[i], group_[i]));
  }
  solver_.analyse(matrix_);
}

RigidCoarse::Slot RigidCoarse::find_slot(std::uint32_t a, std::uint32_t b) const {
  return {matrix_.find(2 * a, 2 * b), matrix_.find(2 * a + 1, 2 * b)};
}

void RigidCoarse::place(const HalfPattern& pattern, const std::vector<dvec3>& position) {
  arm_.assign(pattern.size(), dvec3(0));
  if (position.empty()) return;
  ASSERT(position.size() >= pattern.size());
  std::vector<dvec3> centre(groups_, dvec3(0));
  std::vector<double> count(groups_, 0.0);
  for (std::uint32_t i = 0; i < pattern.size(); ++i)
    centre[group_[i]] += position[pattern.old_of_new[i]], count[group_[i]] += 1;
  double length = 0;
  for (std::uint32_t i = 0; i < pattern.size(); ++i) {
    arm_[i] = position[pattern.old_of_new[i]] - centre[group_[i]] / count[group_[i]];
    length = std::max(length, dot(arm_[i], arm_[i]));
  }
  if (length > 0)
    for (dvec3& arm : arm_) arm /= std::sqrt(length);
}

// S = the strict lower half's part of P^T A P and half of the diagonal's; the matrix is S + S^T.
bool RigidCoarse::factorise(const HalfPattern& pattern, const HalfMatrix<double>& a,
                            const std::vector<dvec3>& position) {
  place(pattern, position);
  for (Block& value : matrix_.value) value.setZero();
  const auto add = [&](Slot slot, const Block& A, const Block& Ri, const Block& Rj) {
    const Block drift_turn = A.lazyProduct(Rj);
    matrix_.value[slot.drift] += A;
    matrix_.value[slot.drift + 1] += drift_turn;
    matrix_.value[slot.turn].noalias() += Ri.transpose().lazyProduct(A);
    matrix_.value[slot.turn + 1].noalias() += Ri.transpose().lazyProduct(drift_turn);
  };
  for (std::uint32_t i = 0; i < pattern.size(); ++i) {
    const Block Ri = turn_matrix(arm_[i]);
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k)
      add(slot_[k], Eigen::Map<const Block>(a.block.data() + 9 * k), Ri, turn_matrix(arm_[pattern.column[k]]));
    add(own_[i], 0.5 * Eigen::Map<const Block>(a.diagonal.data() + 9 * i), Ri, Ri);
  }
  for (const auto& [k, m] : mirror_) {
    matrix_.value[k] += matrix_.value[m].transpose().eval();
    matrix_.value[m] = matrix_.value[k].transpose().eval();
  }
  // Nodes on a line, or a single node, do not determine every rotation: such rotations are regularised away.
  for (std::uint32_t g = 0; g < groups_; ++g) {
    Block& turn = matrix_.value[matrix_.diagonal[2 * g + 1]];
    const double size = turn.trace();
    turn += (size > 0 ? kFaintest * size : 1.0) * Block::Identity();
  }
  right_.resize(6 * groups_), motion_.resize(6 * groups_);
  return solver_.factorise(matrix_);
}

template <class Scalar>
void RigidCoarse::add_correction(const Scalar* r, Scalar* z) const {
  right_.setZero();
  for (std::uint32_t i = 0; i < group_.size(); ++i) {
    const dvec3 f(r[4 * i], r[4 * i + 1], r[4 * i + 2]), turn = cross(arm_[i], f);
    double* const out = right_.data() + 6 * group_[i];
    out[0] += f.x, out[1] += f.y, out[2] += f.z;
    out[3] += turn.x, out[4] += turn.y, out[5] += turn.z;
  }
  solver_.solve(right_, motion_);
  for (std::uint32_t i = 0; i < group_.size(); ++i) {
    const double* const m = motion_.data() + 6 * group_[i];
    const dvec3 u = dvec3(m[0], m[1], m[2]) + cross(dvec3(m[3], m[4], m[5]), arm_[i]);
    z[4 * i] += static_cast<Scalar>(u.x), z[4 * i + 1] += static_cast<Scalar>(u.y);
    z[4 * i + 2] += static_cast<Scalar>(u.z);
  }
}
template void RigidCoarse::add_correction(const float*, float*) const;
template void RigidCoarse::add_correction(const double*, double*) const;

}  // namespace pliant
