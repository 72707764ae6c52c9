// Tissue as it is drawn: its surface, its nodes, and the parts that it carries.
#include <algorithm>

#include "systems/soft/body/soft_body_state.h"

namespace pliant {
namespace {

// Area-weighted; in double, for the cross product of a small triangle's edges.
void add_normals(const std::vector<uvec3>& triangles, const std::vector<dvec3>& at, std::vector<vec3>& normals) {
  for (const uvec3 t : triangles) {
    const dvec3 area = cross(at[t.y] - at[t.x], at[t.z] - at[t.x]);
    for (int corner = 0; corner < 3; ++corner) normals[t[corner]] += vec3(area);
  }
  for (vec3& normal : normals) {
    const float size = length(normal);
    normal = size > 0 ? normal / size : vec3(0, 1, 0);
  }
}

}  // namespace

void SoftBodyState::show(SoftObjectSnapshot& out) const {
  out.object = entity;
  out.pose = handle_ ? handle_->object_pose() : Pose{};
  out.position.resize(surface_position.size());
  out.normal.assign(surface_position.size(), vec3(0));
  out.nodes.resize(tissue_.position().size());
  std::transform(surface_position.begin(), surface_position.end(), out.position.begin(),
                 [](dvec3 x) { return vec3(x); });
  std::transform(tissue_.position().begin(), tissue_.position().end(), out.nodes.begin(),
                 [](dvec3 x) { return vec3(x); });

  add_normals(collision_mesh->triangles, surface_position, out.normal);
}

void SoftBodyState::show_part(std::size_t number, SoftObjectSnapshot& out) const {
  const CarriedPart& part = tets_.parts[number];
  std::vector<dvec3> at(part.embedding.size());
  const dquat turned = handle_ ? handle_->object_pose().rotation : placed_;
  for (std::size_t v = 0; v < at.size(); ++v) {
    const Embedding& place = part.embedding[v];
    const Tet& tet = tets_.tets[place.tet];
    dvec3 x(0);
    for (std::size_t k = 0; k < 4; ++k) x += place.weight[k] * tissue_.position()[tet[k]];
    at[v] = part.aside.empty() ? x : x + turned * dvec3(part.aside[v]);
  }
  out.object = part.entity;
  out.position.resize(at.size());
  std::transform(at.begin(), at.end(), out.position.begin(), [](dvec3 x) { return vec3(x); });
  out.normal.assign(at.size(), vec3(0));
  add_normals(*part_triangles_[number], at, out.normal);
}

}  // namespace pliant
