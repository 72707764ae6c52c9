// The frame side of a Session: what the touch and soft clocks have shown so far, complete. Owner's thread.
#pragma once

#include <functional>
#include <vector>

#include "components/world.h"

namespace pliant {

class SessionView {
 public:
  // After the world was prepared.
  void reset(const World& world);
  // Lockstep: everything that changed until now. `tick`: the last one.
  void take_all(World& world, Tick tick);
  // Real time: what has come since.
  void take(World& world);

  const std::vector<vec4>* stream(Entity object) const;  // null: no deformable surface
  const SoftObjectSnapshot* soft(Entity object) const;   // null: nothing that moves, or not seen yet
  mat4 to_world(const World& world, Entity object) const;
  // Of a soft body without a handle: where the scene put it, which is where its rest shape is. Else to_world().
  mat4 rest_to_world(const World& world, Entity object) const;
  std::uint64_t version() const { return version_; }  // another one: something new was taken
  const std::vector<ContactMark>& contacts() const { return contacts_; }
  const std::vector<HandleMark>& handles() const { return handles_; }

  // Called for every snapshot that is taken: a renderer follows them (engine/picture/pictures.cpp).
  std::function<void(const Snapshot&)> seen;
  std::function<void(const SoftSnapshot&)> soft_seen;

 private:
  void add(const Snapshot& snapshot);
  struct Shown {
    Entity object;
    mat4 to_world{1};
    std::vector<vec4> stream;
  };
  std::vector<Shown> shown_;
  std::vector<SoftObjectSnapshot> soft_;
  std::vector<ContactMark> contacts_;
  std::vector<HandleMark> handles_;
  std::uint64_t version_ = 1;
};

}  // namespace pliant
