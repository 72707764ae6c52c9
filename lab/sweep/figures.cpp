#include "lab/sweep/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "content/files/file_io.h"
#include "lab/files/csv.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

// [N] of each probe, in the order of the report. Rows are matched by position: every tick has a row per probe, and
// names may repeat.
std::vector<double> rms_forces(const fs::path& file, std::size_t probes) {
  std::ifstream in(file);
  std::string line;
  if (probes == 0 || !std::getline(in, line)) return {};
  std::vector<std::string> cells;
  csv_cells(line, ',', cells);
  const std::size_t columns = cells.size(), normal = csv_column(cells, "fn"), tangential = csv_column(cells, "ft");
  if (normal == kNoColumn || tangential == kNoColumn) return {};
  std::vector<double> sum(probes, 0.0);
  std::size_t row = 0;
  for (; std::getline(in, line); ++row) {
    csv_cells(line, ',', cells);
    if (cells.size() != columns) return {};
    for (const std::size_t column : {normal, tangential}) {
      const double force = std::strtod(cells[column].c_str(), nullptr);
      sum[row % probes] += force * force;
    }
  }
  if (row == 0 || row % probes != 0) return {};
  for (double& each : sum) each = std::sqrt(each / static_cast<double>(row / probes));
  return sum;
}

// Node names need not be unique.
std::string free_name(const PlanJson& figures, const std::string& name, const std::string& figure) {
  std::string key = name + "." + figure;
  for (int n = 2; figures.contains(key); ++n) key = name + "#" + std::to_string(n) + "." + figure;
  return key;
}

void add_probe(const PlanJson& probe, const double* rms, double rate, PlanJson& figures) {
  const std::string name = probe.value("name", std::string());
  const auto put = [&](const char* figure, const PlanJson& value) {
    figures[free_name(figures, name, figure)] = value;
  };
  // A tool's value is the offset of its device from its handle, not a depth.
  const bool tool = probe.contains("tool_force");
  if (probe.contains("max_depth_m")) put(tool ? "max_offset_m" : "max_depth_m", probe["max_depth_m"]);
  if (probe.contains("max_force_N")) put("max_force_N", probe["max_force_N"]);
  if (rms) put("rms_force_N", *rms);
  for (const char* figure :
       {"net_work_J", "contact_ticks", "max_torque_Nm", "late_ticks", "stale_ticks", "missed_by_m"})
    if (probe.contains(figure)) put(figure, probe[figure]);
  if (rate > 0.0 && probe.contains("contact_ticks")) put("contact_s", probe["contact_ticks"].get<double>() / rate);
  // The report lists limits that acted; a share is given only beside ticks.
  const auto put_limit = [&](const PlanJson& of, const std::string& limit, const std::string& name_of_it, bool always) {
    const PlanJson ticks = of.contains(limit) ? of[limit]["ticks"] : PlanJson(0);
    if (always || ticks != 0) put((name_of_it + "_ticks").c_str(), ticks);
    if (ticks != 0) put((name_of_it + "_share").c_str(), of[limit]["largest_share"]);
  };
  for (const std::string limit : {"clipped", "withheld", "gated", "slewed"}) {
    put_limit(probe, limit, limit, true);
    if (probe.contains("torque")) put_limit(probe["torque"], limit, "torque_" + limit, false);
  }
}

void add_soft(const PlanJson& soft, PlanJson& figures) {
  for (const char* figure : {"steps", "tetrahedra", "sweeps", "residual", "unconverged", "contacts_cut", "halted",
                             "halted_s", "deepest_m", "began_inside_m"})
    if (soft.contains(figure)) figures[std::string("soft.") + figure] = soft[figure];
  if (soft.contains("contacts"))
    for (const char* figure : {"mean", "max"})
      figures[std::string("soft.contacts_") + figure] = soft["contacts"][figure];
}

void add_times(const PlanJson& percentiles, const std::string& name, PlanJson& timing) {
  for (const char* which : {"p50", "p99", "max"})
    if (percentiles.contains(which)) timing[name + "_" + which] = percentiles[which];
}

}  // namespace

Result<RunResult> read_run(const fs::path& folder) {
  const auto bytes = read_file(folder / "report.json");
  if (!bytes) return bytes.error();
  const PlanJson report = PlanJson::parse(bytes->begin(), bytes->end(), nullptr, false);
  const std::string ended = report.is_object() ? report.value("ended", std::string()) : std::string();
  if (ended.empty()) return Error{"report.json", "is no report of a run", "check the space left", "disk.full"};
  if (ended == "interrupted") return Error{"", "interrupted by a signal", "do it again"};
  if (ended != "done") return Error{"", ended};
  RunResult result{PlanJson::object(), PlanJson::object(), PlanJson::array()};
  result.figures["hash"] = report["hash"];
  result.figures["ticks"] = report["ticks"];
  const PlanJson& probes = report["probes"];
  const std::vector<double> rms = rms_forces(folder / "forces.csv", probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i)
    add_probe(probes[i], i < rms.size() ? &rms[i] : nullptr, report.value("rate_hz", 0.0), result.figures);
  for (const PlanJson& object : report["objects"])
    for (const char* which : {"mean", "max"})
      result.figures[free_name(result.figures, object.value("name", std::string()),
                               std::string("awake_vertices_") + which)] = object["awake_vertices"][which];
  if (report.contains("soft")) add_soft(report["soft"], result.figures);
  add_times(report["tick_us"], "tick_us", result.timing);
  if (report.contains("soft")) add_times(report["soft"]["step_ms"], "soft_step_ms", result.timing);
  if (report.contains("soft") && report["soft"].value("time_lost_s", 0.0) > 0.0)
    result.timing["soft.time_lost_s"] = report["soft"]["time_lost_s"];
  if (report.contains("notes")) result.notes = report["notes"];
  return result;
}

}  // namespace pliant
