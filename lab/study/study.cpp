#include "lab/study/study.h"

#include <algorithm>
#include <string>
#include <vector>

#include "content/keys/extension_table.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/files/output_folder.h"
#include "lab/study/studies.h"

namespace pliant {
namespace {

struct Study {
  const char* name;
  const char* what;
  Status (*run)(OutputFolder& out, StudySize size, const Interrupt& interrupt);
};
constexpr Study kStudies[] = {
#define STUDY(name, what) {#name, what, study_##name},
    PLIANT_STUDIES(STUDY)
#undef STUDY
};

int list() {
  for (const Study& known : kStudies) print("{:<16} {}\n", known.name, known.what);
  return kDone;
}

// Runs studies into one folder, which receives the results of all of them or of none.
int run_all(const std::vector<const Study*>& studies, const StudyOptions& options) {
  const Interrupt interrupt(kAllOrNothing);  // until all files are in place: removes staged files on interruption
  auto out = OutputFolder::create(options.out.empty() ? "out/study" : options.out, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  for (const Study* known : studies)
    if (const Status done = known->run(*out, options.quick ? StudySize::kQuick : StudySize::kFull, interrupt); !done)
      return fail(kFailed, out->at_place(done.error()));
  if (const Status done = out->commit(); !done) return fail(kFailed, done.error());
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces a study's)" : "");
  for (const std::string& name : out->written())
    if (name.ends_with(".png")) print("plot: {}\n", (out->shown() / name).string());
  return kDone;
}

}  // namespace

int study(const StudyOptions& options) {
  if (options.list) return list();
  if (options.name.empty())
    return fail(kUsage, {"study", "say which one, or all; `pliant study --list` says which there are"});
  std::vector<const Study*> chosen;
  std::vector<std::string> names{"all"};
  for (const Study& known : kStudies) {
    names.push_back(known.name);
    if (options.name == "all" || options.name == known.name) chosen.push_back(&known);
  }
  if (chosen.empty()) {
    const std::string near = suggestion(options.name, names);
    return fail(kUsage, {"study", "unknown study '" + options.name + "'" +
                                      (near.empty() ? "; `pliant study --list` says which there are" : near)});
  }
  return run_all(chosen, options);
}

}  // namespace pliant
