#include "systems/soft/under_gravity.h"

#include <fmt/format.h>

#include <algorithm>

#include "components/soft_body.h"
#include "systems/soft/body/equilibrium.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

constexpr double kFarAtEnd = 0.1;    // [1] of a body's size: larger displacements from the start are reported
constexpr double kOutOfScene = 5.0;  // [1] of its size: a body that has fallen this far is not supported

std::string body_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : std::string();
}

dvec3 gravity_of(const World& world, Entity entity) {
  const Pose* pose = world.registry.find<Pose>(entity);
  return pose ? glm::conjugate(pose->rotation) * world.simulation.gravity : world.simulation.gravity;
}

// The pose of a tool is set by its handle; it always begins in equilibrium.
bool decides(const World& world, Entity entity, const SoftBody& body, const TetMesh& tets) {
  return body.under_gravity != UnderGravity::kFalls && tets.rigid_counts.empty() &&
         length(world.simulation.gravity) > 0.0 && !(world.registry.has<Handle6>(entity) && tets.handle_count > 0);
}

void begin_body(const SoftBody& body, dvec3 gravity, TetMesh& tets) {
  if (!tets.start.empty() && body.under_gravity == UnderGravity::kModelled) tets.nodes = tets.start;
  tets.start.clear();
  const auto say = [&](Note note) { tets.report.findings.push_back(std::move(note)); };
  if (tets.pinned_begin() == tets.node_count())
    return say({"is not pinned, so it falls whatever `under_gravity` says", "pin it", "tissue.gravity", {}});
  if (body.under_gravity == UnderGravity::kModelled) {
    Unloaded unloaded = find_unloaded(tets, body, gravity);
    if (unloaded.found) {
      tets.start = std::move(tets.nodes);
      tets.nodes = std::move(unloaded.nodes);
      return;
    }
    Equilibrium rest = find_equilibrium(tets, body, gravity);
    if (rest.converged) tets.start = std::move(rest.nodes);
    std::optional<Note> doubt = sag_doubt(body, {.held = true}, &unloaded);
    doubt->what += rest.converged
                       ? fmt::format(", so it begins where it rests, {:.3g} mm from where it is drawn", 1e3 * rest.most)
                       : std::string(", so it falls");
    return say(*std::move(doubt));
  }
  Equilibrium rest = find_equilibrium(tets, body, gravity);
  if (rest.converged) tets.start = std::move(rest.nodes);
  if (std::optional<Note> doubt = sag_doubt(body, rest, nullptr)) say(*std::move(doubt));
}

}  // namespace

void begin_under_gravity(World& world) {
  for (auto [entity, body] : world.registry.view<SoftBody>()) {
    TetMesh& tets = world.tet_meshes[body.tets];
    if (decides(world, entity, body, tets)) begin_body(body, gravity_of(world, entity), tets);
  }
}

void find_sag(World& world) {
  for (auto [entity, body] : world.registry.view<SoftBody>()) {
    TetMesh& tets = world.tet_meshes[body.tets];
    const bool tool = world.registry.has<Handle6>(entity);
    if (tool || body.under_gravity != UnderGravity::kFalls || !(length(world.simulation.gravity) > 0.0)) continue;
    const Equilibrium rest = find_equilibrium(tets, body, gravity_of(world, entity));
    if (std::optional<Note> doubt = sag_doubt(body, rest, nullptr)) tets.report.findings.push_back(*std::move(doubt));
  }
}

std::vector<Note> tissue_findings(const World& world) {
  std::vector<Note> all;
  for (auto [entity, body] : world.registry.view<const SoftBody>()) {
    const std::string name = body_name(world, entity);
    for (Note finding : world.tet_meshes[body.tets].report.findings) {
      finding.what = "`" + name + "`: " + finding.what;
      finding.of = name;
      all.push_back(std::move(finding));
    }
  }
  return all;
}

std::vector<Note> explain_sag(const World& world) {
  std::vector<Note> all;
  if (!world.soft) return all;
  for (const std::unique_ptr<Body>& body : world.soft->bodies) {
    const auto* tissue = body->as_tissue();
    if (!tissue || tissue->has_handle()) continue;
    const TetMesh& tets = tissue->tets();
    const Pose* pose = world.registry.find<Pose>(body->entity);
    std::vector<dvec3> began = tets.start.empty() ? tets.nodes : tets.start;
    if (pose)
      for (dvec3& x : began) x = pose->to_world(x);
    const double size = size_of(began);
    double most = 0.0;
    for (std::size_t i = 0; i < began.size(); ++i)
      most = std::max(most, length(tissue->tissue().position()[i] - began[i]));
    const double turned = turn_between(began, tissue->tissue().position());
    const std::string name = body_name(world, body->entity);
    const auto note = [&](const std::string& what, const char* cure) {
      all.push_back({"`" + name + "` " + what, cure, "soft.sagged", name});
    };
    const bool pinned = tets.pinned_begin() < tets.node_count();
    if (!pinned && most > kOutOfScene * size)
      note(fmt::format("fell {:.3g} m, as nothing holds it", most), "pin it, or put something below it");
    else if (pinned && turned > kMuchTurn)
      note(fmt::format("ended turned by {:.0f} degrees, and {:.3g} mm from where it began: what is pinned does not "
                       "hold it",
                       turned * 180.0 / 3.14159265358979, most * 1e3),
           "pin more of it, or let it keep its shape (`under_gravity` `modelled`)");
    else if (pinned && most > kFarAtEnd * size)
      note(fmt::format("ended {:.3g} mm from where it began, {:.0f} % of its size", most * 1e3, 100.0 * most / size),
           "if it shall not sag so far, pin more of it, or let it keep its shape (`under_gravity` `modelled`)");
  }
  return all;
}

}  // namespace pliant
