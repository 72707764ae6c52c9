#include "systems/soft/contact/fill_operator.h"

#include <algorithm>
#include <numeric>

namespace pliant {
namespace {

// Motion of the k-th of a body's contacts per impulse at the m-th, k >= m.
Eigen::Matrix3d answer(const BodyResponse& response, Eigen::Index k, Eigen::Index m) {
  const Rows& lever = response.compliance.lever;
  Eigen::Matrix3d block = response.compliance.held.block<3, 3>(3 * k, 3 * m);
  if (lever.cols() > 0)
    block += lever.middleRows<3>(3 * k).leftCols<6>() * lever.middleRows<3>(3 * m).leftCols<6>().transpose();
  return block;
}

class OperatorFiller {
 public:
  OperatorFiller(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                 const Delassus& delassus, ContactProblem& problem)
      : bodies_(bodies), contacts_(contacts), delassus_(delassus), problem_(problem) {
    everyone_.resize(contacts.size());
    std::iota(everyone_.begin(), everyone_.end(), 0);
  }

  void fill() {
    for (int k = 0; k < std::max(problem_.part_count, 1); ++k) {
      ContactProblem& part = problem_.part_count > 0 ? problem_.parts[static_cast<std::size_t>(k)] : problem_;
      const std::vector<int>& members = problem_.part_count > 0 ? part.members : everyone_;
      part.sparse.clear();
      if (is_sparse(members))
        fill_columns(members, part.sparse);
      else
        clear_dense(members.size(), part.W);
    }
    fill_dense();
  }

 private:
  bool moves(std::uint32_t body) const { return bodies_[body]->size() > 0; }
  bool couples(std::uint32_t body) const { return moves(body) || bodies_[body]->yields(); }
  int local(int contact) const { return problem_.place[static_cast<std::size_t>(contact)].second; }
  ContactProblem& part_of(int contact) {
    if (problem_.part_count == 0) return problem_;
    return problem_.parts[static_cast<std::size_t>(problem_.place[static_cast<std::size_t>(contact)].first)];
  }
  const ContactPoint& at(int contact) const { return contacts_[static_cast<std::size_t>(contact)]; }

  // Many contacts and mostly zero blocks: a pile, not a hand.
  bool is_sparse(const std::vector<int>& members) const {
    if (members.size() <= kAlwaysDense) return false;
    std::size_t blocks = 0;
    for (const int i : members)
      for (const std::uint32_t b : {at(i).body_a, at(i).body_b})
        if (couples(b)) blocks += delassus_.of[b].contacts.size();
    return static_cast<double>(blocks) < kSparse * static_cast<double>(members.size() * members.size());
  }

  static void clear_dense(std::size_t contacts, Eigen::MatrixXd& w) {
    const auto rows = static_cast<Eigen::Index>(3 * contacts);
    if (w.rows() < rows) w.resize(rows, rows);
    w.topLeftCorner(rows, rows).setZero();
  }

  // The lower triangles body by body: contacts are in ascending order; the upper ones are mirrored.
  void fill_dense() {
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
      const BodyResponse& response = delassus_.of[b];
      if (!couples(b) || response.contacts.empty()) continue;
      ContactProblem& part = part_of(response.contacts.front());
      if (!part.sparse.first.empty() || !moves(b)) continue;
      const auto count = static_cast<Eigen::Index>(response.contacts.size());
      for (Eigen::Index k = 0; k < count; ++k)
        for (Eigen::Index m = 0; m <= k; ++m)
          part.W.block<3, 3>(3 * local(response.contacts[static_cast<std::size_t>(k)]),
                             3 * local(response.contacts[static_cast<std::size_t>(m)])) += answer(response, k, m);
    }
    for (int k = 0; k < std::max(problem_.part_count, 1); ++k) {
      ContactProblem& part = problem_.part_count > 0 ? problem_.parts[static_cast<std::size_t>(k)] : problem_;
      if (part.sparse.first.empty()) complete(problem_.part_count > 0 ? part.members : everyone_, part.W);
    }
  }
  void complete(const std::vector<int>& members, Eigen::MatrixXd& whole) const {
    const auto rows = static_cast<Eigen::Index>(3 * members.size());
    auto w = whole.topLeftCorner(rows, rows);
    if (delassus_.compliance.size() > 0)
      for (std::size_t k = 0; k < members.size(); ++k)
        for (std::size_t m = 0; m <= k; ++m)
          w.block<3, 3>(3 * static_cast<Eigen::Index>(k), 3 * static_cast<Eigen::Index>(m)) +=
              delassus_.compliance.block<3, 3>(3 * members[k], 3 * members[m]);
    w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
  }

