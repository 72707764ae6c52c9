#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "python/src/results.h"
#include "python/src/sessions.h"
#include "python/src/values.h"

namespace pliant_python {
namespace {

using pliant::dvec3;
using pliant::Session;
using Class = SessionClass;

void set(HeldSession& held, const std::string& name, const std::string& key, const py::object& value) {
  const std::string what = "`" + name + "`: " + key;
  const bool flag = py::isinstance<py::bool_>(value);
  if (flag || py::isinstance<py::str>(value)) {
    const auto word = flag ? std::string(value.cast<bool>() ? "true" : "false") : value.cast<std::string>();
    held.advance([&](Session& session) { check(session.set(name, key, word)); });
    return;
  }
  const Doubles array = doubles(value, what);
  if (array.ndim() == 0) {
    const double number = *array.data();
    held.advance([&](Session& session) { check(session.set(name, key, number)); });
    return;
  }
  const std::vector<double> several = numbers(value, what);
  held.advance([&](Session& session) { check(session.set(name, key, several)); });
}

const char* kind_word(pliant::NamedKind kind) {
  constexpr const char* kWords[] = {"surface", "soft_body", "rigid_body", "tool", "probe", "effect"};
  return kWords[static_cast<std::size_t>(kind)];
}

py::array_t<std::uint8_t> render(HeldSession& held, int width, int height, const py::object& eye,
                                 const py::object& target, const py::object& up, const py::object& yfov) {
  std::optional<pliant::PictureView> view;
  if (!eye.is_none() || !target.is_none() || !up.is_none() || !yfov.is_none()) {
    view = held.view();
    if (!eye.is_none()) view->eye = to_vec3(eye, "eye");
    if (!target.is_none()) view->target = to_vec3(target, "target");
    if (!up.is_none()) view->up = to_vec3(up, "up");
    if (!yfov.is_none()) view->yfov = yfov.cast<float>();
  }
  const pliant::Picture picture = held.picture(view, width, height);
  py::array_t<std::uint8_t> out({picture.height, picture.width, 4});
  std::copy(picture.rgba.begin(), picture.rgba.begin() + out.size(), out.mutable_data());
  return out;
}

pliant::QueryOptions options_of(const std::optional<std::string>& object, bool rest, double within) {
  pliant::QueryOptions options;
  if (object) options.object = *object;
  options.rest = rest, options.within = within;
  return options;
}

std::optional<Hit> hit_of(const Session& session, const pliant::QueryHit& hit) {
  if (!hit.found()) return std::nullopt;
  return Hit{session.objects()[hit.object], hit};
}

}  // namespace

void bind_state(Class& c) {
  c.def("set", &set, py::arg("name"), py::arg("key"), py::arg("value"),
        "Sets a parameter before the next tick, by the level format's names: a number, a word, a flag, or a list.")
      .def(
          "get",
          [](HeldSession& h, const std::string& name, const std::string& key) -> py::object {
            const std::string text = h.with([&](Session& s) { return check(s.json(name, key)); });
            py::object value = py::module_::import("json").attr("loads")(text);
            const bool whole = py::isinstance<py::int_>(value) && !py::isinstance<py::bool_>(value);
            return whole ? py::object(py::float_(value)) : value;
          },
          py::arg("name"), py::arg("key"), "The value of a parameter: a number, a word, or a list.")
      .def(
          "keys",
          [](HeldSession& h, const std::string& name) {
            return h.with([&](Session& s) { return check(s.keys(name)).live; });
          },
          py::arg("name"), "The parameters of an object, probe, tool or effect that set() changes.")
      .def_property_readonly(
          "sliders",
          [](HeldSession& h) {
            py::list out;
            for (const pliant::Slider& s : h.with([](Session& session) { return session.sliders(); }))
              out.append(py::dict(py::arg("object") = s.object, py::arg("key") = s.key, py::arg("name") = s.name,
                                  py::arg("unit") = s.unit, py::arg("low") = s.low, py::arg("high") = s.high,
                                  py::arg("step") = s.step));
            return out;
          },
          "Sliders that the level offers (its key `expose`): arguments of set(), a label, bounds, a step.")
      .def(
          "save",
          [](HeldSession& h) {
            const auto state = h.with([](Session& s) { return check(s.save_state()); });
            return py::bytes(reinterpret_cast<const char*>(state.data()), state.size());
          },
          "The state of a lockstep run as bytes, for restore() here or in any session of the same scene.")
      .def(
          "restore",
          [](HeldSession& h, const py::bytes& state) {
            const std::string_view bytes = state;
            const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
            h.advance([&](Session& s) {
              h.forget_pictures();
              check(s.restore_state(copy));
            });
          },
          py::arg("state"), "Back to a state, bit for bit; it runs the ticks up to it again.")
      .def(
          "set_hand_force",
          [](HeldSession& h, const std::string& name, const py::object& force, const py::object& torque) {
            const dvec3 f = to_vec3(force, "force"), t = to_vec3(torque, "torque");
            h.with([&](Session& s) { check(s.set_hand_force(name, f, t)); });
          },
          py::arg("name"), py::arg("force"), py::arg("torque") = py::make_tuple(0.0, 0.0, 0.0),
          "A force [N] (and torque [N m], of a tool) on the hand besides contact, until changed.")
      .def(
          "set_body_force",
          [](HeldSession& h, const std::string& name, const py::object& force, const py::object& torque) {
            const dvec3 f = to_vec3(force, "force"), t = to_vec3(torque, "torque");
            h.with([&](Session& s) { check(s.set_body_force(name, f, t)); });
          },
          py::arg("name"), py::arg("force"), py::arg("torque") = py::make_tuple(0.0, 0.0, 0.0),
          "A force [N] and torque [N m] at a body's centre of mass, until changed.")
      .def(
          "set_point_force",
          [](HeldSession& h, const std::string& name, std::uint32_t vertex, const py::object& force) {
            const dvec3 f = to_vec3(force, "force");
            h.with([&](Session& s) { check(s.set_point_force(name, vertex, f)); });
          },
          py::arg("name"), py::arg("vertex"), py::arg("force"), "A force [N] on a vertex of a body, until changed.")
      .def(
          "push",
          [](HeldSession& h, const std::string& name, const py::object& impulse) {
            const dvec3 p = to_vec3(impulse, "impulse");
            h.with([&](Session& s) { check(s.push(name, p)); });
          },
          py::arg("name"), py::arg("impulse"), "An impulse [N s] at a body's centre of mass.")
      .def(
          "place",
          [](HeldSession& h, const std::string& name, const py::object& position, const py::object& rotation) {
            const dvec3 at = to_vec3(position, "position");
            const pliant::dquat turned = to_quat(rotation, "rotation");
            h.advance([&](Session& s) { check(s.place(name, at, turned)); });
          },
          py::arg("name"), py::arg("position"), py::arg("rotation") = py::make_tuple(1.0, 0.0, 0.0, 0.0),
          "Moves an object's frame [m], at rest.")
      .def(
          "take_out",
          [](HeldSession& h, const std::string& n) { h.advance([&](Session& s) { check(s.take_out(n)); }); },
          py::arg("name"), "Takes an object out of the simulation.")
      .def(
          "put_back",
          [](HeldSession& h, const std::string& n) { h.advance([&](Session& s) { check(s.put_back(n)); }); },
          py::arg("name"));
}

void bind_queries(Class& c) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  c.def("_kinds",
        [](HeldSession& h) {
          std::vector<std::pair<std::string, std::string>> names;
          for (const std::string& name : h.objects()) names.emplace_back(name, kind_word(h.kind(name)));
          return names;
        })
      .def_property_readonly("effectors", &HeldSession::effectors, "Names of the probes, then of the tools.")
      .def_property_readonly("objects", &HeldSession::objects, "Names of the surfaces and bodies.")
      .def_readonly("_probe_added", &HeldSession::probe_added)
      .def("_notes", [](HeldSession& h) { return h.with([](Session& s) { return s.notes(); }); })
      .def(
          "findings", [](HeldSession& h) { return h.with([](Session& s) { return check(s.findings()); }); },
          "The deviations from the force law so far (clipped, withheld, dropped...), each a Note with its code.")
      .def("_events",
           [](HeldSession& h) {
             return h.with([](Session& s) {
               std::vector<pliant::FeltEvent> events;
               const std::uint64_t lost = s.take_events(events);
               return std::pair(std::move(events), lost);
             });
           })
      .def("_contacts", [](HeldSession& h) { return h.look(&contacts_of); })
      .def("_vertices", &HeldSession::vertices)
      .def("_vertex_forces",
           [](HeldSession& h, const std::string& name) {
             return rows_of<float, 3>(h.look([&](Session& s) {
               std::vector<pliant::vec3> out;
               check(s.vertex_forces(name, out));
               return out;
             }));
           })
      .def("_triangles",
           [](HeldSession& h, const std::string& name) {
             return triangles_of(h.look([&](Session& s) {
               std::vector<std::uint32_t> out;
               check(s.triangles(name, out));
               return out;
             }));
           })
      .def("_to_world",
           [](HeldSession& h, const std::string& name) {
             return array_of(h.look([&](Session& s) { return check(s.to_world(name)); }));
           })
      .def(
          "closest_point",
          [](HeldSession& h, const py::object& point, const std::optional<std::string>& object, bool rest,
             double within) {
            const dvec3 at = to_vec3(point, "point");
            return h.look(
                [&](Session& s) { return hit_of(s, check(s.closest_point(at, options_of(object, rest, within)))); });
          },
          py::arg("point"), py::arg("object") = py::none(), py::arg("rest") = false, py::arg("within") = kFar,
          "The nearest point of the surfaces (or of one object) as a Hit; None: nothing within that distance [m].")
      .def(
          "ray",
          [](HeldSession& h, const py::object& from, const py::object& along, const std::optional<std::string>& object,
             bool rest, double within) {
            const dvec3 at = to_vec3(from, "origin"), to = to_vec3(along, "direction");
            return h.look(
                [&](Session& s) { return hit_of(s, check(s.ray(at, to, options_of(object, rest, within)))); });
          },
          py::arg("origin"), py::arg("direction"), py::arg("object") = py::none(), py::arg("rest") = false,
          py::arg("within") = kFar, "The first intersection of a ray as a Hit, or None.")
      .def("_bounds",
           [](HeldSession& h, const std::optional<std::string>& object, bool rest) {
             const auto box = h.look([&](Session& s) {
               return check(s.bounds(options_of(object, rest, std::numeric_limits<double>::infinity())));
             });
             return py::make_tuple(array_of(box.min), array_of(box.max));
           })
      .def("_figures",
           [](HeldSession& h) {
             const auto f = h.with([](Session& s) { return s.figures(); });
             py::dict out;
             out["ticks"] = f.ticks, out["p50_us"] = f.p50_us, out["p99_us"] = f.p99_us, out["max_us"] = f.max_us;
             out["overruns"] = f.overruns, out["soft_steps"] = f.soft_steps;
             return out;
           })
      .def("render", &render, py::arg("width") = 640, py::arg("height") = 480, py::arg("eye") = py::none(),
           py::arg("target") = py::none(), py::arg("up") = py::none(), py::arg("yfov") = py::none(),
           "A picture without a display: uint8 (height, width, 4), sRGB with alpha, rows from the top.\n\n"
           "eye, target: of the camera [m]; up; yfov: vertical field of view [rad]. Default: the level's camera.");
}

}  // namespace pliant_python
