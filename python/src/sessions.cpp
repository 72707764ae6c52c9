#include "python/src/sessions.h"

#include <fmt/format.h>
#include <pliant/drivers.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "python/src/drivers.h"
#include "python/src/held_session.h"
#include "python/src/results.h"
#include "python/src/scenes.h"
#include "python/src/values.h"

namespace pliant_python {
namespace {

using pliant::dvec3;
using pliant::Session;
using Class = SessionClass;

py::tuple tuple_of(dvec3 v) {
  return py::make_tuple(v.x, v.y, v.z);
}

// One tick of the only probe or tool at a pose.
template <class Result>
Result tick_at(HeldSession& held, const char* call, const Pose& pose, Result (*result)(const pliant::Reading&)) {
  const std::string& name = held.only_effector(call);
  return result(held.advance([&](Session& session) {
    check(session.move(name, pose.position, pose.rotation));
    check(session.step());
    return check(session.reading(name));
  }));
}

py::tuple tick(HeldSession& held, double x, double y, double z) {
  return tick_at<py::tuple>(held, "tick", {{x, y, z}, {1, 0, 0, 0}},
                            [](const pliant::Reading& felt) { return tuple_of(felt.force); });
}

py::tuple tick_pose(HeldSession& held, double x, double y, double z, double qw, double qx, double qy, double qz) {
  return tick_at<py::tuple>(held, "tick", {{x, y, z}, {qw, qx, qy, qz}}, [](const pliant::Reading& felt) {
    return py::make_tuple(felt.force.x, felt.force.y, felt.force.z, felt.torque.x, felt.torque.y, felt.torque.z);
  });
}

// For arguments that the other overloads do not take as they are: whole numbers, an array. Others are refused.
py::tuple tick_any(HeldSession& held, const py::args& given) {
  double v[7] = {0, 0, 0, 1, 0, 0, 0};
  bool sound = given.size() == 3 || given.size() == 7;
  for (std::size_t i = 0; sound && i < given.size(); ++i) {
    v[i] = PyFloat_AsDouble(given[i].ptr());
    if (v[i] == -1.0 && PyErr_Occurred()) PyErr_Clear(), sound = false;
  }
  std::size_t count = given.size();
  if (count == 1 && !py::isinstance<py::str>(given[0]) && py::hasattr(given[0], "__len__")) {
    const Pose pose = to_pose(given[0], "tick");
    for (int k = 0; k < 3; ++k) v[k] = pose.position[k];
    v[3] = pose.rotation.w, v[4] = pose.rotation.x, v[5] = pose.rotation.y, v[6] = pose.rotation.z;
    count = py::len(given[0]);
    sound = true;
  }
  if (sound && count == 3) return tick(held, v[0], v[1], v[2]);
  if (sound) return tick_pose(held, v[0], v[1], v[2], v[3], v[4], v[5], v[6]);
  std::string types;
  for (const py::handle& each : given)
    types += (types.empty() ? "" : ", ") + std::string(py::str(py::type::handle_of(each).attr("__name__")));
  wrong_argument("tick", "takes (x, y, z), (x, y, z, qw, qx, qy, qz) or {name: pose}; got (" + types + ")", "");
}

// Several: {name: pose} -> {name: force}; of a tool force and torque.
py::dict tick_all(HeldSession& held, const py::dict& poses) {
  std::vector<std::pair<std::string, Pose>> wanted;
  for (const auto& [name, pose] : poses) {
    const std::string key = py::str(name);
    wanted.emplace_back(key, to_pose(pose, "tick `" + key + "`"));
  }
  const auto felt = held.advance([&](Session& session) {
    for (const auto& [name, pose] : wanted) {  // a refused call moves none of them
      check(session.reading(name));
      if (!is_sound(pose)) check(session.move(name, pose.position, pose.rotation));
    }
    for (const auto& [name, pose] : wanted) check(session.move(name, pose.position, pose.rotation));
    check(session.step());
    std::vector<pliant::Reading> readings;
    for (const auto& [name, pose] : wanted) readings.push_back(check(session.reading(name)));
    return readings;
  });
  py::dict out;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string& name = wanted[i].first;
    const dvec3 f = felt[i].force, t = felt[i].torque;
    out[py::str(name)] = held.is_tool(name) ? py::make_tuple(f.x, f.y, f.z, t.x, t.y, t.z) : tuple_of(f);
  }
  return out;
}

void step(HeldSession& held, std::int64_t ticks) {
  if (ticks < 0) wrong_argument("ticks", "must be 0 or more; got " + std::to_string(ticks), "");
  const bool done = held.advance([&](Session& session) {
    auto looked = std::chrono::steady_clock::now();
    for (std::int64_t i = 0; i < ticks; ++i) {
      check(session.step());
      const auto now = std::chrono::steady_clock::now();
      if (now - looked < std::chrono::milliseconds(50)) continue;
      looked = now;
      check_end();
      held.show_in_long_call();
      if (interrupted()) return false;
    }
    return true;
  });
  if (!done) throw py::error_already_set();
}

void follow(HeldSession& held, const std::string& name, const py::object& times, const py::object& poses,
            bool repeats) {
  const std::vector<double> at = numbers(times, "times");
  const Doubles rows = doubles(poses, "poses");
  if (rows.ndim() != 2 || (rows.shape(1) != 3 && rows.shape(1) != 7) ||
      rows.shape(0) != static_cast<py::ssize_t>(at.size()))
    wrong_argument("poses", "must have a row for each time, of 3 or 7 numbers",
                   "its shape is " + std::string(py::str(rows.attr("shape"))));
  pliant::Path path;
  path.turns = rows.shape(1) == 7, path.repeats = repeats;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double* p = rows.data() + i * static_cast<std::size_t>(rows.shape(1));
    pliant::PathRow row{at[i], {p[0], p[1], p[2]}, {1, 0, 0, 0}};
    if (path.turns) row.rotation = {p[3], p[4], p[5], p[6]};
    path.rows.push_back(row);
  }
  held.advance([&](Session& session) { check(session.follow(name, std::move(path))); });
}

