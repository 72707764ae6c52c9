// Journal of the soft steps: the pose of each moving body, and what each tool touches. This is the soft clock's half:
// it reads the soft state after each step and never waits. A ring passes the rows to the keeper (body_keeper.h).
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
  double time = 0.0;           // [s] of the soft clock: in lockstep, time of the first touch tick with this pose
  std::uint32_t body = 0;      // index into BodyJournal::bodies()
  dvec3 position{0};           // [m] world: node origin of a rigid body and of a tool's handle, else the centre of mass
  dquat rotation{1, 0, 0, 0};  // object frame to world; for a soft body without a handle, the best-fit rotation
};

// Two bodies that press on each other, or a body that presses on itself. Force: sum of the normal forces of their
// contacts.
struct PressedPair {
  Entity a, b;           // the same twice: self-contact
  double largest = 0.0;  // [N]
  double time = 0.0;     // [s] pressed
};

class BodyJournal {
 public:
  // Covers every moving body, tool and probe among bodies of a prepared world with World::soft. Has room for the rows
  // of `steps` steps until drained.
  BodyJournal(const World& world, std::size_t steps);

  void note(std::uint64_t step, double time);
  void drain(std::vector<BodyRow>& rows) { recorder_.drain(rows); }

  const std::vector<Entity>& bodies() const { return bodies_; }
  std::uint64_t lost() const { return recorder_.lost(); }
  // Number of other objects that this tool pressed on in the last step; 0 if it is not a tool. Thread-safe.
  std::uint32_t touching(Entity tool) const;
  // The object with the strongest contact, or kNoEntity. Thread-safe.
  Entity touches_most(Entity tool) const;
  // Everything this tool has pressed on since the start. Valid while the soft clock is stopped.
  std::vector<Entity> touched(Entity tool) const;
  // Every pair that has pressed since the start. Valid while the soft clock is stopped.
  std::vector<PressedPair> pressed_pairs() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Tool {
    Entity entity;
    std::uint32_t body = 0;          // index into SoftState::bodies
    std::vector<std::uint8_t> now;   // per body: pressed on in the last step
    std::vector<std::uint8_t> ever;  // since the start
    std::atomic<std::uint32_t> count{0};
    std::atomic<std::uint32_t> hardest{kNone};
  };
  void note_bodies(std::uint64_t step, double time);
  void note_touch();
  void note_pairs();

  const SoftState& soft_;
  std::vector<Entity> bodies_;
  std::vector<std::uint32_t> index_;      // per body: index into SoftState::bodies
  std::vector<dquat> rotation_;           // per body: the last rotation, start of the next search
  std::vector<std::vector<dvec3>> rest_;  // [m] object frame, per node from the centre of mass; deformable bodies only
  std::vector<std::unique_ptr<Tool>> tools_;
  struct Pair {
    std::uint64_t key = 0;  // both indices into SoftState::bodies, the smaller one first
    double now = 0.0;       // [N s] of the current step
    double largest = 0.0;   // [N]
    double time = 0.0;      // [s]
  };
  Pair& pair_of(std::uint64_t key);
  std::vector<Pair> pairs_;  // ascending by key; grows with the first contact of a pair
  Recorder<BodyRow> recorder_;
};

}  // namespace pliant
