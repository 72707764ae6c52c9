// Sessions: open, names, time, sources, recordings, states, devices.
#include "c/session.h"

#include <cmath>

#include "c/scene.h"

using namespace pliant::c;

namespace pliant::c {

void SessionHandle::read_names() {
  const std::vector<std::string> new_effectors = session.effectors();
  const std::vector<std::string>& new_objects = session.objects();
  for (std::size_t i = effectors.size(); i < new_effectors.size(); ++i) effectors.push_back(new_effectors[i]);
  for (std::size_t i = objects.size(); i < new_objects.size(); ++i) objects.push_back(new_objects[i]);
}

}  // namespace pliant::c

namespace {

// At the end of the process, a session that was not destroyed stops: its threads would use what no longer exists.
struct StopAtExit {
  ~StopAtExit() {
    for_each_idle(HandleKind::kSession, [](Handle& handle) {
      if (!static_cast<SessionHandle&>(handle).session.stop()) return;
    });
  }
};

void name_at(const std::deque<std::string>& names, uint32_t index, const char** out) {
  needed(out, "out");
  throw_unless_below(index, names.size(), "");
  *out = names[index].c_str();
}

bool is_sound(const pliant_pose& pose) {
  const pliant::dvec3 at = of_c(pose.position);
  const pliant::dquat turn = of_c(pose.rotation);
  return std::isfinite(dot(at, at)) && std::abs(dot(turn, turn) - 1.0) < 1e-6;
}

}  // namespace

pliant_status pliant_session_open(pliant_scene* scene, pliant_progress progress, void* user, pliant_session** out) {
  return border(__func__, [&] {
    needed(out, "out");
    const Held held(scene, HandleKind::kScene);
    throw_unless_held(held, "scene");
    const auto& of = static_cast<SceneHandle&>(*held.slot().object);
    auto opened = pliant::Session::open(of.scene, progress_of_c(progress, user));
    if (!opened) throw without(opened.error(), of.folder);
    auto handle = std::make_unique<SessionHandle>(std::move(opened).value());
    static const StopAtExit stop;
    void* const made = make_handle(HandleKind::kSession, std::move(handle));
    if (!made) throw std::bad_alloc();
    *out = static_cast<pliant_session*>(made);
  });
}

pliant_status pliant_session_destroy(pliant_session* session) {
  if (!session) return PLIANT_OK;
  return border(__func__, [&] {
    Held held(session, HandleKind::kSession);
    throw_unless_held(held, "session");
    held.destroy();
  });
}

pliant_status pliant_session_effector_count(pliant_session* session, uint32_t* count) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { needed(count, "count") = static_cast<uint32_t>(of.effectors.size()); });
}

pliant_status pliant_session_effector(pliant_session* session, uint32_t index, const char** out) {
  return with_session(session, __func__, [&](SessionHandle& of) { name_at(of.effectors, index, out); });
}

pliant_status pliant_session_object_count(pliant_session* session, uint32_t* count) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { needed(count, "count") = static_cast<uint32_t>(of.objects.size()); });
}

pliant_status pliant_session_object(pliant_session* session, uint32_t index, const char** out) {
  return with_session(session, __func__, [&](SessionHandle& of) { name_at(of.objects, index, out); });
}

pliant_status pliant_session_note_count(pliant_session* session, size_t* count) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { needed(count, "count") = of.session.notes().size(); });
}

pliant_status pliant_session_note(pliant_session* session, size_t index, const char** out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(out, "out");
    throw_unless_below(index, of.session.notes().size(), "");
    *out = of.session.notes()[index].c_str();
  });
}

pliant_status pliant_session_tick(pliant_session* session, const pliant_pose* poses, pliant_wrench* felt,
                                  size_t count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(poses, "poses");
    if (count != of.effectors.size())
      throw Misuse{"`count` is " + std::to_string(count) + "; the session has " + std::to_string(of.effectors.size()) +
                       " effectors",
                   "pass a pose for each", "call.count"};
    const auto move = [&](std::size_t i) {
      check(of.session.move(of.effectors[i], of_c(poses[i].position), of_c(poses[i].rotation)));
    };
    for (std::size_t i = 0; i < count; ++i)
      if (!is_sound(poses[i])) move(i);  // which fails, before another one moves
    for (std::size_t i = 0; i < count; ++i) move(i);
    check(of.session.step(1));
    if (!felt) return;
    for (std::size_t i = 0; i < count; ++i) {
      const pliant::Reading reading = taken(of.session.reading(of.effectors[i]));
      felt[i] = {to_c(reading.force), to_c(reading.torque)};
    }
  });
}

pliant_status pliant_session_step(pliant_session* session, uint64_t ticks) {
  return with_session(session, __func__, [&](SessionHandle& of) { check(of.session.step(ticks)); });
}

pliant_status pliant_session_start(pliant_session* session) {
  return with_devices(session, __func__, [&](SessionHandle& of) { check(of.session.start()); });
}

pliant_status pliant_session_pause(pliant_session* session, int32_t paused) {
  return with_session(session, __func__, [&](SessionHandle& of) { check(of.session.pause(paused != 0)); });
}

