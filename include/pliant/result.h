// Errors of files, devices and arguments: a value, or one sentence with place, fault and remedy. No function of the
// library throws.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

// The return value refers into the object it was called on; clang warns if that is a temporary.
#ifdef __clang__
#define PLIANT_LIFETIMEBOUND [[clang::lifetimebound]]
#else
#define PLIANT_LIFETIMEBOUND
#endif

namespace pliant {

// One actionable sentence: "WHERE: what is wrong; what to do".
struct Error {
  std::string where;       // file, JSON pointer, option or device
  std::string what;        // the fault, and after a semicolon the remedy
  std::int32_t node = -1;  // index of the level node concerned; -1: none
  std::string pointer;     // JSON pointer within the file, if there is one; `where` includes it too
  std::string message() const { return where.empty() ? what : where + ": " + what; }
};

// Called when a value is taken from an Error without a check, or vice versa: aborts with a message (LogLevel::kFatal,
// pliant/process.h).
[[noreturn]] void unchecked_result(const std::string& message);

// A T, or the Error that prevented it. Check it (`if (!result)`) before using its value. On a temporary, value(),
// operator* and error() return by value, so that `for (auto& x : session.findings().value())` is safe. `->` on a
// temporary is for one expression: `session.reading("finger")->force`.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & PLIANT_LIFETIMEBOUND {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(state_);
  }
  const T& value() const& PLIANT_LIFETIMEBOUND {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(state_);
  }
  T value() && {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(std::move(state_));
  }
  const Error& error() const& PLIANT_LIFETIMEBOUND {
    if (ok()) unchecked_result("it has a value and no error");
    return std::get<1>(state_);
  }
  Error error() && {
    if (ok()) unchecked_result("it has a value and no error");
    return std::get<1>(std::move(state_));
  }
  T& operator*() & PLIANT_LIFETIMEBOUND { return value(); }
  const T& operator*() const& PLIANT_LIFETIMEBOUND { return value(); }
  T operator*() && { return std::move(*this).value(); }
  T* operator->() PLIANT_LIFETIMEBOUND { return &value(); }
  const T* operator->() const PLIANT_LIFETIMEBOUND { return &value(); }

 private:
  std::variant<T, Error> state_;
};

// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace pliant
