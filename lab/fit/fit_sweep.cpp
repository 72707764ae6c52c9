// pliant fit --sweep DIR --target CSV: finds the run of a sweep that comes nearest to measured presses. A sweep stores
// summary figures of its runs and no curves, so the figures are compared.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/files/csv.h"
#include "lab/files/output_folder.h"
#include "lab/fit/fit.h"
#include "lab/fit/press_record.h"
#include "lab/fit/sweep_nearest.h"
#include "lab/study/pareto.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string row_words(const SweepTable& table, const SweepRow& row) {
  std::string out;
  for (std::size_t a = 0; a < table.axes.size(); ++a)
    out += fmt::format("{}{} = {}", a ? ", " : "", table.axes[a].name, text_of(row.values[a]));
  return out;
}

}  // namespace

int fit_sweep(const FitOptions& options) {
  if (options.target.empty())
    return fail(kUsage, {"--sweep " + options.sweep, "name what was measured with --target CSV"});
  if (!options.out.empty())
    return fail(kUsage, {"-o " + options.out, "is not for --sweep: it says a setting and no level",
                         "use the setting with `pliant run --set`"});
  const Result<SweepTable> table = read_table({options.sweep});
  if (!table) return fail(kFailed, table.error());
  Result<PressRecord> target = read_press(options.target, options.probe, true);
  if (!target && !options.probe.empty())  // the option names the sweep's probe; measured data may have no probe column
    if (Result<PressRecord> plain = read_press(options.target, {}, true); plain) target = std::move(plain);
  if (!target) return fail(kFailed, target.error());
  const Result<Nearest> nearest = nearest_run(*table, *target, options.probe);
  if (!nearest) return fail(kFailed, nearest.error());
  const SweepRow& best = table->rows[nearest->order[0]];

  OrderedJson figures = OrderedJson::object();
  for (const auto& [name, value] : nearest->target) figures[name] = value;
  OrderedJson between = OrderedJson::array();
  for (const BetweenRuns& it : nearest->between)
    between.push_back({{"axis", table->axes[it.axis].name}, {"value", it.value}, {"distance", it.distance}});
  const OrderedJson report{{"sweep", options.sweep},  {"target", options.target},
                           {"probe", nearest->probe}, {"target_figures", figures},
                           {"nearest", best.id},      {"distance", nearest->distance[nearest->order[0]]},
                           {"between", between}};
  std::string csv = "id";
  for (const SweepAxis& axis : table->axes) csv += "," + csv_text(axis.name);
  csv += ",distance\n";
  for (const std::size_t row : nearest->order) {
    csv += table->rows[row].id;
    for (const PlanJson& value : table->rows[row].values) csv += "," + csv_text(text_of(value));
    put(csv, nearest->distance[row]);
    csv += "\n";
  }
  const Interrupt interrupt(kAllOrNothing);  // removes staged files on interruption
  auto out = OutputFolder::create(options.report.empty() ? "out/fit" : options.report, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  Status done = write_text(*out, "fit.json", report.dump(2, ' ', true, OrderedJson::error_handler_t::replace) + "\n");
  if (done) done = write_text(*out, "fit_runs.csv", csv);
  if (done && interrupt.requested()) done = interrupted("fit");
  if (done) done = out->commit();
  if (!done) return fail(kFailed, out->at_place(done.error()));
  print("{}: {} of {} runs compared by {} figures of `{}`\n", options.sweep, nearest->order.size(), table->rows.size(),
        nearest->target.size(), nearest->probe);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, nearest->order.size()); ++i)
    print("  {:.2f} % off: {} ({})\n", 100 * nearest->distance[nearest->order[i]],
          row_words(*table, table->rows[nearest->order[i]]), table->rows[nearest->order[i]].id);
  for (const BetweenRuns& it : nearest->between)
    print(
        "  between runs: {} = {:.6g}, about {:.2f} % off (a parabola through three runs: check it with one of its "
        "own)\n",
        table->axes[it.axis].name, it.value, 100 * it.distance);
  for (const std::string& sentence : nearest->notes) note(sentence);
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces them)" : "");
  return kDone;
}

}  // namespace pliant
