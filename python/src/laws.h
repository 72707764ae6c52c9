// Spring laws written in Python: a slow path, as every call takes the GIL.
#pragma once

#include <pybind11/pybind11.h>

namespace pliant_python {

namespace py = pybind11;

// Throws the Failure of a Python law that has raised since the last call.
void check_laws();
void bind_laws(py::module_& module);

}  // namespace pliant_python
