// pliant sweep merge: combines the lines of all shards into tables, a report and plots.
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/files/output_folder.h"
#include "lab/study/pareto.h"
#include "lab/sweep/sweep.h"
#include "lab/sweep/sweep_notes.h"
#include "lab/sweep/sweep_plot.h"
#include "lab/sweep/table.h"

namespace pliant {
namespace {

void say_what_is_odd(const SweepTable& table, const SweepNotes& notes, std::size_t done, std::size_t plots) {
  for (const std::string& sentence : sentences_of(notes, table, true)) note(sentence);
  if (plots == 0 && done > 1) note("nothing is drawn: no figure differs between the runs");
  if (table.torn > 0)
    note(std::to_string(table.torn) +
         " lines were left out that a killed sweep wrote half of; their runs count as "
         "missing where nothing else has them");
  if (table.foreign > 0)
    note(std::to_string(table.foreign) + " runs were left out that the plan does not have (any more)");
  if (!table.disagree.empty())
    note(
        std::to_string(table.disagree.size()) +
        " runs were done more than once, with other figures; compare the machines or builds that did them (report.json "
        "has their ids)");
}

}  // namespace

int merge_sweep(const MergeOptions& options) {
  const std::vector<std::filesystem::path> folders(options.folders.begin(), options.folders.end());
  auto table = read_table(folders);
  if (!table) return fail(kFailed, table.error());
  const SweepNotes notes = find_notes(*table);
  const Interrupt interrupt(kAllOrNothing);  // removes staged files on interruption
  auto out = OutputFolder::create(options.out, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  for (const auto& [name, text] : {std::pair("results.csv", results_csv(*table)),
                                   {"timings.csv", timings_csv(*table)},
                                   {"report.json", merge_report(*table, notes)}})
    if (const Status ok = write_text(*out, name, text); !ok) return fail(kFailed, out->at_place(ok.error()));
  std::string left_out;
  const auto plots = plot_sweep(*table, *out, interrupt, left_out);
  if (!plots) return fail(kFailed, out->at_place(plots.error()));
  if (interrupt.requested()) return fail(kFailed, interrupted("merge"));
  if (const Status ok = out->commit(); !ok) return fail(kFailed, ok.error());
  std::size_t done = 0, failed = 0;
  for (const SweepRow& row : table->rows) {
    done += row.done();
    failed += !row.done() && !row.line.is_null();
  }
  say_what_is_odd(*table, notes, done, *plots);
  if (!left_out.empty()) note(left_out);
  print("{}: {} of {} runs done, {} failed, {} missing: results.csv, report.json, {} plots; timings.csv (measured)\n",
        out->shown().string(), done, table->rows.size(), failed, table->rows.size() - done - failed, *plots);
  if (out->moved()) print("({} has results already, which stay; --force replaces a merge's)\n", out->asked().string());
  return kDone;
}

}  // namespace pliant
