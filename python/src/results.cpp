#include "python/src/results.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/src/failure.h"
#include "python/src/sessions.h"
#include "python/src/values.h"

namespace pliant_python {

std::vector<Contact> contacts_of(pliant::Session& session) {
  const std::vector<std::string> effectors = session.effectors();
  const std::vector<std::string>& objects = session.objects();
  std::vector<Contact> out;
  for (const std::string& name : effectors) {
    const pliant::Reading reading = check(session.reading(name));
    for (std::uint32_t i = 0; i < reading.contacts; ++i) {
      const pliant::ContactReading& c = reading.contact[i];
      out.push_back({name, c.object < objects.size() ? objects[c.object] : "", c.position, c.normal, c.force, c.depth,
                     c.sliding});
    }
  }
  std::vector<pliant::BodyContact> bodies;
  check(session.body_contacts(bodies));
  const auto name_of = [&](const pliant::ContactSide& side) {
    if (side.effector < effectors.size()) return effectors[side.effector];
    return side.object < objects.size() ? objects[side.object] : std::string();
  };
  for (const pliant::BodyContact& c : bodies)
    out.push_back({name_of(c.a), name_of(c.b), c.position, c.normal, c.force, c.depth, c.sliding});
  return out;
}

namespace {

const char* word_of(pliant::FeltKind kind) {
  return kind == pliant::FeltKind::kBroke ? "broke" : kind == pliant::FeltKind::kYielded ? "yielded" : "crossed";
}

void bind_contacts(py::module_& module) {
  py::class_<Contact>(module, "Contact", only_made_here(),
                      "A contact: `force` is on `a`, its reaction on `b`. World frame.")
      .def_readonly("a", &Contact::a, "Name of the probe, tool or body that `force` is on.")
      .def_readonly("b", &Contact::b, "Name of the object that it touches.")
      .def_property_readonly(
          "position", [](const Contact& c) { return array_of(c.position); }, "[m] (3,)")
      .def_property_readonly(
          "normal", [](const Contact& c) { return array_of(c.normal); }, "[1] (3,), towards `a`")
      .def_property_readonly(
          "force", [](const Contact& c) { return array_of(c.force); }, "[N] (3,) on `a`, with friction")
      .def_readonly("depth", &Contact::depth, "[m] of `a` in `b`; below 0: distance")
      .def_readonly("sliding", &Contact::sliding)
      .def("__repr__", [](const Contact& c) {
        return fmt::format("<Contact {} on {}: force {} N, {:.3g} mm deep{}>", c.a, c.b, vector_text(c.force),
                           1e3 * c.depth, c.sliding ? ", sliding" : "");
      });
  py::class_<Hit>(module, "Hit", only_made_here(), "A point of an object's surface. World frame.")
      .def_readonly("object", &Hit::object)
      .def_property_readonly(
          "triangle", [](const Hit& h) { return h.at.triangle; }, "Row of `object`'s triangles.")
      .def_property_readonly(
          "barycentric", [](const Hit& h) { return array_of(h.at.barycentric); }, "[1] (3,)")
      .def_property_readonly(
          "position", [](const Hit& h) { return array_of(h.at.position); }, "[m] (3,)")
      .def_property_readonly(
          "normal", [](const Hit& h) { return array_of(h.at.normal); }, "[1] (3,), outward")
      .def_property_readonly(
          "distance", [](const Hit& h) { return h.at.distance; }, "[m]")
      .def("__repr__", [](const Hit& h) {
        return fmt::format("<Hit {} at {} m, {:.6g} m away>", h.object, vector_text(h.at.position), h.at.distance);
      });
}

}  // namespace

void bind_results(py::module_& module) {
  using pliant::FeltEvent;
  using pliant::Reading;
  bind_contacts(module);
  py::class_<Reading>(module, "Reading", only_made_here(), "What a probe or tool felt in the last tick. World frame.")
      .def_readonly("tick", &Reading::tick)
      .def_readonly("time", &Reading::time, "[s]")
      .def_readonly("ready", &Reading::ready, "False: the state of its device is unknown, and the force is zero.")
      .def_readonly("touching", &Reading::touching)
      .def_property_readonly(
          "position", [](const Reading& r) { return array_of(r.position); }, "[m] (3,)")
      .def_property_readonly(
          "force", [](const Reading& r) { return array_of(r.force); }, "[N] (3,) on the hand, as sent")
      .def_property_readonly(
          "torque", [](const Reading& r) { return array_of(r.torque); }, "[N m] (3,); only of tools")
      .def_readonly("depth", &Reading::depth, "[m] below the undeformed surface, of the strongest contact")
      .def_property_readonly(
          "normal", [](const Reading& r) { return array_of(r.normal); }, "[1] (3,)")
      .def("__repr__", [](const Reading& r) {
        return fmt::format("<Reading at {:.6g} s: force {} N{}>", r.time, vector_text(r.force),
                           r.touching ? fmt::format(", {:.3g} mm deep", 1e3 * r.depth) : ", no contact");
      });
  py::class_<FeltEvent>(module, "Event", only_made_here(),
                        "A layer that broke, tissue that yielded, a detent that was crossed.")
      .def_property_readonly(
          "kind", [](const FeltEvent& e) { return word_of(e.kind); }, "'broke', 'yielded' or 'crossed'")
      .def_readonly("tick", &FeltEvent::tick)
      .def_readonly("time", &FeltEvent::time, "[s]")
      .def_readonly("probe", &FeltEvent::probe)
      .def_readonly("object", &FeltEvent::object)
      .def_readonly("index", &FeltEvent::index, "Of the layer, from 0; of the detent, 0 at its node.")
      .def_readonly("layer", &FeltEvent::layer)
      .def_property_readonly(
          "position", [](const FeltEvent& e) { return array_of(e.position); }, "[m] (3,)")
      .def_readonly("value", &FeltEvent::value, "[N] normal force then; of detents 0")
      .def("__reduce__",
           [](const FeltEvent& e) {
             return py::make_tuple(py::module_::import("pliant._session").attr("event_of"),
                                   py::make_tuple(static_cast<int>(e.kind), e.tick, e.time, e.probe, e.object, e.index,
                                                  e.layer, array_of(e.position), e.value));
           })
      .def("__repr__", [](const FeltEvent& e) { return "<Event " + e.sentence() + ">"; });
  module.def("_event",
             [](int kind, std::uint64_t tick, double time, const std::string& probe, const std::string& object,
                std::int32_t index, const std::string& layer, const py::object& position, double value) {
               if (kind < 0 || kind > 2) wrong_argument("_event", "has no such kind", "");
               return FeltEvent{static_cast<pliant::FeltKind>(kind), tick, time, probe, object, index, layer,
                                to_vec3(position, "position"),       value};
             });
  py::class_<pliant::Note>(module, "Note", only_made_here(), "A deviation from the force law, and its remedy.")
      .def_readonly("what", &pliant::Note::what)
      .def_readonly("cure", &pliant::Note::cure)
      .def_readonly("code", &pliant::Note::code, "docs/codes.md")
      .def_readonly("of", &pliant::Note::of)
      .def("__str__", &pliant::Note::message)
      .def("__repr__", [](const pliant::Note& n) { return "<Note " + n.code + ": " + n.message() + ">"; });
}

}  // namespace pliant_python
