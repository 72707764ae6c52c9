// What the verbs of `pliant` take: options, their ranges and their help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "editor/edit.h"
#include "lab/fit/fit.h"
#include "lab/plot/plot_runs.h"
#include "lab/study/study.h"
#include "lab/sweep/sweep.h"
#include "player/verbs/verbs.h"

namespace pliant {

void add_run(CLI::App& app, RunOptions& run);
void add_files(CLI::App& app, InspectOptions& inspection, ConvertOptions& conversion, std::string& validated);
void add_author(CLI::App& app, AuthorOptions& options);
void add_edit(CLI::App& app, EditOptions& options, std::string& unit);
void add_study(CLI::App& app, StudyOptions& options);
void add_sweep(CLI::App& app, SweepOptions& options, MergeOptions& merging);
void add_fit(CLI::App& app, FitOptions& options);
void add_plot(CLI::App& app, PlotOptions& options);

// --- For those above.

// Finite, and within [low, high]; the sentence says the range.
CLI::Validator within(double low, double high);
// "a, b, c".
std::string joined(const std::vector<std::string>& words);
// One of these words; the sentence lists them.
CLI::Validator one_of(std::vector<std::string> words);
// A variable of the shell that was not set: the demo level is not meant.
CLI::Validator named();
// "960x540" -> width, height; a sentence where it is not that.
std::string parse_size(const std::string& text, RunOptions& run);
// --unit of every verb that takes a bare mesh.
void add_unit(CLI::App* verb, double& unit, const char* what);
// --limits of every verb that reads files.
void add_limits(CLI::App* verb);

}  // namespace pliant
