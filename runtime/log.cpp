#include "runtime/log.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>

#include "pliant/result.h"
#include "runtime/assert.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

// Never destroyed: a thread may log while the program ends.
struct Hook {
  std::mutex mutex;
  std::shared_ptr<const LogHook> now;
};
Hook& hook() {
  static Hook* const it = new Hook;
  return *it;
}

}  // namespace

void set_log(LogHook to) {
  auto next = to ? std::make_shared<const LogHook>(std::move(to)) : nullptr;
  const std::lock_guard lock(hook().mutex);
  hook().now.swap(next);
}

void log_sentence(LogLevel level, const std::string& sentence) {
  std::shared_ptr<const LogHook> now;
  {
    const std::lock_guard lock(hook().mutex);
    now = hook().now;
  }
  if (now) return (*now)(level, sentence);
  if (level != LogLevel::kInfo) std::fprintf(stderr, "pliant: %s\n", printable(sentence).c_str());
}

void unchecked_result(const std::string& message) {
  log_sentence(LogLevel::kFatal, "internal error: a Result was used without a check: " + message);
  std::abort();
}

void assertion_failed(const char* what, const char* file, int line) {
  log_sentence(LogLevel::kFatal, std::string("internal error: ") + file + ":" + std::to_string(line) + ": " + what);
  std::abort();
}

}  // namespace pliant
