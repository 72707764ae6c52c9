// Errors at the border (files, devices, arguments): a value, or one sentence that says where, what is wrong and what to
// do. No function of the library throws.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace pliant {

// One actionable sentence: "WHERE: what is wrong; what to do".
struct Error {
  std::string where;       // file, JSON pointer, option or device
  std::string what;        // what is wrong, and after a semicolon what to do
  std::int32_t node = -1;  // of the level: index of the node that it is about; -1: of none
  std::string pointer;     // JSON pointer within the file, where it has one; `where` names it too
  std::string message() const { return where.empty() ? what : where + ": " + what; }
};

// A value was taken from an Error without asking for it first (or the other way round): the program stops and says so.
[[noreturn]] inline void unchecked_result(const std::string& message) {
  std::fprintf(stderr, "pliant: internal error: a Result was used without a check: %s\n", message.c_str());
  std::abort();
}

// A T, or the Error that kept it from being made. Check it (`if (!result)`) before its value is taken.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(state_);
  }
  const T& value() const& {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(state_);
  }
  T&& value() && {
    if (!ok()) unchecked_result(std::get<1>(state_).message());
    return std::get<0>(std::move(state_));
  }
  const Error& error() const {
    if (ok()) unchecked_result("it has a value and no error");
    return std::get<1>(state_);
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, Error> state_;
};

// Done, or the Error that stopped it.
struct Done {};
using Status = Result<Done>;

}  // namespace pliant
