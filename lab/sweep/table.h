// A sweep's runs and what came of them, in the order of the plan: what tables and plots are made from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/sweep/axis.h"
#include "lab/sweep/lines.h"
#include "runtime/result.h"

namespace pliant {

struct SweepRow {
  std::string id;
  std::vector<PlanJson> values;  // of the axes
  PlanJson line;                 // null: missing
  bool done() const { return !line.is_null() && is_done(line); }
};

struct SweepTable {
  PlanJson sweep;               // sweep.json, without the runs
  std::vector<SweepAxis> axes;  // of sampled ones without values
  std::vector<SweepRow> rows;
  std::vector<std::string> figures;  // names, in the order in which rows first have them
  std::vector<std::string> timings;
  std::vector<std::string> disagree;  // ids
  std::size_t torn = 0, foreign = 0;  // lines that are none; lines of runs that the plan does not have
};

// How many of the runs that were done have probes, none of which ever touched anything.
std::size_t untouched(const SweepTable& table);

// Of all folders, which must be of one plan.
Result<SweepTable> read_table(const std::vector<std::filesystem::path>& folders);

std::string results_csv(const SweepTable& table);
std::string timings_csv(const SweepTable& table);
struct SweepNotes;
std::string merge_report(const SweepTable& table, const SweepNotes& notes);

}  // namespace pliant
