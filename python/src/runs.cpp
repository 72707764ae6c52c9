#include "python/src/runs.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <thread>
#include <tuple>

#include "python/src/scenes.h"

namespace pliant_python {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kLook = std::chrono::milliseconds(50);  // between two looks for Ctrl-C

// A run to be: its poses, and room for its readings.
struct Plan {
  std::vector<Track> tracks;
  std::vector<std::string> effectors;
  std::vector<Felt> felt;                                              // of each effector
  std::vector<std::tuple<std::string, std::string, double>> settings;  // name, key, value: before its first tick
  std::size_t ticks = 0;
  py::array_t<double> time;
  double* time_at = nullptr;
  std::vector<pliant::FeltEvent> events;
  std::uint64_t events_lost = 0;
};

Plan plan_of(const py::dict& tracks, const py::object& ticks, const std::vector<std::string>& effectors,
             const std::vector<bool>& tools, const std::string& where) {
  Plan plan;
  plan.effectors = effectors;
  if (!ticks.is_none()) plan.ticks = ticks.cast<std::size_t>();
  bool first = true;
  for (const auto& [key, value] : tracks) {
    Track track{py::str(key), doubles(value, where), nullptr, 3};
    if (track.rows.ndim() != 2 || (track.rows.shape(1) != 3 && track.rows.shape(1) != 7))
      wrong_argument(where, "must have a row a tick, (x, y, z) or (x, y, z, qw, qx, qy, qz)",
                     "its shape is " + std::string(py::str(track.rows.attr("shape"))));
    const auto length = static_cast<std::size_t>(track.rows.shape(0));
    if (!first && length != plan.ticks)
      wrong_argument(where,
                     "has " + std::to_string(length) + " rows of `" + track.effector + "` and " +
                         std::to_string(plan.ticks) + " of another",
                     "give all as many");
    plan.ticks = length;
    first = false;
    track.at = track.rows.data();
    track.columns = static_cast<std::size_t>(track.rows.shape(1));
    plan.tracks.push_back(std::move(track));
  }
  for (std::size_t i = 0; i < effectors.size(); ++i) plan.felt.emplace_back(plan.ticks, tools[i]);
  plan.time = py::array_t<double>(static_cast<py::ssize_t>(plan.ticks));
  plan.time_at = plan.time.mutable_data();
  return plan;
}

// Without the GIL. `stop()` is asked from time to time.
template <class Stop>
bool carry_out(pliant::Session& session, Plan& plan, const std::string& where, const Stop& stop) {
  auto looked = Clock::now();
  std::vector<pliant::FeltEvent> events;
  const auto pose_of = [](const Track& track, std::size_t row) {
    const double* p = track.at + row * track.columns;
    return track.columns == 3 ? Pose{{p[0], p[1], p[2]}} : Pose{{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}};
  };
  const auto move = [&](const Track& track, std::size_t row) {
    const Pose pose = pose_of(track, row);
    if (const pliant::Status moved = session.move(track.effector, pose.position, pose.rotation); !moved)
      throw Failure(moved.error().at(where + ", row " + std::to_string(row) + ", `" + track.effector + "`"));
  };
  for (const Track& track : plan.tracks)  // a path that is refused has not begun
    for (std::size_t row = 0; row < plan.ticks; ++row)
      if (!is_sound(pose_of(track, row))) move(track, row);
  for (std::size_t row = 0; row < plan.ticks; ++row) {
    for (const Track& track : plan.tracks) move(track, row);
    check(session.step());
    for (std::size_t i = 0; i < plan.effectors.size(); ++i) {
      const pliant::Reading reading = check(session.reading(plan.effectors[i]));
      plan.felt[i].keep(row, reading);
      plan.time_at[row] = reading.time;
    }
    if (plan.effectors.empty()) plan.time_at[row] = session.time();
    plan.events_lost += session.take_events(events);
    plan.events.insert(plan.events.end(), std::make_move_iterator(events.begin()),
                       std::make_move_iterator(events.end()));
    if (const auto now = Clock::now(); now - looked > kLook) {
      looked = now;
      check_end();
      if (stop()) return false;
    }
  }
  return true;
}

py::dict result_of(const Plan& plan) {
  py::dict felt;
  for (std::size_t i = 0; i < plan.effectors.size(); ++i) felt[py::str(plan.effectors[i])] = plan.felt[i].arrays();
  py::dict result;
  result["time"] = plan.time;
  result["felt"] = felt;
  result["events"] = plan.events;
  result["events_lost"] = plan.events_lost;
  return result;
}

py::dict run(HeldSession& held, const py::dict& tracks, const py::object& ticks) {
  std::vector<bool> tools;
  for (const std::string& name : held.effectors()) tools.push_back(held.is_tool(name));
  Plan plan = plan_of(tracks, ticks, held.effectors(), tools, "path");
  const bool done = held.advance([&](pliant::Session& session) {
    return carry_out(session, plan, "path", [&] {
      held.show_in_long_call();
      return interrupted();
    });
  });
  if (!done) throw py::error_already_set();
  return result_of(plan);
}

// The readings that were kept since the last call.
py::dict take(HeldSession& held, const std::string& name) {
  std::vector<pliant::Reading> readings;
  const std::uint64_t lost = held.with([&](pliant::Session& s) { return check(s.take_readings(name, readings)); });
  Felt felt(readings.size(), held.is_tool(name));
  py::array_t<double> time(static_cast<py::ssize_t>(readings.size()));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    felt.keep(i, readings[i]);
    time.mutable_data()[i] = readings[i].time;
  }
  py::dict out = felt.arrays();
  out["time"] = time;
  out["lost"] = lost;
  return out;
}

