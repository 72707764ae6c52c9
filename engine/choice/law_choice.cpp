// Chooses the law of a surface's force if `young` and a spherical probe define the reference: Hertz's force, or that of
// a layer bonded to a rigid base.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/enum_words.h"
#include "content/keys/extension_table.h"
#include "content/keys/layer_sphere.h"
#include "engine/choice/choice_parts.h"
#include "engine/choice/press_bench.h"
#include "engine/choice/surface_cost.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {
namespace {

constexpr int kLawDepths = 4;
constexpr double kDeepest = 0.25;       // [1] of the sphere's radius, and of the layer's thickness: small strains
constexpr double kMostOfObject = 0.02;  // [1] of the object's diagonal
constexpr double kMostStiffening = 12.0, kMostCubic = 100.0;  // [1] of the deepest press: alpha d, and k3 d^2 / k

struct LawModel {
  SpringLaw spring;
  std::string key;        // of its constant; empty: it has none
  double constant = 0.0;  // [1/m] or [N/m3]
};

double& constant_of(Deformable& its, const std::string& key) {
  return key == "cubic" ? its.cubic : its.stiffening;
}

void set(Deformable& its, const LawModel& law) {
  its.spring = law.spring;
  if (!law.key.empty()) constant_of(its, law.key) = law.constant;
}

// Force of a law at a depth [m], over E*. [m2]
double law_area(const Deformable& its, const LawModel& law, double radius, double depth) {
  Deformable with = its;
  set(with, law);
  const double z = -restoring_law(with).force(-depth);
  return 4.0 / 3.0 * std::sqrt(radius) * z * std::sqrt(std::max(0.0, z));
}

// The constant between 0 and `most` with the smallest force error, by golden section.
double fitted(const Deformable& its, LawModel law, double most, double radius, double deepest,
              const LayerSphere& truth) {
  const auto off = [&](double constant) {
    law.constant = constant;
    double sum = 0.0;
    for (int i = 1; i <= kLawDepths; ++i) {
      const double d = deepest * i / kLawDepths, r = law_area(its, law, radius, d) - truth.force(d);
      sum += r * r;
    }
    return sum;
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0.0, high = most;
  for (int i = 0; i < 60; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    (off(a) < off(b) ? high : low) = off(a) < off(b) ? b : a;
  }
  return 0.5 * (low + high);
}

std::string label_of(const LawModel& law) {
  std::string label = fmt::format("spring {}", word_of(law.spring));
  if (!law.key.empty())
    label +=
        fmt::format(", {} {:.4g} {}", law.key, law.constant, find_key(*find_extension("deformable"), law.key)->unit);
  return label;
}

// The laws without a memory that read one constant at most.
std::vector<LawModel> laws_to_choose() {
  std::vector<LawModel> laws;
  for (std::size_t i = 0; i < std::size(kSpringRows); ++i) {
    const std::string keys = kSpringRows[i].reads;
    if (kSpringRows[i].step != SpringStep::kArm && keys.find(' ') == std::string::npos)
      laws.push_back({static_cast<SpringLaw>(i), keys});
  }
  return laws;
}

// The reason why there is no reference; empty if there is one.
std::string no_truth(const LevelNode& node, double sphere) {
  if (!(node.deformable->young > 0.0))
    return "the author's, as is the stiffness: without `young` no truth says what it is";
  if (states(node, "deformable", "spring")) return "the author's: the level itself says spring";
  if (!(sphere > 0.0)) return "linear is exact: a point presses as the flat punch of 4 mm radius that `young` assumes";
  return "";
}

}  // namespace

Result<std::optional<ModelChoice>> choose_law(Level& level, std::size_t index, ModelChoice& surface,
                                              ChoiceProgress& progress) {
  LevelNode& node = level.nodes[index];
  const double sphere = least_sphere(level);
  if (const std::string why = no_truth(node, sphere); !why.empty()) {
    surface.remarks.push_back("force law: " + why);
    return std::optional<ModelChoice>();
  }
  ModelChoice choice{node.name, "force law", node.deformable->error, {}, 0, false, {}, {}};
  Level alone = level_alone(level, index);
  for (LevelMesh& mesh : alone.meshes)  // a painted factor scales law and reference alike
    for (Primitive& primitive : mesh.primitives) primitive.stiffness.clear();
  auto bench = PressBench::make(alone, nullptr, sphere);
  if (!bench) return bench.error();
  Deformable& its = bench->surface();
  const double diagonal = static_cast<double>(bench->mesh().box.diagonal());
  double deepest = std::min(kDeepest * sphere, kMostOfObject * diagonal);
  if (its.thickness > 0.0) deepest = std::min(deepest, kDeepest * its.thickness);
  const LayerSphere force(sphere, its.thickness, its.poisson, deepest);
  const SurfaceTruth truth(level, index, diagonal);

  std::vector<LawModel> laws = laws_to_choose();
  for (LawModel& law : laws) {
    if (law.key.empty()) continue;
    const bool kept = states(node, "deformable", law.key.c_str());
    if (kept && std::count(choice.kept.begin(), choice.kept.end(), law.key) == 0) choice.kept.push_back(law.key);
    const double most =
        law.key == "cubic" ? its.stiffness * kMostCubic / (deepest * deepest) : kMostStiffening / deepest;
    law.constant = kept ? constant_of(its, law.key) : fitted(its, law, most, sphere, deepest, force);
  }

  std::vector<std::pair<ModelCandidate, LawModel>> tried;
  for (const LawModel& law : laws) {
    set(its, law);
    if (const Status ready = bench->prepare(); !ready) return ready.error();
    double off = 0.0, size = 0.0, ms = 0.0, count = 0.0;
    for (std::size_t k = 0; k < kPressPlaces; ++k)
      for (int i = 1; i <= kLawDepths; ++i) {
        progress.say("choosing a force law for `" + node.name + "`");
        const double depth = deepest * i / kLawDepths, wanted = plane_modulus(its) * force.force(depth);
        const PressBench::Press press = bench->press(k, depth, truth);
        if (!(press.force > 0.0)) continue;
        off += (press.force - wanted) * (press.force - wanted);
        size += wanted * wanted;
        ms += press.ms;
        count += 1.0;
      }
    if (!(size > 0.0)) return Error{node.name, "could not be pressed to measure an error", "leave out `error`"};
    ModelCandidate candidate{label_of(law), std::sqrt(off / size)};
    candidate.vertices = surface.tried[surface.chosen].vertices;
    candidate.cost = kTickUs + 1e-3 * candidate.vertices * law_ns(law.spring);
    candidate.ms = ms / count;
    tried.emplace_back(candidate, law);
  }
  choice.remarks.push_back(fmt::format(
      "truth: the force of a sphere of {:.3g} mm radius, up to {:.2g} mm deep, {}", 1e3 * sphere, 1e3 * deepest,
      its.thickness > 0.0 ? fmt::format("on a layer of {:.3g} mm bonded to something rigid", 1e3 * its.thickness)
                          : std::string("on an elastic half-space (Hertz)")));
  const LawModel taken = take_cheapest(choice, tried);
  choice.keys.push_back({"deformable", "spring"});
  if (!taken.key.empty() && !states(node, "deformable", taken.key.c_str()))
    choice.keys.push_back({"deformable", taken.key});
  set(*node.deformable, taken);
  return std::optional<ModelChoice>(std::move(choice));
}

}  // namespace pliant
