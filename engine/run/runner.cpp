#include "engine/run/runner.h"

#include <exception>

#include "systems/schedule.h"
#include "systems/tool/prepare_tools.h"

namespace pliant {

Runner::Runner(World& world) : world_(world), schedule_(touch_schedule()), soft_(world) {}

void Runner::step(Tick tick) {
  soft_.reach(tick.time);
  for (const TickPart& each : parts_)
    if (each.before) each.before(tick);
  schedule_.run(world_, tick);
  for (const TickPart& each : parts_)
    if (each.after) each.after(tick);
}

TouchHooks Runner::hooks() {
  const auto all = [this](std::function<void(Tick)> TouchHooks::*hook) {
    return [this, hook](Tick tick) {
      for (const TickPart& each : parts_)
        if (each.*hook) (each.*hook)(tick);
    };
  };
  return {all(&TouchHooks::before), all(&TouchHooks::after), all(&TouchHooks::idle), [this] {
            for (const TickPart& each : parts_)
              if (each.end) each.end();
          }};
}

Status Runner::start(std::uint64_t ticks) {
  limit_tool_ticks(world_);
  try {
    for (started_ = 0; started_ < parts_.size(); ++started_)
      if (parts_[started_].start)
        if (Status s = parts_[started_].start(); !s) {
          halt();
          return s;
        }
    clock_ = std::make_unique<TouchClock>(world_, schedule_, &soft_, world_.simulation.touch_rate, ticks, hooks());
    clock_->start();
  } catch (const std::exception& thrown) {
    clock_.reset();
    halt();
    return Error{"clocks", std::string("no thread could be started (") + thrown.what() + ")",
                 "end other programs or raise the limit (ulimit -u)"};
  }
  return Done{};
}

void Runner::halt() noexcept {
  for (; started_ > 0; --started_)
    if (const auto& halt_one = parts_[started_ - 1].halt) halt_one();
}

void Runner::stop() {
  if (clock_) {
    clock_->stop();
    overruns_ = clock_->overruns();
    reached_ = clock_->now();
    priority_ = clock_->has_priority();
    error_ = clock_->error() ? clock_->error() : soft_.error();
    clock_.reset();
  }
  halt();
}

}  // namespace pliant
