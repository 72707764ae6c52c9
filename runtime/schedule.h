// A schedule is a list of systems in the order in which they run, with the cost of each. A system is a plain function
// `void name(World&, Tick)`; if B follows A, the schedule says so.
#pragma once

#include <string_view>
#include <vector>

#include "runtime/clock.h"
#include "runtime/histogram.h"

namespace pliant {

template <class World>
struct System {
  std::string_view name;
  void (*run)(World&, Tick);
};

template <class World>
class Schedule {
 public:
  explicit Schedule(std::vector<System<World>> systems) : systems_(std::move(systems)), cost_(systems_.size()) {}

  // Runs every system once. Does not allocate.
  void run(World& world, Tick tick) {
    const std::uint64_t begin = now_ns();
    std::uint64_t before = begin;
    for (std::size_t i = 0; i < systems_.size(); ++i) {
      systems_[i].run(world, tick);
      const std::uint64_t after = now_ns();
      cost_[i].add(after - before);
      before = after;
    }
    total_.add(before - begin);
  }

  const std::vector<System<World>>& systems() const { return systems_; }
  const Histogram& cost(std::size_t system) const { return cost_[system]; }
  const Histogram& total() const { return total_; }

 private:
  std::vector<System<World>> systems_;
  std::vector<Histogram> cost_;  // one per system
  Histogram total_;
};

}  // namespace pliant
