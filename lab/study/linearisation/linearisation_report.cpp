#include "lab/study/linearisation/linearisation_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "lab/console/print.h"

namespace pliant {
namespace {

constexpr const char* kMethodLabels[] = {"held", "linear model", "contacts solved again", "full solve: the truth"};

std::vector<std::string> sentences_of(const std::vector<LinearisationFigures>& all) {
  std::string first = "Off by, of what is felt:", second = "The soft step's own force, at its own instants, is off by";
  for (const LinearisationFigures& f : all) {
    first += fmt::format("{} at {:g} x its pace the held force {} %, the linear model {} %, contacts solved again {} %",
                         first.ends_with(':') ? "" : ";", f.pace, two_digits(100 * f.methods[0].rms_share),
                         two_digits(100 * f.methods[1].rms_share), two_digits(100 * f.methods[2].rms_share));
    second += fmt::format("{} {:.2g} % at {:g} x", second.ends_with("by") ? "" : ",", 100 * f.step_share, f.pace);
  }
  const LinearisationFigures& brisk = all.front();
  second += fmt::format(
      ", which no model undoes; a tick takes {} us with the linear model, {} us with contacts solved again (p99 {}) "
      "and "
      "{} us with the full solve.",
      two_digits(brisk.methods[1].p50_us), two_digits(brisk.methods[2].p50_us), two_digits(brisk.methods[2].p99_us),
      two_digits(brisk.methods[3].p50_us));
  return {first + ".", second};
}

}  // namespace

nlohmann::ordered_json linearisation_json(const LinearisationFigures& figures) {
  nlohmann::ordered_json json;
  json["level"] = figures.level;
  json["pace"] = figures.pace;
  json["seconds"] = figures.seconds;
  json["soft_step_s"] = figures.soft_step;
  json["tick_s"] = figures.tick;
  json["model_age_s"] = {figures.soft_step, 2.0 * figures.soft_step};
  json["tetrahedra"] = figures.tetrahedra;
  json["most_contacts"] = figures.contacts;
  json["most_modes"] = figures.modes;
  json["felt_rms_N"] = figures.rms_N;
  json["felt_max_N"] = figures.max_N;
  json["soft_step_rms_share"] = figures.step_share;
  for (const MethodFigures& m : figures.methods)
    json["methods"].push_back({{"name", m.name},
                               {"rms_error_N", m.rms_N},
                               {"max_error_N", m.max_N},
                               {"rms_share", m.rms_share},
                               {"cost_us", {{"p50", m.p50_us}, {"p99", m.p99_us}, {"max", m.max_us}}}});
  json["tool_feedback_us"] = {
      {"p50", figures.touch_p50_us}, {"p99", figures.touch_p99_us}, {"max", figures.touch_max_us}};
  json["jump_over_slope"] = figures.jump_share;
  json["updates"] = figures.updates;
  json["updates_over_twice_the_slope"] = figures.jumps;
  json["of_these_contacts_changed"] = figures.jumps_of_contacts;
  return json;
}

std::string linearisation_csv(const LinearisationFigures& figures) {
  std::string csv = "time_s";
  for (const char* name : {"full", "held", "linear", "contacts"})
    for (const char* part : {"fx", "fy", "fz", "tx", "ty", "tz"}) csv += fmt::format(",{}_{}", name, part);
  csv += '\n';
  for (const ForceSample& s : figures.samples) {
    csv += fmt::format("{:.6f}", s.time);
    for (const Vector6* v : {&s.full, &s.held, &s.linear, &s.contacts})
      for (int k = 0; k < 6; ++k) csv += fmt::format(",{:.5g}", (*v)[k]);
    csv += '\n';
  }
  return csv;
}

void print_linearisation(const LinearisationFigures& figures) {
  print(
      "{} at {:g} x its pace, {:.1f} s: felt beyond the weight RMS {:.3f} N, max {:.3f} N; tool_feedback p50 {:.1f}, "
      "p99 {:.1f}, max {:.1f} us\n"
      "  largest force jump at a model update: {:.2f} x the change between ticks around it; above 2 x in {} of {} "
      "updates, {} of them with a change of contact state\n",
      figures.level, figures.pace, figures.seconds, figures.rms_N, figures.max_N, figures.touch_p50_us,
      figures.touch_p99_us, figures.touch_max_us, figures.jump_share, figures.jumps, figures.updates,
      figures.jumps_of_contacts);
}

ParetoTable linearisation_table(const std::vector<LinearisationFigures>& all) {
  ParetoTable table;
  table.study = "linearisation";
  table.title = fmt::format(
      "the 1 kHz force on a tool of {} tetrahedra, level {}, scripts at several paces: models of soft steps of {:.0f} "
      "ms, one step late, against the full solve at 1 kHz",
      all[0].tetrahedra, all[0].level, all[0].soft_step * 1e3);
  table.cost_name = "cost_us";
  table.cost_axis = "cost [us of processor time a tick, median; a held force: what the clock resolves]";
  table.error_name = "rms_share";
  table.error_axis = "RMS error of the force, of what is felt beyond the weight [1]";
  table.more = {"pace", "rms_error_N", "max_error_N", "p99_us", "max_us"};
  table.front_by_group = true;
  for (const LinearisationFigures& figures : all)
    for (std::size_t i = 0; i < figures.methods.size(); ++i) {
      const MethodFigures& m = figures.methods[i];
      table.rows.push_back({kMethodLabels[i],
                            std::max(1e-3, m.p50_us),
                            m.rms_share,
                            fmt::format("{:g} x its pace", figures.pace),
                            {figures.pace, m.rms_N, m.max_N, m.p99_us, m.max_us}});
    }
  table.sentences = sentences_of(all);
  return table;
}

}  // namespace pliant