void bind_time(Class& c) {
  c.def("tick", &tick, py::arg("x"), py::arg("y"), py::arg("z"),
        "tick(x, y, z) -> (fx, fy, fz): moves the only probe there [m], runs one tick, returns the force on it [N].\n"
        "tick(x, y, z, qw, qx, qy, qz) -> (fx, fy, fz, tx, ty, tz): of a tool, with the torque [N m].\n"
        "tick({name: pose, ...}) -> {name: force, ...}: of several probes and tools. World frame.\n"
        "A probe is felt once it comes from outside: one whose first pose is below a surface feels nothing of it.")
      .def("tick", &tick_pose, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("qw"), py::arg("qx"), py::arg("qy"),
           py::arg("qz"))
      .def("tick", &tick_all, py::arg("poses"))
      .def("tick", &tick_any)
      .def("step", &step, py::arg("ticks") = 1, "Runs ticks with the poses and forces as they are.")
      .def(
          "start", [](HeldSession& h) { h.advance([](Session& s) { check(s.start()); }); },
          "Real time: the touch clock (1 kHz) and the soft clock run on threads of their own until stop().")
      .def(
          "pause", [](HeldSession& h, bool paused) { h.with([&](Session& s) { check(s.pause(paused)); }); },
          py::arg("paused") = true)
      .def(
          "stop", [](HeldSession& h) { h.advance([](Session& s) { check(s.stop()); }); },
          "Ends real time; raises what ended a clock before.")
      .def(
          "restart",
          [](HeldSession& h) {
            h.advance([&](Session& s) {
              h.forget_pictures();
              check(s.restart());
            });
          },
          "Back to the initial state at time 0; keeps parameters, forces and sources.")
      .def("close", &HeldSession::close, "Ends it; later calls raise. Views keep their last values.")
      .def_property_readonly("closed", &HeldSession::closed)
      .def_property_readonly(
          "running", [](HeldSession& h) { return h.with([](Session& s) { return s.running(); }); },
          "True while the clocks run in real time.")
      .def_property_readonly(
          "time", [](HeldSession& h) { return h.with([](Session& s) { return s.time(); }); }, "[s]");
}

py::dict device_state(HeldSession& held, const std::string& name) {
  const pliant::DeviceReport report = held.with([&](Session& s) { return check(s.device_state(name)); });
  py::dict out;
  out["state"] = pliant::name_of(report.state), out["cause"] = pliant::describe(report.cause);
  out["force"] = report.force, out["max_force"] = report.max_force;
  out["position"] = array_of(report.sample.position), out["rotation"] = array_of(report.sample.rotation);
  out["buttons"] = report.sample.buttons, out["grip"] = report.sample.grip;
  out["battery"] = report.sample.battery, out["age"] = report.sample_age;
  return out;
}

void guard(HeldSession& held, const std::string& name, bool by_hand, double max_force, std::uint32_t dead_man,
           double ramp) {
  const pliant::GuardParameters parameters{.arming = by_hand ? pliant::Arming::kByHand : pliant::Arming::kAutomatic,
                                           .dead_man = dead_man,
                                           .max_force = max_force,
                                           .ramp = ramp};
  held.with([&](Session& s) { check(s.guard(name, parameters)); });
}

