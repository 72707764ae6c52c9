// The frame side of a Session: the complete state that the touch and soft clocks have published so far. Owner's thread.
#pragma once

#include <functional>
#include <vector>

#include "components/world.h"
#include "pliant/session.h"

namespace pliant {

class SessionView {
 public:
  // Call after the world was prepared.
  void reset(const World& world);
  // Lockstep: takes all changes until now. `tick`: the last one.
  void take_all(World& world, Tick tick);
  // Real time: takes what has arrived since the last call.
  void take(World& world);

  const std::vector<vec4>* stream(Entity object) const;  // null: not a deformable surface
  // Copies what has changed since its last call into `out`, whose size is the stream's, or is set. False: no surface.
  bool take_changes(Entity object, std::vector<vec4>& out, std::vector<StreamPart>& changed);
  const SoftObjectSnapshot* soft(Entity object) const;  // null: not moving, or no snapshot yet
  mat4 to_world(const World& world, Entity object) const;
  // For a soft body without a handle: its initial pose in the scene, which is that of its rest shape. Else to_world().
  mat4 rest_to_world(const World& world, Entity object) const;
  std::uint64_t version() const { return version_; }  // changes when something new was taken
  std::uint64_t tick() const { return tick_; }        // of the surfaces' newest snapshot
  bool complete() const { return complete_; }         // no changes up to that tick are left for a next snapshot
  bool has_soft() const { return !soft_.empty(); }    // a soft snapshot was taken
  const std::vector<ContactMark>& contacts() const { return contacts_; }
  const std::vector<HandleMark>& handles() const { return handles_; }

  // Called for every snapshot taken: a renderer uses them (engine/picture/pictures.cpp).
  std::function<void(const Snapshot&)> seen;
  std::function<void(const SoftSnapshot&)> soft_seen;

 private:
  void add(const Snapshot& snapshot);
  struct Shown {
    Entity object;
    mat4 to_world{1};
    std::vector<vec4> stream;
    std::vector<std::uint8_t> changed;  // per zone, since the last take_changes()
  };
  std::vector<Shown> shown_;
  std::vector<SoftObjectSnapshot> soft_;
  std::vector<ContactMark> contacts_;
  std::vector<HandleMark> handles_;
  std::uint64_t version_ = 1, tick_ = 0;
  bool complete_ = true;
};

}  // namespace pliant
