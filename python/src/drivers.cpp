#include "python/src/drivers.h"

#include <pliant/drivers.h>
#include <pybind11/stl.h>

#include <stdexcept>

#include "python/src/values.h"

namespace pliant_python {
namespace {

class PythonDriver final : public pliant::Driver {
 public:
  PythonDriver(const py::object& object, std::shared_ptr<Raised> raised)
      : object_(object.inc_ref().ptr()), raised_(std::move(raised)) {
    const auto number = [&](const char* name) {
      return py::hasattr(object, name) ? object.attr(name).cast<double>() : 0.0;
    };
    const auto flag = [&](const char* name) { return py::hasattr(object, name) && object.attr(name).cast<bool>(); };
    can_.max_force = number("max_force");
    can_.max_stiffness = number("max_stiffness");
    can_.max_torque = number("max_torque");
    can_.senses_rotation = flag("senses_rotation");
    can_.renders_torque = flag("renders_torque");
  }
  ~PythonDriver() override {
    if (!Py_IsInitialized()) return;  // at the program's end
    const py::gil_scoped_acquire gil;
    Py_DECREF(object_);
  }

  pliant::Status open(const std::string& id) override {
    const py::gil_scoped_acquire gil;
    try {
      if (py::hasattr(object(), "open")) object().attr("open")();
      return pliant::Done{};
    } catch (py::error_already_set& raised) {
      raised_->keep(raised);
      return pliant::Error{id, "its open() raised " + words(raised), "", "device.driver"};
    }
  }
  pliant::DeviceCapabilities capabilities() const override { return can_; }

  bool read(pliant::DeviceSample& sample) override {
    return guarded(false, "read", [&] {
      const py::object pose = object().attr("read")();
      if (pose.is_none()) return false;
      const Pose read = to_pose(pose, "read()");
      sample.position = read.position, sample.rotation = read.rotation;
      return true;
    });
  }
  void write(const pliant::DeviceWrench& wrench) override {
    guarded(false, "write", [&] {
      const auto tuple = [](pliant::dvec3 v) { return py::make_tuple(v.x, v.y, v.z); };
      object().attr("write")(tuple(wrench.force), tuple(wrench.torque));
      return true;
    });
  }
  void close() override {
    guarded(false, "close", [&] {
      if (py::hasattr(object(), "close")) object().attr("close")();
      return true;
    });
  }

 private:
  py::object object() const { return py::reinterpret_borrow<py::object>(object_); }
  static std::string words(const py::error_already_set& raised) {
    const std::string text = raised.what();
    return text.substr(0, text.find('\n'));
  }
  // An exception ends the run: the engine writes zero to every device and says so.
  template <class Call>
  bool guarded(bool otherwise, const char* name, const Call& call) {
    if (!Py_IsInitialized()) return otherwise;
    std::string said;
    {
      const py::gil_scoped_acquire gil;
      try {
        return call();
      } catch (py::error_already_set& raised) {
        raised_->keep(raised);
        said = words(raised);
      } catch (const Failure& failure) {
        said = failure.sentence;
      }
    }
    throw std::runtime_error(std::string(name) + "() raised " + said);
  }

  PyObject* object_;
  std::shared_ptr<Raised> raised_;
  pliant::DeviceCapabilities can_;
};

}  // namespace

std::unique_ptr<pliant::Driver> python_driver(const py::object& object, std::shared_ptr<Raised> raised) {
  for (const char* name : {"read", "write"})
    if (!py::hasattr(object, name))
      wrong_argument("driver", std::string("has no method `") + name + "`",
                     "it needs read(), which returns a pose or None, and write(force, torque)");
  return std::make_unique<PythonDriver>(object, std::move(raised));
}

void bind_drivers(py::module_& module) {
  using pliant::DeviceInfo;
  py::class_<DeviceInfo>(module, "DeviceInfo", only_made_here(),
                         "A device that is there, or would be if `missing` were cured.")
      .def_property_readonly(
          "id", [](const DeviceInfo& d) { return d.id.empty() ? d.driver : d.driver + ":" + d.id; },
          "For Session.connect.")
      .def_readonly("driver", &DeviceInfo::driver)
      .def_readonly("name", &DeviceInfo::name)
      .def_readonly("missing", &DeviceInfo::missing, "Why it cannot be opened now, and the cure; empty: it can.")
      .def("__repr__", [](const DeviceInfo& d) {
        return "<DeviceInfo " + d.driver + (d.id.empty() ? "" : ":" + d.id) + " '" + d.name + "'" +
               (d.missing.empty() ? "" : ": " + d.missing) + ">";
      });
  module.def(
      "devices",
      [] {
        pliant::register_all_drivers();
        const py::gil_scoped_release without_gil;
        return pliant::list_devices();
      },
      "The devices that are there: a list of DeviceInfo.");
  module.def(
      "driver_names",
      [] {
        pliant::register_all_drivers();
        return pliant::driver_names();
      },
      "The names of the drivers, for Session.connect('NAME:ID').");
}

}  // namespace pliant_python
