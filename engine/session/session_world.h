// Access of studies to a Session beyond its public interface: its world, and every tick.
#pragma once

#include <functional>

#include "components/world.h"
#include "pliant/session.h"
#include "runtime/schedule.h"

namespace pliant {

const World& world_of(const Session& session);  // valid until restart(); the touch clock's while the clocks run

// Called last in every tick, on the touch clock; must not allocate, wait or throw.
void on_tick(Session& session, std::function<void(Tick)> does);

}  // namespace pliant
