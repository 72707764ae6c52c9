// The compiled part of the package `pliant`: the public C++ interface, without the GIL, with errors as exceptions.
#include <pliant/process.h>
#include <pybind11/pybind11.h>

#include "python/src/drivers.h"
#include "python/src/failure.h"
#include "python/src/held_session.h"
#include "python/src/laws.h"
#include "python/src/runs.h"
#include "python/src/scenes.h"
#include "python/src/sessions.h"

PYBIND11_MODULE(_pliant, module) {
  module.doc() = "The compiled part of pliant.";
  module.attr("__version__") = PLIANT_VERSION;
  pliant_python::bind_errors(module);
  pliant_python::bind_results(module);
  pliant_python::bind_scenes(module);
  pliant_python::bind_sessions(module);
  pliant_python::bind_runs(module);
  pliant_python::bind_drivers(module);
  pliant_python::bind_laws(module);
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&pliant_python::close_all_sessions));
}
