#include "player/study/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "player/exit.h"
#include "player/print.h"
#include "player/record/output_folder.h"
#include "player/study/study_linearisation.h"

namespace pliant {
namespace {

struct Study {
  const char* name;
  const char* what;
  Status (*run)(OutputFolder& out, bool quick, const Interrupt& interrupt);
};
constexpr Study kStudies[] = {
    {"linearisation", "1 kHz force of a tool: held, linear, contacts solved again, against the full solve",
     study_linearisation},
};

int list() {
  for (const Study& known : kStudies) print("{:<16} {}\n", known.name, known.what);
  return kDone;
}

int run_one(const Study& known, const StudyOptions& options) {
  const std::filesystem::path folder = options.out.empty() ? "out/study" : options.out;
  const Interrupt interrupt;  // until all is in place: what is staged must not stay behind
  auto out = OutputFolder::create(folder);
  if (!out) return fail(kFailed, out.error());
  if (const Status done = known.run(*out, options.quick, interrupt); !done) return fail(kFailed, done.error());
  if (const Status done = out->commit(); !done) return fail(kFailed, done.error());
  return kDone;
}

}  // namespace

int study(const StudyOptions& options) {
  if (options.list) return list();
  if (options.name.empty())
    return fail(kUsage, {"study", "say which one, or all; `pliant study --list` says which there are"});
  int status = kDone;
  bool found = false;
  for (const Study& known : kStudies) {
    if (options.name != "all" && options.name != known.name) continue;
    found = true;
    status = std::max(status, run_one(known, options));
  }
  if (!found)
    return fail(kUsage, {"study", "unknown study '" + options.name + "'; `pliant study --list` says which there are"});
  return status;
}

}  // namespace pliant
