// pliant run: a level or mesh with its probes, the run loop, and its results.
#include <optional>
#include <utility>

#include "content/level/soft_store.h"
#include "player/level/level_run.h"
#include "player/level/window_run.h"
#include "player/verbs/verbs.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

Outcome check(const RunOptions& options) {
  if (options.field == "gpu" && options.frames == 0)
    return wrong_arguments({"--field gpu", "computes the surface for pictures; leave out --frames 0"});
  if (options.sized && options.frames == 0 && (options.headless || options.lockstep || !options.replay.empty()))
    return wrong_arguments({"--size", "is of pictures and windows; leave out --frames 0"});
  if (!options.replay.empty() && options.realtime)
    return wrong_arguments({"--replay", "runs in lockstep; leave out --realtime"});
  if (!options.replay.empty() && !options.probes.empty())
    return wrong_arguments({"--replay", "moves every probe itself; leave out --probe"});
  if (!options.replay.empty() && options.window)
    return wrong_arguments({"--replay", "runs in lockstep, which a window does not; leave out --window"});
  return {};
}

// `next`: a level that the window opened meanwhile.
Outcome run_level(Prepared& run, Shown* shown, const Interrupt& interrupt, std::optional<Prepared>& next) {
  LevelRun level(run, shown, interrupt);
  if (Outcome wrong = level.open()) return wrong;
  level.go(next);
  return level.close();
}

}  // namespace

int run(const RunOptions& options) {
  set_thread_count(options.threads);
  set_soft_store(options.soft_store);
  if (Outcome wrong = check(options)) return fail(wrong->status, wrong->error);
  std::optional<Shown> shown;
  if (Outcome wrong = open_window(options, shown)) return fail(wrong->status, wrong->error);
  std::optional<Prepared> next(std::in_place);
  next->options = next->asked = options;
  Outcome wrong = prepare(options, shown.has_value(), *next);
  const Interrupt interrupt;
  while (!wrong && next) {
    Prepared now = std::move(*next);
    next.reset();
    wrong = run_level(now, shown ? &*shown : nullptr, interrupt, next);
    if (interrupt.requested()) next.reset();
  }
  return wrong ? fail(wrong->status, wrong->error) : kDone;
}

}  // namespace pliant
