#include "lab/fit/fit_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr std::size_t kLeastStretches = 5;  // least number of held-out stretches, given enough rows
constexpr double kStretch = 0.05;           // [1] longest stretch, as a share of the record
constexpr std::size_t kFewHeld = 5;         // rows
constexpr double kAlike = 1.02;             // [1] errors within this ratio are equal: fewer parameters win
constexpr double kCorrelated = 0.3;         // [1]

struct Shares {
  double rms = 0.0, share = 0.0;
};
Shares error_on(const PressRecord& record, const std::vector<double>& force, const std::vector<bool>& held,
                bool which) {
  double off = 0.0, size = 0.0, count = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (held[i] != which) continue;
    off += (force[i] - record.force[i]) * (force[i] - record.force[i]);
    size += record.force[i] * record.force[i];
    count += 1.0;
  }
  if (count == 0.0) return {};
  return {std::sqrt(off / count), size > 0 ? std::sqrt(off / size) : 0.0};
}

LawFit fit_law(const PressModel& model, const PressRecord& record, const std::vector<bool>& held, double confidence) {
  const auto rows = static_cast<Eigen::Index>(std::count(held.begin(), held.end(), false));
  std::vector<double> force;
  const Residuals residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    model.predict(record, p, force);
    Eigen::Index k = 0;
    for (std::size_t i = 0; i < record.size(); ++i)
      if (!held[i]) r[k++] = force[i] - record.force[i];
  };
  std::vector<FitParameter> boxes;
  for (const ModelParameter& each : model.parameters) boxes.push_back(each.box);
  LeastSquares best;
  for (std::size_t s = 0; s < model.starts.size(); ++s) {
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].start = model.starts[s][static_cast<Eigen::Index>(i)];
    LeastSquares one = least_squares(boxes, rows, residuals);
    if (s == 0 || one.sum < best.sum) best = std::move(one);
  }
  LawFit out;
  out.model = model;
  out.p = best.p;
  out.converged = best.converged;
  out.singular = best.singular;
  const auto free = static_cast<double>(std::count(best.on_bound.begin(), best.on_bound.end(), false));
  const double degrees = static_cast<double>(rows) - free, t = degrees > 0 ? student_t(confidence, degrees) : 0.0;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double half = t * std::sqrt(std::max(0.0, best.covariance(k, k)));
    out.parameters.push_back({model.parameters[i].key, model.parameters[i].unit, best.p[k],
                              std::max(best.p[k] - half, boxes[i].low), std::min(best.p[k] + half, boxes[i].high),
                              best.on_bound[i]});
  }
  model.predict(record, out.p, out.force);
  const Shares fitted = error_on(record, out.force, held, false), unseen = error_on(record, out.force, held, true);
  out.rms = fitted.rms;
  out.share = fitted.share;
  out.held_rms = unseen.rms;
  out.held_share = unseen.share;
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double r = out.force[i] - record.force[i];
    square += r * r;
    if (i > 0) product += r * (out.force[i - 1] - record.force[i - 1]);
  }
  out.correlation = square > 0 ? product / square : 0.0;
  return out;
}

}  // namespace

std::vector<bool> held_rows(std::size_t rows, double share) {
  std::vector<bool> held(rows, false);
  if (!(share > 0) || rows == 0) return held;
  const auto wanted =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(share * static_cast<double>(rows))), 1, rows);
  const std::size_t stretches =
      std::min(wanted, std::max(kLeastStretches, static_cast<std::size_t>(std::ceil(share / kStretch))));
  for (std::size_t k = 0; k < stretches; ++k) {
    // A stretch in the middle of the k-th part of the record.
    const std::size_t begin = k * rows / stretches, end = (k + 1) * rows / stretches,
                      count = (k + 1) * wanted / stretches - k * wanted / stretches, first = (begin + end - count) / 2;
    for (std::size_t i = first; i < first + count; ++i) held[i] = true;
  }
  return held;
}

Result<RecordFit> fit_record(const PressRecord& record, const RecordFitOptions& options) {
  RecordFit out;
  out.held = held_rows(record.size(), options.hold_out);
  out.fitted = static_cast<std::size_t>(std::count(out.held.begin(), out.held.end(), false));
  std::string why;
  for (const std::string& law : press_laws()) {
    if (options.law == "auto" ? by_name_alone(law) : options.law != law) continue;
    const std::optional<PressModel> model = press_model(law, record, options.model, why);
    if (!model) continue;
    if (out.fitted <= model->parameters.size()) {
      why = fmt::format("{} rows do not make {} parameters; measure more, or hold out fewer", out.fitted,
                        model->parameters.size());
      continue;
    }
    out.laws.push_back(fit_law(*model, record, out.held, options.confidence));
  }
  if (out.laws.empty()) return Error{record.name, why};
  const std::size_t unseen = record.size() - out.fitted;
  const auto error = [&](const LawFit& fit) { return unseen > 0 ? fit.held_rms : fit.rms; };
  double least = error(out.laws[0]);
  for (const LawFit& fit : out.laws) least = std::min(least, error(fit));
  const LawFit* best = nullptr;
  for (const LawFit& fit : out.laws)
    if (error(fit) <= kAlike * least && (!best || fit.parameters.size() < best->parameters.size())) best = &fit;
  out.best = static_cast<std::size_t>(best - out.laws.data());
  if (unseen > 0 && unseen < kFewHeld && out.laws.size() > 1)
    out.notes.push_back(fmt::format("{} row{} held out: too few to distinguish laws; hold out more, or measure more",
                                    unseen, unseen == 1 ? " is" : "s are"));
  if (!best->converged)
    out.notes.push_back("the fit of " + best->model.law + " did not converge; its intervals mean little");
  if (best->singular)
    out.notes.push_back("the record does not determine the parameters of " + best->model.law +
                        " apart, so that there are no intervals; press deeper, or at several speeds");
  for (const FittedParameter& each : best->parameters)
    if (each.on_bound)
      out.notes.push_back(fmt::format("{} ended at the bound of its range, {:.6g} {}, and has no interval", each.key,
                                      each.value, each.unit));
  if (std::abs(best->correlation) > kCorrelated)
    out.notes.push_back(fmt::format(
        "each residual resembles the one before it (correlation {:.2f}): the law is not quite the tissue's, or the "
        "noise is not white, and the intervals are too narrow",
        best->correlation));
  return out;
}

}  // namespace pliant
