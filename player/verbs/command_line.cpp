#include "player/verbs/command_line.h"

#include <algorithm>
#include <exception>
#include <optional>

#include "content/files/limits.h"
#include "content/keys/extension_table.h"
#include "lab/console/exit.h"
#include "lab/console/progress.h"
#include "lab/console/standard_streams.h"
#include "player/verbs/options.h"
#include "pliant/content.h"
#include "pliant/process.h"

namespace pliant {
namespace {

constexpr const char* kArguments = "arguments";  // code

// The unknown option and the nearest known one, if one is near.
std::optional<Error> unknown_option(const CLI::App& app, const std::string& where) {
  std::vector<std::string> known;
  for (const CLI::App* verb : app.get_subcommands())
    for (const CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (const std::string& argument : app.remaining(true)) {
    if (!argument.starts_with("--")) continue;
    const std::string option = argument.substr(0, argument.find('='));
    if (std::string near = suggestion(option, known); !near.empty())
      return Error{where, "unknown option '" + option + "'", std::move(near), kArguments};
  }
  return std::nullopt;
}

// CLI11's messages may have several lines; ours is one sentence that refers to the help.
Error usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string where = "arguments", help = "pliant --help";
  for (const CLI::App* verb : app.get_subcommands()) {
    where = verb->get_name();
    help = "pliant " + where + " --help";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    if (std::optional<Error> unknown = unknown_option(app, where)) return *unknown;
  }
  std::string what = error.what();
  what = what.substr(0, what.find('\n'));
  while (!what.empty() && (what.back() == '.' || what.back() == ' ')) what.pop_back();
  return {where, what, "see `" + help + "`", kArguments};
}

Error unknown_verb(const std::string& word, const std::vector<CLI::App*>& verbs) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  const std::string near = suggestion(word, names);
  return {"arguments", "unknown verb '" + word + "'", near.empty() ? "see `pliant --help`" : near, kArguments};
}

constexpr AddVerb kVerbs[] = {add_run,   add_author, add_inspect, add_convert, add_validate, add_devices,
                              add_study, add_sweep,  add_fit,     add_plot,    add_edit};

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{"Pliant: touch soft things, feel the force at 1 kHz", "pliant"};
  app.set_version_flag("--version", "pliant " PLIANT_VERSION);
  app.require_subcommand(1);
  app.footer("Examples:\n  pliant run\n  pliant inspect organ.glb\n  pliant run --help");

  int status = kDone;
  for (const AddVerb add : kVerbs) add(app, status);

  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  const auto is_asked = [&](const CLI::App* known) { return known->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(verbs.begin(), verbs.end(), is_asked))
    return fail(kUsage, unknown_verb(argv[1], verbs));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kUsage, usage_error(app, error));
  }
  return status;
}

}  // namespace

Status check_arguments(const std::vector<std::string>& arguments) {
  CLI::App app{"", "pliant"};
  app.require_subcommand(1);
  int ignored = kDone;
  for (const AddVerb add : kVerbs) add(app, ignored);
  app.parse_complete_callback([] { throw CLI::Success(); });             // before any verb does its work
  const double factor = limit_factor();                                  // --limits would take effect at once
  std::vector<std::string> words(arguments.rbegin(), arguments.rend());  // CLI11 expects reverse order
  std::optional<Error> wrong;
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) wrong = usage_error(app, error);
  }
  set_limit_factor(factor);
  return wrong ? Status(*wrong) : Status(Done{});
}

Status check_run_arguments(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"run"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return check_arguments(words);
}

int command_line(int argc, const char* const* argv) {
  int status = kDone;
  log_to_stderr();
  make_devices_safe_on_signals();
  try {
    status = parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    if (std::ferror(stdout) == 0) return fail(kFailed, explain(error));  // otherwise reported below
  }
  const std::optional<Error> lost = close_stdout();
  return lost && status == kDone ? fail(kFailed, *lost) : status;
}

}  // namespace pliant
