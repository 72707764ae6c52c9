#include "systems/soft/contact/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "runtime/clock.h"
#include "systems/soft/contact/contact_admm.h"
#include "systems/soft/contact/contact_newton.h"
#include "systems/soft/contact/contact_sweeps.h"

namespace pliant {
namespace {

// ADMM runs if half of the sweeps did not converge, or, with many contacts, after a few sweeps: Newton steps on that
// many cost more than ADMM.
constexpr int kLarge = 140, kLargeSweeps = 10;
constexpr AdmmLimits kMuch{.iterations = 100, .work = 1e7};    // about 10 ms,
constexpr AdmmLimits kLittle{.iterations = 100, .work = 2e6};  // and 2 ms: a tool's contacts are all coupled

// [1] multiplications, about 5 ms: few contacts may sweep more often than the limit. A column with a heavy body on top
// of a light one takes sweeps in proportion to the ratio of the masses.
constexpr double kSweepWork = 2e7, kMostOften = 20.0;

int most_sweeps(const ContactProblem& problem, const SweepLimits& limits) {
  if (limits.newtons == 0) return limits.sweeps;
  const double of_one = 9.0 * problem.count * problem.count;
  return std::max(limits.sweeps, static_cast<int>(std::min(kSweepWork / of_one, kMostOften * limits.sweeps)));
}

SweepReport solve_one(ContactProblem& problem, const SweepLimits& limits) {
  SweepReport report;
  if (problem.count == 0) return report;
  const std::uint64_t begin = limits.budget_ns ? now_ns() : 0;
  ContactSweeps sweeps(problem);
  const int most = most_sweeps(problem, limits);
  ContactNewton newton(sweeps, limits.newtons * std::max(1, most / std::max(limits.sweeps, 1)));
  const double enough = limits.tolerance * sweeps.fastest();
  sweeps.start();
  report.residual = sweeps.residual();
  const int half = (limits.sweeps + 1) / 2;
  int since = 0;  // sweeps since the last Newton step
  const int alternate_at = limits.newtons == 0 ? -1 : problem.count > kLarge ? std::min(kLargeSweeps, half) : half;
  while (true) {
    report.settled = report.residual <= enough;
    const int begun = report.settled || report.sweeps == half ? sweeps.begin_slips(10.0 * report.residual + enough) : 0;
    if (report.settled && begun == 0) break;
    if (begun > 0) report.residual = sweeps.residual(), since = 0;
    if (report.sweeps >= most) break;
    if (limits.budget_ns && now_ns() - begin >= limits.budget_ns) {
      report.in_time = false;
      break;
    }
    if (report.sweeps == alternate_at && report.alternations == 0) {
      report.residual = improve_by_admm(sweeps, report.residual, enough, problem.count > kLarge ? kMuch : kLittle,
                                        report.alternations);
      if (report.residual <= enough) continue;
    }
    if (newton.due(since)) {
      report.residual = newton.step(report.residual, enough);
      since = 0;
      if (report.residual <= enough) continue;
    }
    sweeps.sweep();
    ++report.sweeps, ++since;
    report.residual = sweeps.residual();
  }
  report.settled = report.residual <= enough;
  report.newtons = newton.solves();
  sweeps.begin_slips(10.0 * report.residual + enough);
  sweeps.end_slips();
  sweeps.finish();
  return report;
}

// Exchange between the whole problem and one of its parts.
void hand_out(const ContactProblem& whole, ContactProblem& part) {
  part.own.resize(whole.own.empty() ? 0 : part.members.size());
  part.patch.resize(whole.patch.empty() ? 0 : part.members.size());
  part.loose.resize(part.patch.size()), part.slipped.resize(part.patch.size());
  part.held.resize(whole.held.empty() ? 0 : part.members.size());
  part.most.resize(whole.most.empty() ? 0 : part.members.size());
  for (std::size_t k = 0; k < part.members.size(); ++k) {
    const auto i = static_cast<std::size_t>(part.members[k]);
    const auto to = static_cast<Eigen::Index>(3 * k), from = static_cast<Eigen::Index>(3 * i);
    part.bias.segment<3>(to) = whole.bias.segment<3>(from);
    part.impulse.segment<3>(to) = whole.impulse.segment<3>(from);
    part.mu_static[k] = whole.mu_static[i];
    part.mu_sliding[k] = whole.mu_sliding[i];
    part.sliding[k] = whole.sliding[i];
    if (!whole.own.empty()) part.own[k] = whole.own[i];
    if (!whole.held.empty()) part.held[k] = whole.held[i];
    if (!whole.most.empty()) part.most[k] = whole.most[i];
    if (whole.patch.empty()) continue;
    part.patch[k] = whole.place[static_cast<std::size_t>(whole.patch[i])].second;
    part.loose[k] = whole.loose[i], part.slipped[k] = whole.slipped[i];
  }
}
void take_back(const ContactProblem& part, ContactProblem& whole) {
  for (std::size_t k = 0; k < part.members.size(); ++k) {
    const auto i = static_cast<std::size_t>(part.members[k]);
    const auto from = static_cast<Eigen::Index>(3 * k), to = static_cast<Eigen::Index>(3 * i);
    whole.impulse.segment<3>(to) = part.impulse.segment<3>(from);
    whole.velocity.segment<3>(to) = part.velocity.segment<3>(from);
    whole.sliding[i] = part.sliding[k];
  }
}

SweepReport solve_parts(ContactProblem& problem, const SweepLimits& limits) {
  SweepReport report;
  for (int k = 0; k < problem.part_count; ++k) {
    ContactProblem& part = problem.parts[static_cast<std::size_t>(k)];
    hand_out(problem, part);
    const SweepReport of_part = solve_one(part, limits);
    take_back(part, problem);
    report.sweeps = std::max(report.sweeps, of_part.sweeps);
    report.newtons = std::max(report.newtons, of_part.newtons);
    report.alternations = std::max(report.alternations, of_part.alternations);
    report.residual = std::max(report.residual, of_part.residual);
    report.settled &= of_part.settled;
    report.in_time &= of_part.in_time;
  }
  return report;
}

}  // namespace

dmat3 leaning_axes(dvec2 lean) {
  const dvec3 n = normalize(dvec3(1.0, lean));
  const dvec3 t = normalize(dvec3(0.0, 1.0, 0.0) - n.y * n);
  return dmat3(n, t, cross(n, t));
}

void ContactProblem::resize_vectors(int contacts) {
  count = contacts;
  const Eigen::Index rows = 3 * contacts;
  for (Vector* v : {&bias, &impulse, &velocity})
    if (v->size() < rows) v->resize(rows);
  const std::size_t size = static_cast<std::size_t>(contacts);
  if (mu_static.size() < size) mu_static.resize(size);
  if (mu_sliding.size() < size) mu_sliding.resize(size);
  if (sliding.size() < size) sliding.resize(size);
  if (blocks.size() < size) blocks.resize(size), inverses.resize(size), patch_load.resize(size);
}

void ContactProblem::resize(int contacts) {
  resize_vectors(contacts);
  const Eigen::Index rows = 3 * contacts;
  if (W.rows() < rows) W.resize(rows, rows);
}

double ContactProblem::diagonal(Eigen::Index row) const {
  if (part_count > 0) {
    const auto [part, contact] = place[static_cast<std::size_t>(row / 3)];
    return parts[static_cast<std::size_t>(part)].diagonal(3 * contact + row % 3);
  }
  if (sparse.first.empty()) return W(row, row);
  const auto i = static_cast<std::size_t>(row / 3);
  for (int r = sparse.first[i]; r < sparse.first[i + 1]; ++r) {
    const ContactColumns::Run& run = sparse.runs[static_cast<std::size_t>(r)];
    if (row < run.row || row >= run.row + run.rows) continue;
    return sparse.values[run.at + static_cast<std::size_t>(row % 3 * run.rows + row - run.row)];
  }
  return 0.0;
}

SweepReport solve(ContactProblem& problem, const SweepLimits& limits) {
  const Eigen::Index rows = 3 * problem.count;
  const std::size_t count = static_cast<std::size_t>(problem.count);
  const Eigen::MatrixXd& W = problem.shared ? *problem.shared : problem.W;
  ASSERT(problem.part_count > 0 || !problem.sparse.first.empty() || (W.rows() >= rows && W.cols() >= rows));
  ASSERT(!problem.shared || limits.newtons == 0);
  ASSERT(problem.bias.size() >= rows && problem.impulse.size() >= rows && problem.sliding.size() >= count &&
         problem.mu_static.size() >= count && problem.mu_sliding.size() >= count);
  if (problem.velocity.size() < rows) problem.velocity.resize(rows);
  if (problem.blocks.size() < count) problem.blocks.resize(count), problem.inverses.resize(count);
  return problem.part_count > 0 ? solve_parts(problem, limits) : solve_one(problem, limits);
}

}  // namespace pliant