pliant_status pliant_session_stop(pliant_session* session) {
  return with_session(session, __func__, [&](SessionHandle& of) { check(of.session.stop()); });
}

pliant_status pliant_session_is_running(pliant_session* session, int32_t* out) {
  return with_session(session, __func__, [&](SessionHandle& of) { needed(out, "out") = of.session.running(); });
}

pliant_status pliant_session_restart(pliant_session* session) {
  return with_devices(session, __func__, [&](SessionHandle& of) { check(of.session.restart()); });
}

pliant_status pliant_session_time(pliant_session* session, double* seconds) {
  return with_session(session, __func__, [&](SessionHandle& of) { needed(seconds, "seconds") = of.session.time(); });
}

pliant_status pliant_session_move(pliant_session* session, const char* effector, pliant_pose pose) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.move(text(effector, "effector"), of_c(pose.position), of_c(pose.rotation)));
  });
}

pliant_status pliant_session_follow(pliant_session* session, const char* effector, const pliant_path_row* rows,
                                    size_t count, int32_t repeats) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.follow(text(effector, "effector"), path_of_c(rows, count, repeats != 0)));
  });
}

pliant_status pliant_session_orbit(pliant_session* session, const char* effector) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.orbit(text(effector, "effector"))); });
}

pliant_status pliant_session_connect(pliant_session* session, const char* effector, const char* driver) {
  return with_devices(session, __func__, [&](SessionHandle& of) {
    check(of.session.connect(text(effector, "effector"), text(driver, "driver")));
  });
}

pliant_status pliant_session_release(pliant_session* session, const char* effector) {
  return with_devices(session, __func__,
                      [&](SessionHandle& of) { check(of.session.release(text(effector, "effector"))); });
}

pliant_status pliant_session_record(pliant_session* session, const char* path, int32_t replace) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.record(text(path, "path"), replace != 0)); });
}

pliant_status pliant_session_end_recording(pliant_session* session) {
  return with_session(session, __func__, [&](SessionHandle& of) { check(of.session.end_recording()); });
}

pliant_status pliant_session_replay(pliant_session* session, const char* path) {
  return with_devices(session, __func__, [&](SessionHandle& of) { check(of.session.replay(text(path, "path"))); });
}

pliant_status pliant_session_save_state(pliant_session* session, const uint8_t** bytes, size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(bytes, "bytes");
    needed(count, "count");
    of.state = taken(of.session.save_state());
    *bytes = of.state.data();
    *count = of.state.size();
  });
}

pliant_status pliant_session_restore_state(pliant_session* session, const uint8_t* bytes, size_t count) {
  return with_devices(session, __func__, [&](SessionHandle& of) {
    needed(bytes, "bytes");
    check(of.session.restore_state({bytes, bytes + count}));
  });
}

pliant_status pliant_session_guard(pliant_session* session, const char* effector, const pliant_guard* guard) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const pliant_guard& c = sized(guard, "guard");
    pliant::GuardParameters parameters;
    if (c.by_hand) parameters.arming = pliant::Arming::kByHand;
    parameters.dead_man = c.dead_man;
    parameters.max_force = c.max_force;
    parameters.max_torque = c.max_torque;
    parameters.max_velocity = c.max_velocity;
    if (c.slew != 0.0) parameters.slew = c.slew;
    if (c.ramp != 0.0) parameters.ramp = c.ramp;
    check(of.session.guard(text(effector, "effector"), parameters));
  });
}

pliant_status pliant_session_device_report(pliant_session* session, const char* effector, pliant_device_report* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    const pliant::DeviceReport report = taken(of.session.device_state(text(effector, "effector")));
    of.cause = pliant::describe(report.cause);
    *out = {sizeof *out,
            static_cast<int32_t>(report.state),
            of.cause.c_str(),
            report.force,
            report.max_force,
            report.heat,
            report.sample_age,
            sample_to_c(report.sample),
            {to_c(report.wanted.force), to_c(report.wanted.torque)},
            {to_c(report.sent.force), to_c(report.sent.torque)},
            report.figures.periods,
            report.figures.missed,
            report.figures.rate};
  });
}

pliant_status pliant_session_arm(pliant_session* session, const char* effector) {
  return with_session(session, __func__, [&](SessionHandle& of) { check(of.session.arm(text(effector, "effector"))); });
}

pliant_status pliant_session_disarm(pliant_session* session, const char* effector) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.disarm(text(effector, "effector"))); });
}

pliant_status pliant_session_emergency_stop(pliant_session* session) {
  return border(__func__, [&] {
    needed(session, "session");
    Slot* const slot = find_slot(session, HandleKind::kSession);
    std::unique_lock<std::mutex> lock;
    if (slot) lock = std::unique_lock(slot->devices);
    if (!slot || find_slot(session, HandleKind::kSession) != slot || !slot->object)
      throw Misuse{"`session` is not a handle of that kind, or was destroyed", "pass one that is alive", "call.handle"};
    static_cast<SessionHandle&>(*slot->object).session.emergency_stop();
  });
}
