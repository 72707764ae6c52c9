// What is noted of every soft step: where each moving body is, and what each tool touches. The soft clock's half: it
// reads the soft state after each step, and does not wait. Rows leave through a ring for whoever keeps them
// (body_keeper.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "components/world.h"
#include "runtime/recorder.h"

namespace pliant {

// One body after one soft step.
struct BodyRow {
  std::uint64_t step = 0;
  double time = 0.0;       // [s] of the soft clock: in lockstep, that of the touch tick that first has this pose
  std::uint32_t body = 0;  // index into BodyJournal::bodies()
  dvec3 position{0};  // [m] world: of a rigid body and of a tool's handle the node's origin, else the centre of mass
  dquat rotation{1, 0, 0, 0};  // object frame to world; of a soft body without a handle, the rotation nearest to it
};

class BodyJournal {
 public:
  // Every moving body, tool and probe among bodies of a prepared world with World::soft. Holds `steps` steps' rows
  // until drained.
  BodyJournal(const World& world, std::size_t steps);

  void note(std::uint64_t step, double time);
  void drain(std::vector<BodyRow>& rows) { recorder_.drain(rows); }

  const std::vector<Entity>& bodies() const { return bodies_; }
  std::uint64_t lost() const { return recorder_.lost(); }
  // How many objects other than itself this tool pressed on in the last step; 0 of what is no tool. From any thread.
  std::uint32_t touching(Entity tool) const;
  // The one with the strongest contact of them, or kNoEntity. From any thread.
  Entity touches_most(Entity tool) const;
  // What this tool has pressed on since the start. Valid while the soft clock stands still.
  std::vector<Entity> touched(Entity tool) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Tool {
    Entity entity;
    std::uint32_t body = 0;          // into SoftState::bodies
    std::vector<std::uint8_t> now;   // of each body: pressed on in the last step
    std::vector<std::uint8_t> ever;  // since the start
    std::atomic<std::uint32_t> count{0};
    std::atomic<std::uint32_t> hardest{kNone};
  };
  void note_bodies(std::uint64_t step, double time);
  void note_touch();

  const SoftState& soft_;
  std::vector<Entity> bodies_;
  std::vector<std::uint32_t> index_;      // into SoftState::bodies, of each
  std::vector<dquat> rotation_;           // the last, of each: where the next one is looked for
  std::vector<std::vector<dvec3>> rest_;  // [m] object frame, per node from the centre of mass; bent bodies only
  std::vector<std::unique_ptr<Tool>> tools_;
  Recorder<BodyRow> recorder_;
};

}  // namespace pliant
