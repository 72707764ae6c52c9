#include "c/border.h"

#include <cmath>
#include <exception>
#include <new>

namespace pliant::c {
namespace {

// Of the calling thread. `message` is the fallback where there was no memory for the rest.
struct LastError {
  Error error;
  std::string message;
  const char* fallback = "";
};
thread_local LastError last;

void keep(Error error) noexcept {
  try {
    last.message = error.message();
    last.error = std::move(error);
    last.fallback = "";
  } catch (...) {
    last.message.clear();
    last.fallback = "out of memory";
  }
}

const char* message_of_last() {
  return last.message.empty() ? last.fallback : last.message.c_str();
}

}  // namespace

pliant_status status_of_exception(const char* call) noexcept {
  try {
    throw;
  } catch (const Misuse& misuse) {
    keep({call, misuse.what, misuse.cure, misuse.code});
    return PLIANT_MISUSED;
  } catch (Error& error) {
    if (error.code.empty()) error.code = "call.refused";
    keep(error);
  } catch (const std::bad_alloc&) {
    keep({call, "there is not enough memory", "", "call.memory"});
  } catch (const std::exception& error) {
    keep({call, std::string("it ended with an exception: ") + error.what(), "", "call.exception"});
  } catch (...) {
    keep({call, "it ended with an exception", "", "call.exception"});
  }
  return PLIANT_FAILED;
}

void throw_unless_held(const Held& held, const char* of) {
  const std::string name = of;
  switch (held.failure()) {
    case Held::Failure::kNone:
      return;
    case Held::Failure::kNull:
      throw_null(of);
    case Held::Failure::kDead:
      throw Misuse{"`" + name + "` is not a handle of that kind, or was destroyed", "pass one that is alive",
                   "call.handle"};
    case Held::Failure::kBusy:
      throw Misuse{"another call uses `" + name + "` now", "use it on one thread, and not from its own callbacks",
                   "call.busy"};
  }
}

void throw_null(const char* of) {
  throw Misuse{"`" + std::string(of) + "` is NULL", "check the status of the call that should have made it",
               "call.null"};
}

void throw_size(const char* of, std::uint32_t is, std::size_t must) {
  throw Misuse{
      "`" + std::string(of) + "`: its `size` is " + std::to_string(is) + "; it must be " + std::to_string(must),
      "set it to the struct's sizeof, and compile with the header of this libpliant", "call.size"};
}

void throw_room(std::size_t capacity, std::size_t count) {
  throw Misuse{"there is room for " + std::to_string(capacity) + ", and there are " + std::to_string(count),
               "`count` says how much is needed", "call.room"};
}

void throw_unless_below(std::size_t index, std::size_t count, const char* cure) {
  if (index >= count)
    throw Misuse{"`index` is " + std::to_string(index) + "; there are " + std::to_string(count), cure, "call.index"};
}

double at_least_zero(double value, const char* of) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw Misuse{"`" + std::string(of) + "` is negative or not a finite number", "", "call.number"};
  return value;
}

dquat of_c(const pliant_quat& q) {
  if (q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0) return {1, 0, 0, 0};
  return {q.w, q.x, q.y, q.z};
}

Path path_of_c(const pliant_path_row* rows, std::size_t count, bool repeats) {
  Path path;
  if (count > 0) needed(rows, "rows");
  path.turns = true;
  path.repeats = repeats;
  for (std::size_t i = 0; i < count; ++i)
    path.rows.push_back({rows[i].time, of_c(rows[i].pose.position), of_c(rows[i].pose.rotation)});
  return path;
}

pliant_device_sample sample_to_c(const DeviceSample& sample) {
  return {sizeof(pliant_device_sample),
          sample.ready,
          {to_c(sample.position), to_c(sample.rotation)},
          sample.grip,
          sample.time,
          sample.battery,
          sample.buttons,
          sample.warnings};
}

}  // namespace pliant::c

using namespace pliant::c;

pliant_status pliant_last_error(pliant_error* out) {
  return border(__func__, [&] {
    const pliant::Error& error = last.error;
    sized(out, "out") = {sizeof(pliant_error), error.node,         message_of_last(),  error.where.c_str(),
                         error.what.c_str(),   error.cure.c_str(), error.code.c_str(), error.pointer.c_str()};
  });
}

const char* pliant_error_message(void) {
  return message_of_last();
}

const char* pliant_error_code(void) {
  return last.error.code.c_str();
}
