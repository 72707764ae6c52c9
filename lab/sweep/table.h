// The runs of a sweep with their results, in the order of the plan: input of tables and plots.
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
  PlanJson sweep;               // sweep.json without the runs
  std::vector<SweepAxis> axes;  // sampled axes have no values
  std::vector<SweepRow> rows;
  std::vector<std::string> figures;  // names, in order of first appearance
  std::vector<std::string> timings;
  std::vector<std::string> disagree;  // ids
  std::size_t torn = 0, foreign = 0;  // malformed lines; lines of runs that are not in the plan
};

// Number of completed runs that have probes but no contact.
std::size_t untouched(const SweepTable& table);

// Reads all folders, which must belong to one plan.
Result<SweepTable> read_table(const std::vector<std::filesystem::path>& folders);

std::string results_csv(const SweepTable& table);
std::string timings_csv(const SweepTable& table);
struct SweepNotes;
std::string merge_report(const SweepTable& table, const SweepNotes& notes);

}  // namespace pliant
