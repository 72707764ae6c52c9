#include "systems/soft/contact/rolling.h"

#include "systems/soft/body/rigid_state.h"

namespace pliant {
namespace {

constexpr double kRolls = 2e-5;  // [1] of the load

}  // namespace

void resist_rolling(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                    const Delassus& delassus) {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const RigidState* const rigid = bodies[b]->as_rigid();
    if (!rigid) continue;
    double load = 0.0;  // [N s]
    bool rolls = false, alone = true;
    for (const int i : delassus.of[b].contacts) {
      const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
      if (c.hold.joint < 0 && !(c.impulse.x > 0.0)) continue;
      alone = alone && c.hold.joint < 0 && bodies[c.body_a == b ? c.body_b : c.body_a]->size() == 0;
      rolls = rolls || c.a.beside || c.b.beside;
      load += c.impulse.x;
    }
    if (!rolls || !alone) continue;
    const double speed = bodies[b]->velocity().head<3>().norm(), slower = kRolls * load / rigid->mass().mass;
    bodies[b]->correct(-(slower < speed ? slower / speed : 1.0) * bodies[b]->velocity());
  }
}

}  // namespace pliant
