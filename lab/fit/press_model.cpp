#include "lab/fit/press_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/monotone_cubic.h"
#include "content/keys/enum_words.h"
#include "content/keys/extensions.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {
namespace {

using R = DeformableRange;
constexpr double kFlattestPress = 5.0;  // [1] below 0: almost no slope is left at the deepest place
constexpr std::size_t kTableRows = 8;   // below [0, 0]
constexpr double kSteepest = 50.0;      // [1] exponent at the deepest place: beyond it a double soon overflows

struct Sizes {
  double depth = 0.0, force = 0.0, span = 0.0, least_step = 0.0;  // [m] [N] [s] [s]
  double slope = 0.0;                                             // [N/m] of a line through zero
};

// Sizes of the record if contact begins at the depth `met` [m].
Sizes sizes_of(const PressRecord& record, double met) {
  Sizes out;
  double fd = 0.0, dd = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double d = std::max(record.depth[i] - met, 0.0);
    out.depth = std::max(out.depth, d);
    out.force = std::max(out.force, std::abs(record.force[i]));
    fd += record.force[i] * d;
    dd += d * d;
  }
  out.slope = fd / dd;
  if (record.time.empty()) return out;
  out.span = record.time.back() - record.time.front();
  out.least_step = out.span;
  for (std::size_t i = 1; i < record.size(); ++i)
    out.least_step = std::min(out.least_step, record.time[i] - record.time[i - 1]);
  return out;
}

// [m] Range of the contact depth: from one record length before the record begins to nine tenths of the record.
// `starts`: initial guesses of a fit.
struct ContactRange {
  double low = 0.0, high = 0.0;
  std::vector<double> starts{0.0};
};
ContactRange contact_range(const PressRecord& record, bool open) {
  ContactRange out;
  if (!open) return out;
  const auto [least, most] = std::minmax_element(record.depth.begin(), record.depth.end());
  out.low = std::min(*least, 0.0) - (*most - *least);
  out.high = *most - 0.1 * (*most - *least);
  out.starts = {std::clamp(0.0, out.low, out.high)};
  if (*least > 0.1 * *most) out.starts.push_back(*least);
  return out;
}

// [Pa] Young's modulus of a half-space on which a sphere reaches the record's largest force at its deepest place.
double sphere_modulus(const Sizes& size, const PressModelOptions& options) {
  const double plane = size.force / (4.0 / 3.0 * std::sqrt(options.radius) * std::pow(size.depth, 1.5));
  return plane * (1 - options.poisson * options.poisson);
}

// The law of a surface; `hertz` and `sneddon` are linear ones whose stiffness follows from a modulus.
SpringLaw spring_of(const std::string& law) {
  return value_of_word<SpringLaw>(law).value_or(SpringLaw::kLinear);
}

// Initial guesses for a law's own parameters.
std::vector<std::vector<double>> law_starts(const std::string& law, const Sizes& size,
                                            const PressModelOptions& options) {
  const double k = std::clamp(size.slope, R::kStiffness.min, R::kStiffness.max), d = size.depth;
  if (of_modulus(law)) return {{sphere_modulus(size, options)}};
  const SpringLaw spring = spring_of(law);
  std::vector<std::vector<double>> springs{{k}};
  if (reads_key(spring, "cubic")) springs = {{0.9 * k, 0.1 * k / (d * d)}, {0.3 * k, k / (d * d)}};
  if (reads_key(spring, "stiffening")) springs = {{0.9 * k, 0.3 / d}, {0.2 * k, 3.0 / d}, {1.3 * k, -0.5 / d}};
  if (reads_key(spring, "table")) springs = {std::vector<double>(kTableRows, k * d / kTableRows)};
  if (!has_arm(spring)) return springs;
  std::vector<std::vector<double>> starts;
  for (const std::vector<double>& each : springs)
    for (const double share : {0.01, 0.05, 0.25, 1.0}) {
      starts.push_back(each);
      const double whole = reads_key(spring, "table") ? k : each[0];
      const std::size_t scaled = reads_key(spring, "table") ? kTableRows : 1;
      for (std::size_t i = 0; i < scaled; ++i) starts.back()[i] *= 0.6;
      starts.back().insert(starts.back().end(), {0.4 * whole, share * size.span});
    }
  return starts;
}

ModelParameter parameter(const char* key, const char* unit, Range range, double scale) {
  return {key, unit, {scale, range.min, range.max, scale}};
}

}  // namespace

const std::vector<std::string>& press_laws() {
  static const std::vector<std::string> laws = [] {
    std::vector<std::string> all;
    for (const SpringRow& row : kSpringRows) all.emplace_back(row.word);
    all.insert(all.end(), {"hertz", "sneddon"});
    return all;
  }();
  return laws;
}

bool of_modulus(const std::string& law) {
  return law == "hertz" || law == "sneddon";
}

bool by_name_alone(const std::string& law) {
  return law == "sneddon" || reads_key(spring_of(law), "table");
}

