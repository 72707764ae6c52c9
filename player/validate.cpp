// pliant validate: every finding of a level, each with its JSON pointer.
#include <fmt/format.h>

#include <string>

#include "content/gltf_document.h"
#include "content/level.h"
#include "player/content_folder.h"
#include "player/exit.h"
#include "player/verbs.h"

namespace pliant {
namespace {

const char* word(Severity severity) {
  switch (severity) {
    case Severity::kError: return "error";
    case Severity::kWarning: return "warning";
    case Severity::kNote: break;
  }
  return "note";
}

bool is_gltf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".gltf" || extension == ".glb";
}

// "FILE /nodes/3/extensions" -> "/nodes/3/extensions"
std::string pointer_of(const Error& error, const std::string& file) {
  if (!error.where.starts_with(file)) return error.where;
  const std::string rest = error.where.substr(file.size());
  return rest.starts_with(' ') ? rest.substr(1) : rest;
}

// The document against the specification, then what only shows when it is read, then what only shows when it is built:
// each step relies on the one before.
Findings find_all(const std::filesystem::path& file) {
  Findings findings;
  if (is_gltf(file)) {
    if (!open_gltf(file, findings)) return findings;
    if (any_error(findings)) return findings;
  }
  const auto level = load_level(file);
  if (!level) {
    findings.push_back({Severity::kError, pointer_of(level.error(), file.string()), level.error().what});
    return findings;
  }
  if (const auto world = spawn(*level); !world)
    findings.push_back({Severity::kError, pointer_of(world.error(), file.string()), world.error().what});
  if (!level->has_pliant())
    findings.push_back({Severity::kNote, "", "no Pliant extension: a bare mesh, touchable with defaults sized to its bounds"});
  return findings;
}

}  // namespace

int validate(const std::string& argument) {
  const auto file = find_level(argument);
  if (!file) return fail(kFailed, file.error());
  const Findings findings = find_all(*file);
  int errors = 0, warnings = 0;
  for (const Finding& finding : findings) {
    errors += finding.severity == Severity::kError;
    warnings += finding.severity == Severity::kWarning;
    fmt::print("{}: {}: {}\n", finding.pointer.empty() ? "/" : finding.pointer, word(finding.severity), finding.message);
  }
  fmt::print("{}: {} errors, {} warnings\n", file->string(), errors, warnings);
  if (errors == 0) return kDone;
  return fail(kFailed, {file->string(), fmt::format("{} error{}; see the finding{} above", errors, errors == 1 ? "" : "s",
                                                    errors == 1 ? "" : "s")});
}

}  // namespace pliant
