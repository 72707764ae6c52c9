#include "python/src/scenes.h"

#include <pliant/content.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "python/src/failure.h"
#include "python/src/held_session.h"
#include "python/src/values.h"

namespace pliant_python {
namespace {

std::vector<float> floats(const py::handle& value, std::size_t count, const std::string& what) {
  const Doubles array = doubles(value, what);
  if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != count)
    wrong_argument(what, "must be one number for each of the " + std::to_string(count) + " vertices", "");
  return {array.data(), array.data() + array.size()};
}

const Doubles rows(const py::handle& value, py::ssize_t columns, const std::string& what) {
  const Doubles array = doubles(value, what);
  if (array.ndim() != 2 || array.shape(1) != columns)
    wrong_argument(what, "must be an array of shape (n, " + std::to_string(columns) + ")",
                   "its shape is " + std::string(py::str(array.attr("shape"))));
  return array;
}

pliant::MeshData mesh_of(const py::handle& vertices, const py::handle& triangles, const py::dict& paint) {
  pliant::MeshData mesh;
  const Doubles at = rows(vertices, 3, "vertices");
  const auto count = static_cast<std::size_t>(at.shape(0));
  for (std::size_t i = 0; i < count; ++i) {
    const double* v = at.data() + 3 * i;
    mesh.position.emplace_back(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  }
  const Doubles corners = rows(triangles, 3, "triangles");
  for (py::ssize_t i = 0; i < corners.size(); ++i) {
    const double corner = corners.data()[i];
    if (!(corner >= 0.0 && corner < static_cast<double>(count)) ||
        corner != static_cast<double>(static_cast<std::uint32_t>(corner)))
      wrong_argument("triangles",
                     "holds " + number_text(corner) + ", and there are " + std::to_string(count) + " vertices",
                     "give indices from 0 on");
    mesh.index.push_back(static_cast<std::uint32_t>(corner));
  }
  const std::pair<const char*, std::vector<float>*> layers[] = {
      {"stiffness", &mesh.stiffness},   {"friction", &mesh.friction}, {"damping", &mesh.damping},
      {"relaxation", &mesh.relaxation}, {"pinned", &mesh.pinned},     {"handle", &mesh.handle}};
  for (const auto& [key, value] : paint) {
    const std::string name = py::str(key);
    std::vector<float>* to = nullptr;
    for (const auto& [layer, vector] : layers)
      if (name == layer) to = vector;
    if (!to)
      throw Failure(pliant::Error{"paint", "has no layer '" + name + "'",
                                  "layers are: stiffness, friction, damping, relaxation, pinned, handle",
                                  "name.unknown"});
    *to = floats(value, count, "paint['" + name + "']");
  }
  return mesh;
}

using Keys = std::vector<std::pair<std::string, std::string>>;  // key, value as text

// Each key goes into the first of the extensions that has it. One key may need another first (two that bound each
// other): they are tried until none is left, or none can be set any more.
void set_keys(pliant::Scene& scene, const std::string& name, const std::vector<std::string>& extensions, Keys keys) {
  std::optional<pliant::Error> refused;
  for (std::size_t before = keys.size() + 1; keys.size() < before;) {
    before = keys.size();
    Keys left;
    refused.reset();
    for (const auto& [key, value] : keys) {
      std::optional<pliant::Error> first;
      bool done = false;
      for (const std::string& extension : extensions) {
        const pliant::Status set = pliant::set_key(scene, name + "." + extension + "." + key + "=" + value);
        if ((done = set.ok())) break;
        if (!first || (first->code == "name.unknown" && set.error().code != "name.unknown")) first = set.error();
      }
      if (done) continue;
      left.emplace_back(key, value);
      if (!refused) refused = first->at("`" + name + "`: " + key);
    }
    keys = std::move(left);
  }
  if (refused) throw Failure(*refused);
}

pliant::Placement placement_of(const py::object& position, const py::object& rotation, const py::object& scale) {
  return {to_vec3(position, "position"), to_quat(rotation, "rotation"), to_vec3(scale, "scale")};
}

// All or nothing: on an error the scene is as before.
template <class Add>
void add(pliant::Scene& scene, const std::string& name, const std::vector<std::string>& extensions, const Keys& keys,
         const Add& how) {
  pliant::Scene changed = scene;
  how(changed);
  set_keys(changed, name, extensions, keys);
  scene = std::move(changed);
}

py::tuple load(const std::filesystem::path& file, double max_force) {
  std::vector<std::string> notes;
  bool stopped = false;
  std::optional<pliant::Scene> scene;
  {
    const py::gil_scoped_release without_gil;
    auto loaded = pliant::load_scene(file, &notes, {.max_force = max_force}, [&](double, const std::string&) {
      stopped = stopped || interrupted();
      return !stopped;
    });
    if (!loaded && !stopped) throw Failure(loaded.error());
    if (loaded) scene.emplace(std::move(loaded).value());
  }
  if (stopped) throw py::error_already_set();
  for (std::string& note : notes) note = pliant::printable(note);
  return py::make_tuple(std::make_shared<HeldScene>(std::move(*scene)), notes);
}

}  // namespace

void bind_scenes(py::module_& module) {
  using Scene = HeldScene;
  py::class_<Scene, std::shared_ptr<Scene>>(module, "Scene", "The objects, probes and parameters of a session.")
      .def(py::init([](const std::string& name) { return std::make_shared<Scene>(name); }), py::arg("name"))
      .def_static("_load", &load, py::arg("file"), py::arg("max_force"))
      .def("_assign", [](Scene& scene, const Scene& other) { scene = other; })
      .def("_copy", [](const Scene& scene) { return std::make_shared<Scene>(scene); })
      .def("_simulation",
           [](Scene& scene, const py::object& touch_rate, const py::object& soft_step, const py::object& gravity) {
             if (!touch_rate.is_none()) scene.simulation().touch_rate = touch_rate.cast<double>();
             if (!soft_step.is_none()) scene.simulation().soft_step = soft_step.cast<double>();
             if (!gravity.is_none()) scene.simulation().gravity = to_vec3(gravity, "gravity");
           })
      .def("_set", [](Scene& scene, const std::string& assignment) { check(pliant::set_key(scene, assignment)); })
      .def("_save",
           [](const Scene& scene, const std::filesystem::path& file) {
             const py::gil_scoped_release without_gil;
             check(pliant::save_scene(scene, file));
           })
      .def("_add_mesh",
           [](Scene& scene, const std::string& kind, const std::string& name, const py::object& vertices,
              const py::object& triangles, const py::dict& paint, const Keys& keys, const py::object& position,
              const py::object& rotation, const py::object& scale) {
             const pliant::MeshData mesh = mesh_of(vertices, triangles, paint);
             const pliant::Placement at = placement_of(position, rotation, scale);
             const std::string extension = kind == "surface" ? "deformable" : kind;
             add(scene, name, {extension}, keys, [&](pliant::Scene& to) {
               if (kind == "surface") to.add_surface(name, mesh, {}, at);
               if (kind == "soft_body") to.add_soft_body(name, mesh, {}, at);
               if (kind == "rigid_body") to.add_rigid_body(name, mesh, {}, at);
             });
           })
      .def("_add_probe",
           [](Scene& scene, const std::string& name, const Keys& keys, const py::object& position,
              const py::object& rotation) {
             const pliant::Placement at{to_vec3(position, "position"), to_quat(rotation, "rotation"), pliant::dvec3(1)};
             add(scene, name, {"probe", "haptic_device"}, keys,
                 [&](pliant::Scene& to) { to.add_probe(name, {}, {}, at); });
           })
      .def(
          "_add_handle",
          [](Scene& scene, const std::string& body, const Keys& keys) {
            add(scene, body, {"handle", "haptic_device"}, keys, [&](pliant::Scene& to) { check(to.add_handle(body)); });
          })
      .def("_add_effect",
           [](Scene& scene, const std::string& name, const Keys& keys, const py::object& position,
              const py::object& rotation) {
             const pliant::Placement at{to_vec3(position, "position"), to_quat(rotation, "rotation"), pliant::dvec3(1)};
             add(scene, name, {"effect"}, keys, [&](pliant::Scene& to) { to.add_effect(name, {}, at); });
           })
      .def("_add_joint", [](Scene& scene, const std::string& name, const std::string& a, const std::string& b,
                            const Keys& keys, const py::object& position, const py::object& rotation) {
        const pliant::Placement at{to_vec3(position, "position"), to_quat(rotation, "rotation"), pliant::dvec3(1)};
        pliant::JointParameters joint;
        joint.a = a, joint.b = b;
        add(scene, name, {"joint"}, keys, [&](pliant::Scene& to) { to.add_joint(name, joint, at); });
      });
}

}  // namespace pliant_python
