#include "systems/soft/body_edits.h"

#include <algorithm>

#include "components/world.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

VertexForce at_vertex(const Body& body, const BodyEdit& edit) {
  VertexForce out;
  out.at.triangle = edit.triangle;
  out.at.barycentric = dvec3(0);
  out.at.barycentric[edit.corner] = 1.0;
  out.vertex = body.collision_mesh->triangles[edit.triangle][edit.corner];
  out.force = edit.force;
  return out;
}

void set_force(std::vector<VertexForce>& forces, const VertexForce& now) {
  std::erase_if(forces, [&](const VertexForce& other) { return other.vertex == now.vertex; });
  if (now.force != dvec3(0)) forces.push_back(now);
}

void forget_contacts(SoftState& soft, std::uint32_t body) {
  soft.proximity->forget(body);
  std::erase_if(soft.contacts,
                [&](const ContactPoint& contact) { return contact.body_a == body || contact.body_b == body; });
}

void take_edit(SoftState& soft, std::uint32_t index, const BodyEdit& edit) {
  Body& body = *soft.bodies[index];
  switch (edit.kind) {
    case BodyEditKind::kLoad:
      body.loads.force = edit.force, body.loads.torque = edit.torque;
      return;
    case BodyEditKind::kLoadAt:
      return set_force(body.loads.forces, at_vertex(body, edit));
    case BodyEditKind::kPush:
      body.loads.impulse += edit.force, body.loads.turn += edit.torque;
      return;
    case BodyEditKind::kPushAt:
      body.loads.pushes.push_back(at_vertex(body, edit));
      return;
    case BodyEditKind::kPlace:
      body.place(edit.pose);
      return forget_contacts(soft, index);
    case BodyEditKind::kPresent:
    case BodyEditKind::kAbsent:
      body.taken_out = edit.kind == BodyEditKind::kAbsent;
      body.halt();
      return forget_contacts(soft, index);
  }
}

}  // namespace

void take_body_edits(World& world) {
  SoftState& soft = *world.soft;
  for (BodyEdit edit; soft.body_edits.pop(edit);)
    for (std::uint32_t i = 0; i < soft.bodies.size(); ++i)
      if (soft.bodies[i]->entity == edit.body) take_edit(soft, i, edit);
}

void take_loads(Body& body, double T) {
  BodyLoads& loads = body.loads;
  const bool whole =
      loads.force != dvec3(0) || loads.torque != dvec3(0) || loads.impulse != dvec3(0) || loads.turn != dvec3(0);
  if (body.size() == 0 || (!whole && loads.forces.empty() && loads.pushes.empty())) return;
  Rows column = Rows::Zero(body.size(), 1);
  if (whole) body.load(T * loads.force + loads.impulse, T * loads.torque + loads.turn, column);
  const auto push = [&](std::vector<VertexForce>& forces, double factor) {
    for (VertexForce& each : forces) {
      each.at.position = body.surface_position[each.vertex];
      body.push(each.at, factor * each.force, column, 0);
    }
  };
  push(loads.forces, T);
  push(loads.pushes, 1.0);
  loads.impulse = loads.turn = dvec3(0);
  loads.pushes.clear();
  body.solve(column);
  body.correct(column.col(0));
  body.move_surface(body.surface_velocity);
}

}  // namespace pliant
