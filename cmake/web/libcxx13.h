// What emscripten 3.1.6 lacks, in front of every file by -include. Of C++20 (libc++ 13): bit_cast, source_location,
// stop_token and jthread, from_chars of floating point, Bessel functions, the order of arrays; of Linux: syscall,
// renameat2, the priority of a thread.
#pragma once
#ifdef __cplusplus

#include <pthread.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <compare>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

// They fail; each caller has a way for that.
#define SYS_write 0
inline long syscall(long, ...) {
  errno = ENOSYS;
  return -1;
}
#define RENAME_NOREPLACE 1u
inline int renameat2(int, const char*, int, const char*, unsigned) {
  errno = ENOSYS;
  return -1;
}

extern "C" inline int pthread_setschedparam(pthread_t, int, const sched_param*) {
  return ENOSYS;
}

// Eigen: as on x86-64, which has 16 registers, and without assembly.
#define EIGEN_ARCH_DEFAULT_NUMBER_OF_REGISTERS 16
#define EIGEN_OPTIMIZATION_BARRIER(value)

namespace std {

double cyl_bessel_j(double order, double x);  // bessel.cpp
double cyl_bessel_i(double order, double x);

template <class T, size_t kSize>
constexpr auto operator<=>(const array<T, kSize>& a, const array<T, kSize>& b) {
  using Order = decltype(a[0] <=> b[0]);
  for (size_t i = 0; i < kSize; ++i)
    if (const Order order = a[i] <=> b[i]; order != 0) return order;
  return Order::equivalent;
}

template <class To, class From>
requires(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>) constexpr To
    bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

struct source_location {
  static constexpr source_location current(const char* file = __builtin_FILE(),
                                           const char* function = __builtin_FUNCTION(),
                                           unsigned line = __builtin_LINE()) noexcept {
    source_location at;
    at.file_ = file, at.function_ = function, at.line_ = line;
    return at;
  }
  constexpr const char* file_name() const noexcept { return file_; }
  constexpr const char* function_name() const noexcept { return function_; }
  constexpr unsigned line() const noexcept { return line_; }
  constexpr unsigned column() const noexcept { return 0; }

 private:
  const char *file_ = "", *function_ = "";
  unsigned line_ = 0;
};

namespace pliant_web {
struct Stop {
  mutex guard;
  bool requested = false;
  list<function<void()>> calls;
};
}  // namespace pliant_web

class stop_token {
 public:
  stop_token() = default;
  explicit stop_token(shared_ptr<pliant_web::Stop> state) : state_(std::move(state)) {}
  bool stop_requested() const noexcept {
    if (!state_) return false;
    const lock_guard<mutex> lock(state_->guard);
    return state_->requested;
  }
  bool stop_possible() const noexcept { return state_ != nullptr; }

 private:
  template <class>
  friend class stop_callback;
  shared_ptr<pliant_web::Stop> state_;
};

class stop_source {
 public:
  stop_token get_token() const noexcept { return stop_token(state_); }
  bool stop_requested() const noexcept { return get_token().stop_requested(); }
  bool request_stop() noexcept {
    const lock_guard<mutex> lock(state_->guard);
    if (state_->requested) return false;
    state_->requested = true;
    for (const function<void()>& call : state_->calls) call();
    return true;
  }

 private:
  shared_ptr<pliant_web::Stop> state_ = make_shared<pliant_web::Stop>();
};

// A callback may not touch its own stop state.
template <class F>
class stop_callback {
 public:
  stop_callback(const stop_token& token, F call) : state_(token.state_) {
    if (!state_) return;
    const lock_guard<mutex> lock(state_->guard);
    if (state_->requested) {
      call();
      return;
    }
    at_ = state_->calls.insert(state_->calls.end(), std::move(call));
    linked_ = true;
  }
  stop_callback(const stop_callback&) = delete;
  ~stop_callback() {
    if (!linked_) return;
    const lock_guard<mutex> lock(state_->guard);
    state_->calls.erase(at_);
  }

 private:
  shared_ptr<pliant_web::Stop> state_;
  list<function<void()>>::iterator at_;
  bool linked_ = false;
};

class jthread {
 public:
  jthread() = default;
  template <class F>
  requires(!is_same_v<remove_cvref_t<F>, jthread>) explicit jthread(F&& work) {
    if constexpr (is_invocable_v<decay_t<F>, stop_token>)
      thread_ = thread(std::forward<F>(work), source_.get_token());
    else
      thread_ = thread(std::forward<F>(work));
  }
  jthread(jthread&&) = default;
  jthread& operator=(jthread&& other) {
    end();
    source_ = std::move(other.source_), other.source_ = stop_source(), thread_ = std::move(other.thread_);
    return *this;
  }
  ~jthread() { end(); }
  bool joinable() const { return thread_.joinable(); }
  void join() { thread_.join(); }
  bool request_stop() { return source_.request_stop(); }
  stop_token get_stop_token() const { return source_.get_token(); }

 private:
  void end() {
    if (thread_.joinable()) source_.request_stop(), thread_.join();
  }
  stop_source source_;
  thread thread_;
};

namespace pliant_web {
// musl's strtod rounds correctly, as from_chars must; what from_chars does not read is kept from it: a leading space, a
// plus sign, hexadecimal digits. Every text that ends at `last` is copied, because strtod needs an end.
template <class T>
from_chars_result read_number(const char* first, const char* last, T& value) {
  const char* at = first;
  if (at != last && *at == '-') ++at;
  const bool digit = at != last && ((*at >= '0' && *at <= '9') || *at == '.');
  const bool word = at != last && (*at == 'i' || *at == 'I' || *at == 'n' || *at == 'N');
  if (!digit && !word) return {first, errc::invalid_argument};
  const char* end = at;
  while (end != last && ((*end >= '0' && *end <= '9') || (*end >= 'a' && *end <= 'z') || (*end >= 'A' && *end <= 'Z') ||
                         *end == '.' || *end == '+' || *end == '-' || *end == '(' || *end == ')' || *end == '_'))
    if (*end == 'x' || *end == 'X')
      break;
    else
      ++end;
  const string text(first, end);
  char* stop = nullptr;
  errno = 0;
  T read;
  if constexpr (is_same_v<T, float>)
    read = strtof(text.c_str(), &stop);
  else
    read = strtod(text.c_str(), &stop);
  if (stop == text.c_str()) return {first, errc::invalid_argument};
  const char* const after = first + (stop - text.c_str());
  if (errno == ERANGE && (read == 0 || read > T(1) || read < T(-1))) return {after, errc::result_out_of_range};
  value = read;
  return {after, errc{}};
}
}  // namespace pliant_web

inline from_chars_result from_chars(const char* first, const char* last, float& value) {
  return pliant_web::read_number(first, last, value);
}
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  return pliant_web::read_number(first, last, value);
}

}  // namespace std

#endif
