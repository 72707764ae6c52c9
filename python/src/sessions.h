// The class Session of the module, and what its calls return.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "python/src/held_session.h"

namespace pliant_python {

using SessionClass = py::class_<HeldSession, std::shared_ptr<HeldSession>>;

void bind_sessions(py::module_& module);
void bind_state(SessionClass& session);    // parameters, states, forces, places
void bind_queries(SessionClass& session);  // names, contacts, geometry, pictures
void bind_window(SessionClass& session);   // pliant.view
void bind_results(py::module_& module);    // Contact, Reading, FeltEvent, Hit, Note

}  // namespace pliant_python
