// Errors at the border (files, devices, arguments): a value, or one sentence that says where, what is wrong and what to
// do. Inside the house, broken promises are ASSERTs; nothing is thrown across a folder.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "runtime/assert.h"

namespace pliant {

// One actionable sentence: "WHERE: what is wrong; what to do".
struct Error {
  std::string where;       // file, JSON pointer, option or device
  std::string what;        // what is wrong, and after a semicolon what to do
  std::int32_t node = -1;  // of the level: index of the node that it is about; -1: of none
  std::string pointer;     // JSON pointer within the file, where it has one; `where` names it too
  std::string message() const { return where.empty() ? what : where + ": " + what; }
};

// A T, or the Error that kept it from being made.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & {
    ASSERT(ok());
    return std::get<0>(state_);
  }
  const T& value() const& {
    ASSERT(ok());
    return std::get<0>(state_);
  }
  T&& value() && {
    ASSERT(ok());
    return std::get<0>(std::move(state_));
  }
  const Error& error() const {
    ASSERT(!ok());
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
