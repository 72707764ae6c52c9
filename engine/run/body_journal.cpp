#include "engine/run/body_journal.h"

#include <algorithm>

#include "components/soft_body.h"
#include "content/files/limits.h"
#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/fem/polar.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

// At least two steps of every body.
std::size_t rows_that_wait(std::size_t steps, std::size_t bodies) {
  const std::size_t each = std::max<std::size_t>(bodies, 1);
  return std::min(steps, std::max<std::size_t>(most(limits::kJournal) / (sizeof(BodyRow) * each), 2)) * each;
}

dvec3 centre_of_mass(const std::vector<dvec3>& nodes, const std::vector<double>& mass) {
  dvec3 sum(0);
  double whole = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    sum += mass[i] * nodes[i];
    whole += mass[i];
  }
  return whole > 0.0 ? sum / whole : dvec3(0);
}

// Pose of a soft body without a handle: the centre of mass, and the rotation nearest to sum m (x - c) X^T, X the node's
// rest position from the rest shape's centre of mass (Mueller et al. 2005, shape matching). `rotation`: that of the
// last step.
Pose mean_pose(const Tissue& tissue, const std::vector<dvec3>& rest, const dquat& rotation) {
  const dvec3 centre = centre_of_mass(tissue.position(), tissue.mass());
  dmat3 moment(0);
  double size = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    moment += tissue.mass()[i] * glm::outerProduct(tissue.position()[i] - centre, rest[i]);
    size += tissue.mass()[i] * dot(rest[i], rest[i]);
  }
  dquat nearest = rotation;
  if (size > 0.0) extract_rotation(moment / size, nearest);
  return {centre, nearest};
}

}  // namespace

BodyJournal::BodyJournal(const World& world, std::size_t steps)
    : soft_(*world.soft), recorder_(rows_that_wait(steps, world.soft->moving.size())) {
  for (const std::uint32_t index : soft_.moving) {
    const Body& body = *soft_.bodies[index];
    if (body.kind == BodyKind::kProbe) continue;  // its pose is in forces.csv
    index_.push_back(index);
    const Pose* pose = world.registry.find<Pose>(body.entity);
    bodies_.push_back(body.entity);
    rotation_.push_back(pose ? pose->rotation : dquat(1, 0, 0, 0));
    rest_.emplace_back();
    const auto* soft = body.as_tissue();
    if (!soft || soft->has_handle()) continue;
    rest_.back() = world.tet_meshes[world.registry.get<SoftBody>(body.entity).tets].nodes;
    const dvec3 centre = centre_of_mass(rest_.back(), soft->tissue().mass());
    for (dvec3& node : rest_.back()) node -= centre;
  }
  for (std::uint32_t i = 0; i < soft_.bodies.size(); ++i) {
    const auto* tool = soft_.bodies[i]->as_tool();
    if (!tool || !tool->has_handle()) continue;
    tools_.push_back(std::make_unique<Tool>());
    tools_.back()->entity = tool->entity;
    tools_.back()->body = i;
    tools_.back()->now.resize(soft_.bodies.size());
    tools_.back()->ever.resize(soft_.bodies.size());
  }
}

void BodyJournal::note(std::uint64_t step, double time) {
  note_bodies(step, time);
  note_touch();
  note_pairs();
}

void BodyJournal::note_bodies(std::uint64_t step, double time) {
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = *soft_.bodies[index_[i]];
    Pose pose;
    if (const auto* rigid = body.as_rigid())
      pose = rigid->pose();
    else if (const auto* tool = body.as_tool(); tool && tool->has_handle())
      pose = tool->handle().object_pose();
    else if (const auto* soft = body.as_tissue())
      pose = mean_pose(soft->tissue(), rest_[i], rotation_[i]);
    rotation_[i] = pose.rotation;
    recorder_.record({step, time, i, pose.position, pose.rotation});
  }
}

void BodyJournal::note_touch() {
  for (const std::unique_ptr<Tool>& tool : tools_) {
    std::fill(tool->now.begin(), tool->now.end(), std::uint8_t{0});
    double hardest = 0.0;
    std::uint32_t pressed_most = kNone;
    for (const ContactPoint& contact : soft_.contacts) {
      const bool pressed = contact.impulse.x > 0.0 && contact.body_a != contact.body_b;
      if (!pressed || (contact.body_a != tool->body && contact.body_b != tool->body)) continue;
      const std::uint32_t other = contact.body_a == tool->body ? contact.body_b : contact.body_a;
      tool->now[other] = tool->ever[other] = 1;
      if (contact.impulse.x > hardest) hardest = contact.impulse.x, pressed_most = other;
    }
    tool->hardest.store(pressed_most, std::memory_order_relaxed);
    tool->count.store(static_cast<std::uint32_t>(std::count(tool->now.begin(), tool->now.end(), 1)),
                      std::memory_order_relaxed);
  }
}

BodyJournal::Pair& BodyJournal::pair_of(std::uint64_t key) {
  auto at =
      std::lower_bound(pairs_.begin(), pairs_.end(), key, [](const Pair& p, std::uint64_t k) { return p.key < k; });
  if (at == pairs_.end() || at->key != key) at = pairs_.insert(at, Pair{key});
  return *at;
}

void BodyJournal::note_pairs() {
  const double T = soft_.impulse_time;
  for (const ContactPoint& contact : soft_.contacts) {
    if (!(contact.impulse.x > 0.0) || contact.hold.joint >= 0) continue;
    const auto [low, high] = std::minmax(contact.body_a, contact.body_b);
    pair_of(std::uint64_t{low} << 32 | high).now += contact.impulse.x;
  }
  for (Pair& pair : pairs_) {
    if (!(pair.now > 0.0)) continue;
    pair.largest = std::max(pair.largest, pair.now / T);
    pair.time += soft_.step;
    pair.now = 0.0;
  }
}

std::vector<PressedPair> BodyJournal::pressed_pairs() const {
  std::vector<PressedPair> out;
  for (const Pair& pair : pairs_) {
    const Entity a = soft_.bodies[pair.key >> 32]->entity, b = soft_.bodies[pair.key & 0xffffffff]->entity;
    out.push_back({a, b, pair.largest, pair.time});
  }
  return out;
}

std::uint32_t BodyJournal::touching(Entity tool) const {
  for (const std::unique_ptr<Tool>& each : tools_)
    if (each->entity == tool) return each->count.load(std::memory_order_relaxed);
  return 0;
}

Entity BodyJournal::touches_most(Entity tool) const {
  for (const std::unique_ptr<Tool>& each : tools_) {
    if (!(each->entity == tool)) continue;
    const std::uint32_t body = each->hardest.load(std::memory_order_relaxed);
    return body == kNone ? kNoEntity : soft_.bodies[body]->entity;
  }
  return kNoEntity;
}

std::vector<Entity> BodyJournal::touched(Entity tool) const {
  std::vector<Entity> objects;
  for (const std::unique_ptr<Tool>& each : tools_)
    for (std::size_t i = 0; each->entity == tool && i < each->ever.size(); ++i)
      if (each->ever[i]) objects.push_back(soft_.bodies[i]->entity);
  return objects;
}

}  // namespace pliant
