// The verbs of `pliant`: options, their ranges and their help. A new verb is a file with a function like these, and a
// line in the table in command_line.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "player/verbs/verbs.h"

namespace pliant {

// Adds a verb with its options. Its callback runs the verb and sets the exit status.
using AddVerb = void (*)(CLI::App& app, int& status);
void add_run(CLI::App& app, int& status);
void add_author(CLI::App& app, int& status);
void add_inspect(CLI::App& app, int& status);
void add_convert(CLI::App& app, int& status);
void add_validate(CLI::App& app, int& status);
void add_devices(CLI::App& app, int& status);
void add_study(CLI::App& app, int& status);
void add_sweep(CLI::App& app, int& status);
void add_fit(CLI::App& app, int& status);
void add_plot(CLI::App& app, int& status);
void add_edit(CLI::App& app, int& status);

// The options of `run` alone.
CLI::App* add_run_options(CLI::App& app, RunOptions& run);

// --- Helpers for the functions above.

// Finite and within [low, high]; the error states the range.
CLI::Validator within(double low, double high);
// "a, b, c".
std::string joined(const std::vector<std::string>& words);
// One of these words; the error lists them.
CLI::Validator one_of(std::vector<std::string> words);
// Rejects an empty level name: it comes from an unset shell variable and does not mean the demo level.
CLI::Validator named();
// "960x540" -> width, height; otherwise returns a sentence.
std::string parse_size(const std::string& text, RunOptions& run);
// --unit of every verb that reads a bare mesh.
void add_unit(CLI::App* verb, std::optional<double>& unit, const char* what);
// --limits of every verb that reads files.
void add_limits(CLI::App* verb);

}  // namespace pliant
