#include "python/src/laws.h"

#include <pliant/surface_law.h>

#include <atomic>
#include <limits>
#include <memory>
#include <utility>

#include "python/src/failure.h"

namespace pliant_python {
namespace {

std::atomic<bool> g_failed{false};
const std::shared_ptr<Raised>& law_raised() {
  static const auto* const raised = new std::shared_ptr<Raised>(std::make_shared<Raised>());
  return *raised;
}

// Registered until the program ends: the Python object is never released.
class PythonSpring final : public pliant::SpringFunction {
 public:
  explicit PythonSpring(const py::object& law)
      : force_(py::object(law.attr("force")).release().ptr()),
        potential_(py::object(law.attr("potential")).release().ptr()),
        slope_(py::object(law.attr("slope")).release().ptr()) {}
  double force(double h, const pliant::SpringConstants&) const override { return call(force_, h); }
  double potential(double h, const pliant::SpringConstants&) const override { return call(potential_, h); }
  double slope(double h, const pliant::SpringConstants&) const override { return call(slope_, h); }

 private:
  // A law must not throw into a tick: not a number until the call of the session is over, which then raises.
  static double call(PyObject* function, double h) {
    if (g_failed || !Py_IsInitialized()) return 0.0;
    const py::gil_scoped_acquire gil;
    try {
      return py::reinterpret_borrow<py::object>(function)(h).cast<double>();
    } catch (py::error_already_set& raised) {
      law_raised()->keep(raised);
    } catch (const py::cast_error&) {  // not a number
    }
    g_failed = true;
    return 0.0;
  }
  PyObject *force_, *potential_, *slope_;
};

void register_spring(const std::string& name, const py::object& law) {
  for (const char* part : {"force", "potential", "slope"})
    if (!py::hasattr(law, part))
      wrong_argument("register_spring `" + name + "`", std::string("the law has no method `") + part + "`",
                     "it needs force(h), its integral potential(h) and its derivative slope(h)");
  auto registered = pliant::register_spring(name, std::make_shared<PythonSpring>(law));
  check_laws();
  check(std::move(registered));
}

}  // namespace

void check_laws() {
  if (!g_failed.exchange(false)) return;
  throw Failure(pliant::Error{"a spring law written in Python", "raised an exception, or returned what is not a number",
                              "its forces since then are wrong: restart() the session", "law.raised"},
                law_raised());
}

void bind_laws(py::module_& module) {
  module.def(
      "register_spring", &register_spring, py::arg("name"), py::arg("law"),
      "Registers a spring law for surfaces under `name`, for `add_surface(..., spring=name)` and level files.\n\n"
      "law: an object with force(h) [m], potential(h) [m2] and slope(h) [1] of the height h [m] of the surface,\n"
      "    negative where it is pushed in; force(0) = 0 and slope(0) = 1: the force is stiffness * force(h).\n\n"
      "A slow path: each call takes Python's global lock, thousands of times a tick. It lasts until the program\n"
      "ends. A law that raises ends the call of the session with pliant.Error.");
}

}  // namespace pliant_python