  // Column by column: the contacts of a contact's bodies, in ascending order.
  void fill_columns(const std::vector<int>& members, ContactColumns& out) {
    std::vector<int> near;
    for (const int i : members) {
      near.clear();
      const ContactPoint& c = at(i);
      for (const std::uint32_t b : {c.body_a, c.body_b})
        if (couples(b)) near.insert(near.end(), delassus_.of[b].contacts.begin(), delassus_.of[b].contacts.end());
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
      const int first_run = static_cast<int>(out.runs.size());
      out.first.push_back(first_run);
      for (const int j : near) add_row(local(j), first_run, out);
      for (int r = first_run; r < static_cast<int>(out.runs.size()); ++r) {
        ContactColumns::Run& run = out.runs[static_cast<std::size_t>(r)];
        run.at = out.values.size();
        out.values.resize(run.at + 3 * static_cast<std::size_t>(run.rows), 0.0);
      }
      add_answers(i, c.body_a, first_run, out);
      if (c.body_b != c.body_a) add_answers(i, c.body_b, first_run, out);
      if (delassus_.compliance.size() > 0)
        for (const int j : near)
          add_block(local(j), delassus_.compliance.block<3, 3>(3 * std::max(i, j), 3 * std::min(i, j)), j < i,
                    first_run, out);
    }
    out.first.push_back(static_cast<int>(out.runs.size()));
  }
  static void add_row(int contact, int first_run, ContactColumns& out) {
    const int row = 3 * contact;
    const bool goes_on =
        static_cast<int>(out.runs.size()) > first_run && out.runs.back().row + out.runs.back().rows == row;
    if (goes_on)
      out.runs.back().rows += 3;
    else
      out.runs.push_back({row, 3, 0});
  }
  void add_answers(int contact, std::uint32_t body, int first_run, ContactColumns& out) const {
    if (!moves(body)) return;
    const BodyResponse& response = delassus_.of[body];
    const auto begin = response.contacts.begin();
    const Eigen::Index m = std::lower_bound(begin, response.contacts.end(), contact) - begin;
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(response.contacts.size()); ++k)
      add_block(local(response.contacts[static_cast<std::size_t>(k)]), answer(response, std::max(k, m), std::min(k, m)),
                k < m, first_run, out);
  }
  static void add_block(int contact, const Eigen::Matrix3d& block, bool mirrored, int first_run, ContactColumns& out) {
    auto run = out.runs.begin() + first_run;
    while (3 * contact >= run->row + run->rows) ++run;
    double* const to = out.values.data() + run->at + static_cast<std::size_t>(3 * contact - run->row);
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row)
        to[column * run->rows + row] += mirrored ? block(column, row) : block(row, column);
  }

  static constexpr std::size_t kAlwaysDense = 96;  // contacts: their W fits into a CPU cache
  static constexpr double kSparse = 0.5;           // [1] of the blocks: sparse if fewer are non-zero

  const std::vector<std::unique_ptr<Body>>& bodies_;
  const std::vector<ContactPoint>& contacts_;
  const Delassus& delassus_;
  ContactProblem& problem_;
  std::vector<int> everyone_;
};

}  // namespace

void fill_operator(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   const Delassus& delassus, ContactProblem& problem) {
  OperatorFiller(bodies, contacts, delassus, problem).fill();
}

}  // namespace pliant
