// Drivers written in Python, and the devices that there are.
#pragma once

#include <pliant/driver.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "python/src/failure.h"

namespace pliant_python {

// Calls read(), write(force, torque), open(), close() of a Python object, as far as it has them.
std::unique_ptr<pliant::Driver> python_driver(const py::object& object, std::shared_ptr<Raised> raised);

void bind_drivers(py::module_& module);

}  // namespace pliant_python
