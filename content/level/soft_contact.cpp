#include "content/level/soft_contact.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/tets/surface_shape.h"
#include "content/tets/tet_findings.h"

namespace pliant {
namespace {

constexpr double kMostPoissonOfSplit = 0.495;  // [1] the calibration's last row
constexpr double kThinnestSplit = 2.0;         // [cells] R is 1.5 to 2 of them

// [m] Of the surface, at the median; 0: nothing is behind it.
double median_thickness(const Mesh& surface) {
  std::vector<double> thickness;
  for (const ThicknessSample& sample : measure_shape(surface).samples)
    if (sample.thickness > 0.0) thickness.push_back(sample.thickness);
  if (thickness.empty()) return 0.0;
  const auto middle = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
  std::nth_element(thickness.begin(), middle, thickness.end());
  return *middle;
}

}  // namespace

SoftContact contact_of(const LevelNode& node) {
  return node.deformable ? SoftContact::kSplit : node.soft_body->contact;
}

std::string why_plain(const Level& level, const LevelNode& node) {
  const SoftBody& body = *node.soft_body;
  if (std::any_of(level.nodes.begin(), level.nodes.end(),
                  [](const LevelNode& n) { return n.in_scene && n.soft_body && n.handle; }))
    return "the tissue of a tool has many contacts, and split ones would take twice the time of a step";
  if (!body.rigid.empty()) return "it has rigid parts, which their dents do not move";
  if (body.law != TissueLaw::kCorotational) return "`law` is for large strain, and their dents are for small";
  if (body.prony.count > 0) return "their dents do not relax, and the tissue does (`prony`)";
  if (body.fibres.young > 0.0) return "their dents have no fibres";
  if (body.poisson > kMostPoissonOfSplit)
    return fmt::format("they are measured up to a `poisson` of {:g}", kMostPoissonOfSplit);
  if (!body.mesh.empty() || !body.focus.empty()) return "they are measured on even cells";
  if (std::any_of(body.materials.begin(), body.materials.end(), [](const TissuePart& p) { return p.young > 0.0; }))
    return "its modulus varies (`materials`)";
  return "";
}

std::string why_plain(const Mesh& surface, const TetMesh& tets, bool pinned) {
  if (!pinned) return "nothing pins it: it rests on patches wider than its cells";
  if (!surface.stiffness_factor.empty()) return "its modulus varies (_STIFFNESS)";
  if (tets.report.wall > 0.0) return "its surface is a thin wall";
  if (const double thick = median_thickness(surface); thick < kThinnestSplit * tets.report.cell)
    return fmt::format("it is {} thick at the median, less than {:g} cells", length_text(thick), kThinnestSplit);
  return "";
}

}  // namespace pliant
