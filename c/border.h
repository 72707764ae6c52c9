// The border of the C interface: checks of arguments, errors, conversions of plain structs. Inside of a call a failed
// check throws; `border` turns every exception into a status, and keeps its sentence for the calling thread.
#pragma once

#include <pliant.h>

#include <cstddef>
#include <string>
#include <utility>

#include "c/handles.h"
#include "pliant/pliant.h"

namespace pliant::c {

// A call that is wrong by itself: PLIANT_MISUSED.
struct Misuse {
  std::string what, cure;
  const char* code;
};

// From within a handler: the status of the exception that is handled.
pliant_status status_of_exception(const char* call) noexcept;

template <class F>
pliant_status border(const char* call, F&& act) noexcept {
  try {
    act();
    return PLIANT_OK;
  } catch (...) {
    return status_of_exception(call);
  }
}

void throw_unless_held(const Held& held, const char* of);
[[noreturn]] void throw_null(const char* of);
[[noreturn]] void throw_size(const char* of, std::uint32_t is, std::size_t must);
[[noreturn]] void throw_room(std::size_t capacity, std::size_t count);
void throw_unless_below(std::size_t index, std::size_t count, const char* cure);
// `value` [any unit] is not finite, or below 0.
double at_least_zero(double value, const char* of);

template <class T>
T& needed(T* value, const char* of) {
  if (!value) throw_null(of);
  return *value;
}

inline std::string text(const char* value, const char* of) {
  return &needed(value, of);
}

// A struct with its size.
template <class T>
T& sized(T* value, const char* of) {
  if (needed(value, of).size != sizeof(T)) throw_size(of, value->size, sizeof(T));
  return *value;
}

// The value of a Result, or its Error as an exception.
template <class T>
T taken(Result<T>&& result) {
  if (!result) throw std::move(result).error();
  return std::move(result).value();
}
inline void check(Status&& status) {
  if (!status) throw std::move(status).error();
}

// An array of the caller's.
template <class T>
class ArrayOut {
 public:
  ArrayOut(T* out, std::size_t capacity, std::size_t* count) : out_(out), capacity_(capacity), count_(count) {
    needed(count, "count");
    if (capacity > 0) needed(out, "out");
    if constexpr (requires { out->size; })
      if (capacity > 0) sized(out, "out[0]");
  }
  // False: the caller only counts.
  bool fits(std::size_t count) const {
    *count_ = count;
    if (capacity_ == 0 && !out_) return false;
    if (count > capacity_) throw_room(capacity_, count);
    return true;
  }
  std::size_t capacity() const { return capacity_; }
  T* begin() const { return out_; }

 private:
  T* out_;
  std::size_t capacity_;
  std::size_t* count_;
};

inline dvec3 of_c(const pliant_vec3& v) {
  return {v.x, v.y, v.z};
}
dquat of_c(const pliant_quat& q);  // all zeros: the identity
inline pliant_vec3 to_c(const dvec3& v) {
  return {v.x, v.y, v.z};
}
inline pliant_quat to_c(const dquat& q) {
  return {q.x, q.y, q.z, q.w};
}
Path path_of_c(const pliant_path_row* rows, std::size_t count, bool repeats);
pliant_device_sample sample_to_c(const DeviceSample& sample);

}  // namespace pliant::c