// The next path goes to the next free thread, which has a session of its own. Every path begins at time 0.
struct Batch {
  const pliant::Scene& scene;
  std::vector<Plan>& plans;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t running = 0;
  std::size_t failed_at = static_cast<std::size_t>(-1);
  std::exception_ptr failed;

  void work() {
    std::optional<pliant::Session> session;
    bool session_is_set = false;
    for (std::size_t i = next++; i < plans.size() && !stop; i = next++) {
      try {
        if (session && plans[i].settings.empty() && !session_is_set)
          check(session->restart());
        else
          session.emplace(check(pliant::Session::open(scene)));
        session_is_set = !plans[i].settings.empty();  // restart() would keep them
        for (const auto& [name, key, value] : plans[i].settings) check(session->set(name, key, value));
        carry_out(*session, plans[i], "paths[" + std::to_string(i) + "]", [this] { return stop.load(); });
        check_laws();
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (i < failed_at) failed_at = i, failed = std::current_exception();
        stop = true;
      }
    }
    const std::lock_guard lock(mutex);
    --running;
    changed.notify_all();
  }
};

py::list batch(HeldSession& sample, const HeldScene& scene, const py::list& paths, const py::list& settings,
               unsigned threads) {
  std::vector<bool> tools;
  for (const std::string& name : sample.effectors()) tools.push_back(sample.is_tool(name));
  std::vector<Plan> plans;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    plans.push_back(
        plan_of(paths[i].cast<py::dict>(), py::none(), sample.effectors(), tools, "paths[" + std::to_string(i) + "]"));
    if (i < settings.size()) plans.back().settings = settings[i].cast<decltype(Plan::settings)>();
  }
  bool stopped = false;
  std::exception_ptr failed;
  {
    const py::gil_scoped_release without_gil;
    Batch work{scene, plans};
    const auto count = std::min<std::size_t>(std::max(1u, threads), plans.size());
    work.running = count;
    std::vector<std::jthread> team;
    for (std::size_t i = 0; i < count; ++i) team.emplace_back([&] { work.work(); });
    std::unique_lock lock(work.mutex);
    while (work.running > 0) {
      work.changed.wait_for(lock, kLook);
      lock.unlock();
      if (!stopped && interrupted()) stopped = work.stop = true;
      lock.lock();
    }
    failed = work.failed;
  }
  if (stopped) throw py::error_already_set();
  if (failed) std::rethrow_exception(failed);
  py::list results;
  for (const Plan& plan : plans) results.append(result_of(plan));
  return results;
}

}  // namespace

Felt::Felt(std::size_t ticks, bool tool) {
  const auto n = static_cast<py::ssize_t>(ticks);
  const std::vector<py::ssize_t> vectors{n, 3};
  force_ = py::array_t<double>(vectors), position_ = py::array_t<double>(vectors);
  normal_ = py::array_t<double>(vectors), depth_ = py::array_t<double>(n);
  touching_ = py::array_t<bool>(n), object_ = py::array_t<std::int32_t>(n);
  if (tool) torque_ = py::array_t<double>(vectors), torque_at_ = torque_.mutable_data();
  force_at_ = force_.mutable_data(), position_at_ = position_.mutable_data(), normal_at_ = normal_.mutable_data();
  depth_at_ = depth_.mutable_data(), touching_at_ = touching_.mutable_data(), object_at_ = object_.mutable_data();
}

void Felt::keep(std::size_t row, const pliant::Reading& reading) {
  for (int k = 0; k < 3; ++k) {
    force_at_[3 * row + k] = reading.force[k];
    if (torque_at_) torque_at_[3 * row + k] = reading.torque[k];
    position_at_[3 * row + k] = reading.position[k];
    normal_at_[3 * row + k] = reading.normal[k];
  }
  depth_at_[row] = reading.depth;
  touching_at_[row] = reading.touching;
  object_at_[row] = static_cast<std::int32_t>(reading.object);  // kNone: -1
}

py::dict Felt::arrays() const {
  py::dict arrays;
  arrays["force"] = force_;
  arrays["torque"] = torque_at_ ? py::object(torque_) : py::none();
  arrays["position"] = position_;
  arrays["depth"] = depth_;
  arrays["normal"] = normal_;
  arrays["touching"] = touching_;
  arrays["object"] = object_;
  return arrays;
}

void bind_runs(py::module_& module) {
  module.def("_run", &run, py::arg("session"), py::arg("tracks"), py::arg("ticks"));
  module.def("_take", &take, py::arg("session"), py::arg("name"));
  module.def("_batch", &batch, py::arg("sample"), py::arg("scene"), py::arg("paths"), py::arg("settings"),
             py::arg("threads"));
}

}  // namespace pliant_python