void bind_sources(Class& c) {
  c.def(
       "move",
       [](HeldSession& h, const std::string& name, const py::object& position, const py::object& rotation) {
         const dvec3 at = to_vec3(position, "position");
         const pliant::dquat turned = to_quat(rotation, "rotation");
         h.with([&](Session& s) { check(s.move(name, at, turned)); });
       },
       py::arg("name"), py::arg("position"), py::arg("rotation") = py::make_tuple(1.0, 0.0, 0.0, 0.0),
       "Sets the pose of a probe or tool: position (3,) [m], rotation (w, x, y, z). World frame.")
      .def("follow", &follow, py::arg("name"), py::arg("times"), py::arg("poses"), py::arg("repeats") = false,
           "Moves a probe or tool along poses (n, 3) or (n, 7) [m] at times (n,) [s], linear between them.")
      .def(
          "orbit",
          [](HeldSession& h, const std::string& name) { h.advance([&](Session& s) { check(s.orbit(name)); }); },
          py::arg("name"), "Moves a probe along a built-in path over the scene's surfaces.")
      .def(
          "release",
          [](HeldSession& h, const std::string& name) { h.advance([&](Session& s) { check(s.release(name)); }); },
          py::arg("name"), "Removes the source of a probe or tool: no force until it has another.")
      .def(
          "connect",
          [](HeldSession& h, const std::string& name, const py::object& driver) {
            if (py::isinstance<py::str>(driver)) {
              const auto id = driver.cast<std::string>();
              pliant::register_all_drivers();
              h.advance([&](Session& s) { check(s.connect(name, id)); });
              return;
            }
            auto made = python_driver(driver, h.raised());
            h.advance([&](Session& s) { check(s.connect(name, std::move(made), "python")); });
          },
          py::arg("name"), py::arg("driver"),
          "Connects a probe or tool to a device: its id ('simulated:touch', see devices()), or an object of your own\n"
          "with read() -> (x, y, z), (x, y, z, qw, qx, qy, qz) or None, and write(force, torque) [N], [N m].\n"
          "A driver in Python is a slow path: each call takes Python's global lock. One that raises ends the run: its\n"
          "device is written zero force, and step(), run() or stop() raise pliant.Error.")
      .def(
          "arm", [](HeldSession& h, const std::string& name) { h.with([&](Session& s) { check(s.arm(name)); }); },
          py::arg("name"))
      .def(
          "disarm", [](HeldSession& h, const std::string& name) { h.with([&](Session& s) { check(s.disarm(name)); }); },
          py::arg("name"))
      .def(
          "emergency_stop", [](HeldSession& h) { h.with([](Session& s) { s.emergency_stop(); }); },
          "Disarms every device.")
      .def("device_state", &device_state, py::arg("name"),
           "The device of a probe or tool: state, cause, force written last [N], max_force [N], and of its newest "
           "sample\n"
           "position [m], rotation, buttons (a bit each), grip [0 to 1], battery, age [s].")
      .def("guard", &guard, py::arg("name"), py::arg("by_hand") = false, py::arg("max_force") = 0.0,
           py::arg("dead_man") = 0, py::arg("ramp") = 0.2,
           "Safety of the next device that is connected there: armed by arm() alone, at most max_force [N] (0: its "
           "own),\n"
           "force only while one of these buttons is pressed, fade-in over ramp [s] (docs/devices/safety.md).")
      .def(
          "keep_readings",
          [](HeldSession& h, std::size_t ticks) { h.with([&](Session& s) { check(s.keep_readings(ticks)); }); },
          py::arg("ticks"), "Keeps the last `ticks` readings of each probe and tool for readings(), also in real time.")
      .def("_reading",
           [](HeldSession& h, const std::string& name) {
             return h.with([&](Session& s) { return check(s.reading(name)); });
           })
      .def(
          "record",
          [](HeldSession& h, const std::filesystem::path& file, bool replace) {
            h.with([&](Session& s) { check(s.record(file, replace)); });
          },
          py::arg("file"), py::arg("replace") = false, "Records every pose of every tick, until end_recording().")
      .def("end_recording", [](HeldSession& h) { h.with([](Session& s) { check(s.end_recording()); }); })
      .def(
          "replay",
          [](HeldSession& h, const std::filesystem::path& file) {
            h.advance([&](Session& s) { check(s.replay(file)); });
          },
          py::arg("file"), "Makes a recording the source of every probe and tool.");
}

}  // namespace

void bind_sessions(py::module_& module) {
  Class session(module, "Session", "A running scene.");
  // `probe`: the radius [m] of a probe that is added to a scene without probes and tools.
  session.def(py::init([](HeldScene& scene, std::optional<double> probe) {
                auto held = HeldSession::open(scene);
                if (!probe || !held->effectors().empty()) return held;
                scene.add_probe("probe", {.radius = *probe});
                held = HeldSession::open(scene);
                held->probe_added = true;
                return held;
              }),
              py::arg("scene"), py::arg("probe") = py::none());
  bind_time(session);
  bind_sources(session);
  bind_state(session);
  bind_queries(session);
  bind_window(session);
}

}  // namespace pliant_python
