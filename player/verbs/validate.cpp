// pliant validate: prints every finding of a level with its JSON pointer.
#include "content/validate.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/files/content_folder.h"
#include "player/verbs/verbs.h"
#include "systems/prepare_world.h"
#include "systems/soft/under_gravity.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

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

// A list of findings; a key without a value is left out.
OrderedJson json_of(const Findings& findings) {
  OrderedJson list = OrderedJson::array();
  for (const Finding& finding : findings) {
    OrderedJson& json = list.emplace_back(OrderedJson::object());
    json["severity"] = word(finding.severity);
    for (const auto& [key, value] : {std::pair("code", &finding.code),
                                     {"pointer", &finding.pointer},
                                     {"what", &finding.what},
                                     {"cure", &finding.cure}})
      if (!value->empty()) json[key] = *value;
  }
  return list;
}

}  // namespace

int validate(const ValidateOptions& options) {
  const auto file = find_level(options.level);
  if (!file) return fail(kFailed, file.error());
  const auto prepare = [](World& world) -> Status {
    if (const Status status = prepare_world(world); !status) return status;
    find_sag(world);
    return Done{};
  };
  const Findings findings = validate_level(*file, prepare, options.unit);
  int errors = 0, warnings = 0;
  for (const Finding& finding : findings) {
    errors += finding.severity == Severity::kError;
    warnings += finding.severity == Severity::kWarning;
    if (!options.json)
      print("{}: {}: {}\n", finding.pointer.empty() ? "/" : finding.pointer, word(finding.severity), finding.message());
  }
  if (options.json)
    print_json(json_of(findings));
  else
    print("{}: {} error{}, {} warning{}\n", file->string(), errors, errors == 1 ? "" : "s", warnings,
          warnings == 1 ? "" : "s");
  if (errors == 0) return kDone;
  std::fflush(stdout);  // the findings stand above the error, also in a pipe
  return fail(kFailed, {file->string(), fmt::format("{} error{}", errors, errors == 1 ? "" : "s"),
                        fmt::format("see the finding{} above", errors == 1 ? "" : "s")});
}

}  // namespace pliant
