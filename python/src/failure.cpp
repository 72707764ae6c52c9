#include "python/src/failure.h"

#include <string_view>
#include <utility>

namespace pliant_python {
namespace {

Failure::Kind kind_of(const pliant::Error& error) {
  if (error.code == "name.unknown") return Failure::Kind::kName;
  return error.code == "arguments" || error.code == "key.value" ? Failure::Kind::kArgument : Failure::Kind::kError;
}

// Names of C++ as they are in Python. Text of files may hold bytes that are not UTF-8.
py::object text(std::string words) {
  constexpr std::pair<const char*, const char*> kNames[] = {{"Session::save_state", "Session.save"},
                                                            {"Session::restore_state", "Session.restore"},
                                                            {"Session::take_readings", "Session.readings"},
                                                            {"Session::", "Session."},
                                                            {"Scene::", "Scene."}};
  for (const auto& [name, here] : kNames)
    for (std::size_t at = words.find(name); at != std::string::npos; at = words.find(name, at))
      words.replace(at, std::string_view(name).size(), here);
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(words.data(), static_cast<Py_ssize_t>(words.size()), "replace"));
}

void raise(const Failure& failure) {
  const char* const names[] = {"Error", "ArgumentError", "UnknownName"};
  const py::object type = py::module_::import("pliant._errors").attr(names[static_cast<int>(failure.kind)]);
  const pliant::Error& e = failure.error;
  py::object error =
      type(text(failure.sentence), py::arg("code") = text(e.code), py::arg("where") = text(e.where),
           py::arg("what") = text(e.what), py::arg("cure") = text(e.cure), py::arg("pointer") = text(e.pointer));
  if (failure.cause)
    if (py::object cause = failure.cause->take()) {
      if (!PyErr_GivenExceptionMatches(cause.ptr(), PyExc_Exception)) {  // Ctrl-C in a driver
        PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(cause.ptr())), cause.ptr());
        return;
      }
      PyException_SetCause(error.ptr(), cause.release().ptr());
    }
  PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

Raised::~Raised() {
  if (!exception_ || !Py_IsInitialized()) return;
  const py::gil_scoped_acquire gil;
  Py_DECREF(exception_);
}

void Raised::keep(py::error_already_set& raised) {
  const std::lock_guard lock(mutex_);
  if (exception_) return;
  exception_ = raised.value().inc_ref().ptr();
  if (raised.trace()) PyException_SetTraceback(exception_, raised.trace().ptr());
}

bool Raised::any() {
  const std::lock_guard lock(mutex_);
  return exception_ != nullptr;
}

py::object Raised::take() {
  const std::lock_guard lock(mutex_);
  return py::reinterpret_steal<py::object>(std::exchange(exception_, nullptr));
}

Failure::Failure(pliant::Error e, std::shared_ptr<Raised> by)
    : error(std::move(e)), kind(kind_of(error)), cause(std::move(by)), sentence(error.message()) {
  if (error.code.empty()) error.code = "call.refused";
}

void wrong_argument(const std::string& where, const std::string& what, const std::string& cure) {
  throw Failure(pliant::Error{where, what, cure, "arguments"});
}

void Failure::caused_by(const std::shared_ptr<Raised>& raised) {
  if (cause || !raised->any()) return;
  cause = raised;
  error.cure = "correct the driver, and restart() the session";
  sentence = error.message();
}

void not_initialised(const char* type) {
  wrong_argument(type, "was not initialised", "call it, or super().__init__() in a subclass");
}

py::custom_type_setup only_made_here() {
  return py::custom_type_setup([](PyHeapTypeObject* type) {
    type->ht_type.tp_new = [](PyTypeObject* made, PyObject*, PyObject*) -> PyObject* {
      PyErr_Format(PyExc_TypeError, "%s is what a session returns; it is not made by hand", made->tp_name);
      return nullptr;
    };
  });
}

void bind_errors(py::module_& module) {
  (void)module;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Failure& failure) {
      raise(failure);
    } catch (const py::cast_error&) {
      raise(Failure(
          pliant::Error{"", "an argument has the wrong type", "give a number where one is needed", "arguments"}));
    }
  });
}

}  // namespace pliant_python
