// Errors of files, devices and arguments: a value, or place, fault, remedy and code. No function of the library throws.
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

// "FAULT; CURE", or the fault alone.
inline std::string sentence_of(const std::string& what, const std::string& cure) {
  return cure.empty() ? what : what + "; " + cure;
}

// A fact for programs, and its sentence for people: "WHERE: what is wrong; what to do". A program goes by `code`,
// never by the words (docs/codes.md).
struct Error {
  std::string where;       // file, JSON pointer, option or device
  std::string what;        // the fault
  std::string cure;        // the remedy; empty: none is known
  std::string code;        // "file.missing"; empty: nothing goes by it
  std::int32_t node = -1;  // index of the level node concerned; -1: none
  std::string pointer;     // JSON pointer within the file, if there is one; `where` includes it too
  Error at(std::string place) const {
    Error error = *this;
    error.where = std::move(place);
    return error;
  }
  // Without `where`.
  std::string sentence() const { return sentence_of(what, cure); }
  std::string message() const { return where.empty() ? sentence() : where + ": " + sentence(); }
};

// Something worth knowing that does not prevent what was asked: of a run, of a conversion.
struct Note {
  std::string what;  // the whole, or the part before the remedy
  std::string cure;  // the remedy; empty: none is needed
  std::string code;  // "force.clipped"; empty: nothing goes by it
  std::string of;    // name of the probe, tool, body or device concerned; empty: the whole
  std::string message() const { return sentence_of(what, cure); }
  bool operator==(const Note&) const = default;
};

inline Error error_at(std::string where, Note fault) {
  return {std::move(where), std::move(fault.what), std::move(fault.cure), std::move(fault.code), -1, {}};
}

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
