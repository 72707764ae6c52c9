#include "content/tets/tet_groups.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr float kPaintedShare = 0.5f;
constexpr double kRounding = 1e-6;  // [1] of the diagonal: tolerance, so that a box includes nodes on its faces

bool is_painted(const std::vector<float>& paint) {
  return std::any_of(paint.begin(), paint.end(), [](float value) { return value >= kPaintedShare; });
}

double distance2(const Box& box, dvec3 p) {
  const dvec3 away = glm::max(glm::max(dvec3(box.min) - p, p - dvec3(box.max)), dvec3(0));
  return dot(away, away);
}

// Zones are compact patches, so few of them are nearer than the best vertex so far.
std::uint32_t nearest_vertex(const Mesh& mesh, dvec3 p) {
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::max();
  for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) {
    if (distance2(mesh.zone_box[zone], p) >= least) continue;
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
      const dvec3 away = dvec3(mesh.position(v)) - p;
      if (dot(away, away) >= least) continue;
      least = dot(away, away);
      best = v;
    }
  }
  return best;
}

// Puts the nodes of a box, or of the paint, into a group; returns whether there were any.
bool claim(const std::vector<dvec3>& nodes, const BuiltMesh& surface, const Box& box, const std::vector<float>& paint,
           NodeGroup which, std::vector<NodeGroup>& group) {
  const dvec3 slack(kRounding * static_cast<double>(surface.mesh.box.diagonal()));
  parallel_for(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const bool held = box.empty() ? paint[nearest_vertex(surface.mesh, nodes[n])] >= kPaintedShare
                                    : glm::all(glm::greaterThanEqual(nodes[n], dvec3(box.min) - slack)) &&
                                          glm::all(glm::lessThanEqual(nodes[n], dvec3(box.max) + slack));
      if (held) group[n] = which;
    }
  });
  return std::find(group.begin(), group.end(), which) != group.end();
}

// Puts the nodes of a rigid part's box into its group.
Status claim_rigid(const std::vector<dvec3>& nodes, const BuiltMesh& surface, const SoftBody& body, std::size_t part,
                   std::vector<NodeGroup>& group) {
  const RigidPart& asked = body.rigid[part];
  const std::string where = "PLIANT_soft_body/rigid `" + asked.name + "`";
  const dvec3 slack(kRounding * static_cast<double>(surface.mesh.box.diagonal()));
  bool any = false;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!glm::all(glm::greaterThanEqual(nodes[n], asked.box.min - slack)) ||
        !glm::all(glm::lessThanEqual(nodes[n], asked.box.max + slack)))
      continue;
    if (group[n] != NodeGroup::kFree && group[n] != NodeGroup::kPinned)
      return Error{
          where,
          "overlaps " +
              (group[n] == NodeGroup::kHandle
                   ? std::string("the handle")
                   : "`" +
                         body.rigid[static_cast<std::size_t>(group[n]) - static_cast<std::size_t>(NodeGroup::kRigid)]
                             .name +
                         "`"),
          "leave tissue between them"};
    group[n] = rigid_group(part);
    any = true;
  }
  if (!any)
    return Error{where, "holds no node of the tetrahedra",
                 "move or widen its box: the tissue reaches from " + text_of(surface.mesh.box)};
  return Done{};
}

}  // namespace

std::string text_of(const Box& box) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) to ({:.3g}, {:.3g}, {:.3g}) m", box.min.x, box.min.y, box.min.z,
                     box.max.x, box.max.y, box.max.z);
}

Result<std::vector<NodeGroup>> group_nodes(const std::vector<dvec3>& nodes, const BuiltMesh& surface,
                                           const SoftBody& body, const Handle6* handle) {
  std::vector<NodeGroup> group(nodes.size(), NodeGroup::kFree);
  const std::string extent = "the tissue reaches from " + text_of(surface.mesh.box);
  if (!body.pinned.empty() || is_painted(surface.pinned)) {
    if (!claim(nodes, surface, body.pinned, surface.pinned, NodeGroup::kPinned, group))
      return Error{"PLIANT_soft_body/pinned", "holds no node of the tetrahedra",
                   (body.pinned.empty() ? "paint _PINNED over more than a cell" : "move or widen its box: " + extent)};
  }
  if (handle) {
    if (handle->box.empty() && !is_painted(surface.handle))
      return Error{"PLIANT_handle", "defines no rigid part", "give it a `box`, or paint _HANDLE with 1 on the mesh"};
    if (!claim(nodes, surface, handle->box, surface.handle, NodeGroup::kHandle, group))
      return Error{"PLIANT_handle/box", "holds no node of the tetrahedra",
                   (handle->box.empty() ? "paint _HANDLE over more than a cell" : "move or widen it: " + extent)};
  }
  for (std::size_t part = 0; part < body.rigid.size(); ++part)
    if (Status s = claim_rigid(nodes, surface, body, part, group); !s) return s.error();
  if (std::find(group.begin(), group.end(), NodeGroup::kFree) == group.end())
    return Error{"PLIANT_soft_body", "has no free node: every node is pinned, on the handle or on a rigid part",
                 "make `pinned`, the handle's box or those of `rigid` smaller, or use PLIANT_rigid_body"};
  return group;
}

}  // namespace pliant
