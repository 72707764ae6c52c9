#include "content/mesh/mesh_winding.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "content/mesh/enclosing_parts.h"
#include "content/mesh/mesh_draw.h"
#include "content/mesh/wound_parts.h"

namespace pliant {
namespace {

constexpr double kFlatPart = 1e-7;  // [1] of area times extent: a smaller volume is rounding error
constexpr double kOneVoice = 0.99;  // [1] share of an open part's area that must agree with the file's normals for
                                    // these to count
constexpr std::size_t kPoints = 5;  // of a part, each tested for enclosing parts
constexpr std::size_t kMostAsked = 4096;  // inside-out parts; beyond it the rest counts as undecided

// Decides which parts are inside out.
class Winding {
 public:
  Winding(std::span<const Primitive> primitives, const mat4& to_object, const Welded& welded, const Mesh& mesh,
          const Gathered& gathered, WoundParts& wound)
      : primitives_(primitives),
        to_(to_object),
        welded_(welded),
        mesh_(mesh),
        gathered_(gathered),
        parts_(wound.parts),
        wound_(wound) {}

  // For undecided parts: compares with the file's normals and samples triangles evenly for enclosure tests.
  void gather_voices() {
    std::vector<std::uint32_t> seen(parts_.size(), 0);
    for (std::uint32_t t = 0; t < wound_.side.size(); ++t) {
      WoundPart& part = parts_[wound_.part_of[t]];
      if (part.closed && part.volume > 0.0) continue;
      std::uint32_t& place = seen[wound_.part_of[t]];
      if (place * kPoints / part.count != (place + 1) * kPoints / part.count) part.samples.push_back(t);
      ++place;
      const std::uint32_t source = welded_.source_triangle[t], n = gathered_.primitive[source];
      const Primitive& p = primitives_[n];
      if (p.normal.empty() || p.normal.size() != p.position.size()) continue;
      const dvec3 face = (wound_.side[t] ? -1.0 : 1.0) * wound_.twice_area(t);
      dvec3 says(0);
      for (int i = 0; i < 3; ++i)
        says += to_.normal * dvec3(p.normal[gathered_.triangle[source][i] - gathered_.first_vertex[n]]);
      (dot(face, says) < 0.0 ? part.disagrees : part.agrees) += 0.5 * length(face);
    }
  }

  // Larger parts first, so that enclosing parts are already decided.
  void decide(MeshReport& report) {
    const double extent = length(glm::max(glm::abs(dvec3(mesh_.box.min)), glm::abs(dvec3(mesh_.box.max))));
    std::vector<std::uint32_t> order;
    for (std::uint32_t n = 0; n < parts_.size(); ++n) {
      WoundPart& part = parts_[n];
      const double area = part.area[0] + part.area[1];
      if (!part.orientable) continue;
      if (!part.closed) {
        const double voices = part.agrees + part.disagrees;
        if (voices >= kOneVoice * area && part.disagrees >= kOneVoice * voices)
          part.turned = true;
        else if (part.disagrees > 0.5 * voices)
          part.decided = false;
      } else if (std::abs(part.volume) <= kFlatPart * area * extent) {
        part.decided = false;
      } else {
        order.push_back(n);
      }
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(parts_[a].volume) > std::abs(parts_[b].volume);
    });
    std::optional<EnclosingParts> enclosing;
    std::size_t asked = 0;
    for (const std::uint32_t n : order) {
      WoundPart& part = parts_[n];
      if (part.volume > 0.0) continue;
      if (!enclosing) enclosing.emplace(mesh_, wound_.part_of);
      const std::optional<int> depth = ++asked > kMostAsked ? std::nullopt : depth_of(part, *enclosing);
      part.decided = depth.has_value();
      part.turned = depth && *depth == 0;  // inside a solid: the wall of a cavity
    }
    for (const WoundPart& part : parts_) {
      report.turned_parts += part.turned;
      report.undecided_parts += !part.decided;
    }
  }

 private:
  // Number of solids around the part; empty if its samples disagree or an enclosing part is undecided.
  std::optional<int> depth_of(const WoundPart& part, EnclosingParts& enclosing) const {
    std::optional<std::vector<std::uint32_t>> all;
    for (const std::uint32_t triangle : part.samples) {
      std::optional<std::vector<std::uint32_t>> here = enclosing.around(triangle);
      if (!here) continue;
      std::erase_if(*here, [&](std::uint32_t n) {
        return !parts_[n].closed || !parts_[n].orientable || std::abs(parts_[n].volume) <= std::abs(part.volume);
      });
      if (all && *all != *here) return std::nullopt;
      all = std::move(here);
    }
    if (!all) return std::nullopt;
    int depth = 0;
    for (const std::uint32_t n : *all) {
      if (!parts_[n].decided) return std::nullopt;
      depth += (parts_[n].volume > 0.0) != parts_[n].turned ? 1 : -1;
    }
    return depth;
  }

  std::span<const Primitive> primitives_;
  const Directions to_;
  const Welded& welded_;
  const Mesh& mesh_;
  const Gathered& gathered_;
  std::vector<WoundPart>& parts_;
  const WoundParts& wound_;
};

}  // namespace

std::vector<std::uint8_t> find_wrong_winding(std::span<const Primitive> primitives, const mat4& to_object,
                                             const Welded& welded, const std::vector<SideAgainst>& against,
                                             const Mesh& mesh, Gathered& gathered, MeshReport& report) {
  WoundParts wound(mesh, against);
  report.turned_triangles += wound.agree();
  for (const WoundPart& part : wound.parts) report.unorientable_parts += !part.orientable;
  Winding winding(primitives, to_object, welded, mesh, gathered, wound);
  winding.gather_voices();
  winding.decide(report);
  if (report.turned_triangles + report.turned_parts == 0) return {};

  std::vector<std::uint8_t> turned = std::move(wound.side);
  for (std::size_t t = 0; t < turned.size(); ++t) {
    const WoundPart& part = wound.parts[wound.part_of[t]];
    if (!part.turned) continue;
    turned[t] = static_cast<std::uint8_t>(1 - turned[t]);
    // Normals that agreed with the wrong winding point inward too.
    if (part.agrees <= part.disagrees) continue;
    gathered.turned_normal.resize(gathered.position.size(), 0);
    for (int i = 0; i < 3; ++i) gathered.turned_normal[gathered.triangle[welded.source_triangle[t]][i]] = 1;
  }
  return turned;
}

void turn_over(const std::vector<std::uint8_t>& turned, Mesh& mesh, Welded& welded, Gathered& gathered) {
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (!turned[t]) continue;
    uvec3& source = gathered.triangle[welded.source_triangle[t]];
    std::swap(source.y, source.z);
    std::swap(welded.triangle[t].y, welded.triangle[t].z);
    std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
  }
}

}  // namespace pliant
