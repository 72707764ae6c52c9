// Errors as exceptions: pliant.Error with the sentence, its parts and its code.
#pragma once

#include <pliant/result.h>
#include <pybind11/pybind11.h>

#include <exception>
#include <memory>
#include <mutex>
#include <string>

namespace pliant_python {

namespace py = pybind11;

// The exception that a Python driver or law raised, kept until it can be the cause of an Error. From any thread.
class Raised {
 public:
  Raised() = default;
  Raised(const Raised&) = delete;
  Raised& operator=(const Raised&) = delete;
  ~Raised();
  void keep(py::error_already_set& raised);  // with the GIL; the first one is kept
  bool any();                                // from any thread, without the GIL
  py::object take();                         // with the GIL; none: an empty object

 private:
  std::mutex mutex_;
  PyObject* exception_ = nullptr;
};

// Thrown with or without the GIL; becomes pliant.Error, or a subclass of it, where it reaches Python.
struct Failure : std::exception {
  enum class Kind { kError, kArgument, kName };
  explicit Failure(pliant::Error e, std::shared_ptr<Raised> by = {});
  const char* what() const noexcept override { return sentence.c_str(); }
  void caused_by(const std::shared_ptr<Raised>& raised);  // if that holds an exception
  pliant::Error error;
  Kind kind;
  std::shared_ptr<Raised> cause;
  std::string sentence;
};

// A wrong argument: `where` names it.
[[noreturn]] void wrong_argument(const std::string& where, const std::string& what, const std::string& cure);

// An object whose __init__ was not called.
[[noreturn]] void not_initialised(const char* type);

// For classes that only this module makes: calling them, or their __new__, is a TypeError.
py::custom_type_setup only_made_here();

inline void check(const pliant::Status& status) {
  if (!status) throw Failure(status.error());
}
template <class T>
T check(pliant::Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(result).value();
}

void bind_errors(py::module_& module);

}  // namespace pliant_python
