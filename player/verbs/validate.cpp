// pliant validate: prints every finding of a level with its JSON pointer.
#include "content/validate.h"

#include <fmt/format.h>

#include <string>

#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/files/content_folder.h"
#include "player/verbs/verbs.h"
#include "systems/prepare_world.h"
#include "systems/soft/under_gravity.h"

namespace pliant {
namespace {

const char* word(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    case Severity::kNote:
      return "note";
  }
  UNREACHABLE();
}

}  // namespace

int validate(const std::string& argument) {
  const auto file = find_level(argument);
  if (!file) return fail(kFailed, file.error());
  const Findings findings = validate_level(*file, [](World& world) -> Status {
    if (const Status status = prepare_world(world); !status) return status;
    find_sag(world);
    return Done{};
  });
  int errors = 0, warnings = 0;
  for (const Finding& finding : findings) {
    errors += finding.severity == Severity::kError;
    warnings += finding.severity == Severity::kWarning;
    print("{}: {}: {}\n", finding.pointer.empty() ? "/" : finding.pointer, word(finding.severity), finding.message);
  }
  print("{}: {} error{}, {} warning{}\n", file->string(), errors, errors == 1 ? "" : "s", warnings,
        warnings == 1 ? "" : "s");
  if (errors == 0) return kDone;
  return fail(kFailed, {file->string(), fmt::format("{} error{}; see the finding{} above", errors,
                                                    errors == 1 ? "" : "s", errors == 1 ? "" : "s")});
}

}  // namespace pliant