std::optional<PressModel> press_model(const std::string& law, const PressRecord& record,
                                      const PressModelOptions& options, std::string& why) {
  const ContactRange contact = contact_range(record, options.contact);
  // Bounds must hold for every contact depth; initial guesses depend on it.
  const Sizes size = sizes_of(record, contact.low);
  if (has_arm(spring_of(law)) && record.time.empty()) {
    why = fmt::format("the law {} needs a column of time", law);
    return std::nullopt;
  }
  if (options.damping && record.time.empty()) {
    why = "damping needs a column of time";
    return std::nullopt;
  }
  if (of_modulus(law) && !(options.radius > 0)) {
    why = fmt::format("the law {} needs the radius of a spherical indenter; say --radius", law);
    return std::nullopt;
  }
  if (law == "sneddon" && options.thickness > 0) {
    why = "the law sneddon is of deep tissue; leave out --thickness, or fit hertz";
    return std::nullopt;
  }
  PressModel model;
  model.law = law;
  model.options = options;
  auto& list = model.parameters;
  const Sizes usual = sizes_of(record, contact.starts[0]);
  const double k = std::clamp(usual.slope, R::kStiffness.min, R::kStiffness.max);
  model.deepest = usual.depth;
  if (of_modulus(law))
    list.push_back(parameter("young", "Pa", {1e-3, 1e12}, sphere_modulus(usual, options)));
  else if (reads_key(spring_of(law), "table"))
    for (std::size_t i = 1; i <= kTableRows; ++i)
      list.push_back(parameter(fmt::format("table.{}", i).c_str(), "N",
                               {i == 1 ? 1e-6 * usual.force : 0.0, R::kTable.max / kTableRows},
                               usual.force / kTableRows));
  else
    list.push_back(parameter("stiffness", "N/m", R::kStiffness, k));
  const SpringLaw spring = spring_of(law);
  if (reads_key(spring, "cubic")) {
    list.push_back(parameter("cubic", "N/m3", R::kCubic, k / (usual.depth * usual.depth)));
  } else if (reads_key(spring, "stiffening")) {
    list.push_back(parameter("stiffening", "1/m",
                             {std::max(R::kStiffening.min, -kFlattestPress / size.depth),
                              std::min(R::kStiffening.max, kSteepest / size.depth)},
                             1.0 / usual.depth));
  }
  if (has_arm(spring)) {
    list.push_back(parameter("relaxation.stiffness", "N/m", R::kRelaxationStiffness, k));
    list.push_back(parameter(
        "relaxation.time", "s",
        {std::max(R::kRelaxationTime.min, 0.2 * size.least_step), std::min(R::kRelaxationTime.max, 20 * size.span)},
        0.1 * size.span));
  }
  if (options.damping) list.push_back(parameter("contact_damping", "N s/m", R::kContactDamping, 0.01 * k * size.span));
  if (options.contact)
    list.push_back(parameter("contact", "m", {contact.low, contact.high}, 0.1 * (contact.high - contact.low)));
  for (const double met : contact.starts)
    for (std::vector<double> start : law_starts(law, sizes_of(record, met), options)) {
      if (options.damping) start.push_back(0.1 * list[start.size()].box.scale);
      if (options.contact) start.push_back(met);
      for (std::size_t i = 0; i < list.size(); ++i) start[i] = std::clamp(start[i], list[i].box.low, list[i].box.high);
      model.starts.push_back(Eigen::Map<Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size())));
    }
  for (std::size_t i = 0; i < list.size(); ++i) list[i].box.start = model.starts[0][static_cast<Eigen::Index>(i)];
  return model;
}

Deformable PressModel::deformable(const Eigen::VectorXd& p) const {
  Deformable out;
  out.poisson = options.poisson;
  out.spring = spring_of(law);
  if (of_modulus(law)) out.thickness = options.thickness;
  if (law == "sneddon") out.sphere = SphereForce::kSneddon;
  if (reads_key(out.spring, "table")) {
    out.table.count = kTableRows + 1;
    for (std::size_t i = 1; i <= kTableRows; ++i)
      out.table.rows[i] = {deepest * static_cast<double>(i) / kTableRows,
                           out.table.rows[i - 1][1] + p[static_cast<Eigen::Index>(i - 1)]};
    out.stiffness = stiffness_of(out.table);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string& key = parameters[i].key;
    const double value = p[static_cast<Eigen::Index>(i)];
    if (key == "stiffness") out.stiffness = value;
    if (key == "cubic") out.cubic = value;
    if (key == "stiffening") out.stiffening = value;
    if (key == "relaxation.stiffness") out.relaxation_stiffness = value;
    if (key == "relaxation.time") out.relaxation_time = value;
    if (key == "contact_damping") out.contact_damping = value;
    if (key == "young") {
      out.young = value;
      out.stiffness = calibrated_stiffness(value, options.poisson, out.thickness);
    }
  }
  return out;
}

void PressModel::predict(const PressRecord& record, const Eigen::VectorXd& p, std::vector<double>& force) const {
  const Deformable surface = deformable(p);
  const double met = options.contact ? p[p.size() - 1] : 0.0;
  const Motion moves = motion(surface, 1e-3);
  ContactLaw contact = contact_law(surface, moves, 1.0, options.radius);
  force.resize(record.size());
  double before = 0.0, q = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double depth = std::max(0.0, record.depth[i] - met);
    const double dt = i > 0 && !record.time.empty() ? record.time[i] - record.time[i - 1] : 0.0;
    if (contact.arm > 0 && dt > 0) {
      // q' = (z - q) / tau, exact for a z that is linear in time (field_kernels.cpp: step_relaxed).
      const double z = -contact.law->force(-depth), z0 = -contact.law->force(-before);
      const double over = dt / surface.relaxation_time, left = std::exp(-over), ramp = -std::expm1(-over) / over;
      q = z - (left * (z0 - q) + ramp * (z - z0));
      contact.relaxed = std::max(q, 0.0);
    }
    double newton = contact.stored(depth).force;
    if (surface.contact_damping > 0 && dt > 0 && depth > 0)
      newton = std::max(0.0, newton + surface.contact_damping * (depth - before) / dt);
    force[i] = newton;
    before = depth;
  }
}

}  // namespace pliant
