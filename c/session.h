// A session behind its handle, with what its calls return pointers into.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "c/border.h"

namespace pliant::c {

// Of one object, for a renderer.
struct Drawn {
  Geometry geometry;
  std::vector<vec4> stream;
  std::vector<StreamPart> changed;
};

struct SessionHandle : Handle {
  explicit SessionHandle(Session&& opened) : session(std::move(opened)) { read_names(); }
  void read_names();  // existing ones keep their addresses

  Session session;
  std::deque<std::string> effectors, objects;
  std::map<std::string, Drawn> drawn;
  std::vector<vec3> positions;           // scratch
  std::vector<std::uint32_t> triangles;  // scratch
  std::vector<FeltEvent> events;         // taken from the session, from `next_event` on not yet by the caller
  std::size_t next_event = 0;
  std::uint64_t lost_events = 0;
  std::vector<std::string> sentences;  // of the events that the caller has
  struct Readings {
    std::vector<Reading> taken;
    std::size_t next = 0;
    std::uint64_t lost = 0;
  };
  std::map<std::string, Readings> readings;
  std::vector<Note> findings;
  std::vector<std::string> finding_texts;
  std::vector<std::uint8_t> state;
  std::string cause;  // of a device report
};

template <class F>
pliant_status with_session(pliant_session* session, const char* call, F&& act) noexcept {
  return border(call, [&] {
    const Held held(session, HandleKind::kSession);
    throw_unless_held(held, "session");
    act(static_cast<SessionHandle&>(*held.slot().object));
  });
}

// For calls during which an emergency stop must wait.
template <class F>
pliant_status with_devices(pliant_session* session, const char* call, F&& act) noexcept {
  return border(call, [&] {
    const Held held(session, HandleKind::kSession);
    throw_unless_held(held, "session");
    const std::lock_guard lock(held.slot().devices);
    act(static_cast<SessionHandle&>(*held.slot().object));
  });
}

pliant_reading reading_to_c(const Reading& reading);

}  // namespace pliant::c
