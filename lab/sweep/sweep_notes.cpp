#include "lab/sweep/sweep_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr const char* kUntouched = "run.untouched";  // code of a probe or tool without contact
constexpr std::size_t kNamedNotes = 12;              // most notes printed; the report has all

// A limit: its figure, and the codes of a run's notes about it.
struct LimitKind {
  const char *key, *figure;  // figure: of the soft clock if it begins with "soft.", else a suffix
  const char *what, *cure;
  const char *code, *of_torque = "";
};
constexpr LimitKind kLimits[] = {
    {"clipped", "clipped_ticks", "a force was clipped", "raise max_force or max_torque where the device can render it",
     "force.clipped", "torque.clipped"},
    {"withheld", "withheld_ticks", "a force was damped, because the hand would have got more energy than it gave",
     "raise --rate, or refine and smooth the mesh where it is touched", "force.withheld", "torque.withheld"},
    {"gated", "gated_ticks", "no force was sent until the safety gate opened", "start outside the object",
     "force.gated", "torque.gated"},
    {"slewed", "slewed_ticks", "a force changed faster than max_slew or max_stiffness let it",
     "move slower, or raise them where the device can render it", "force.slewed", "torque.slewed"},
    {"late", "late_ticks", "a tool's contacts were not solved within the budget of a tick",
     "lower --rate, or use --tool-force linear", "tool.late"},
    {"stale", "stale_ticks", "a tool's force faded, because its model was older than three soft steps",
     "lower --rate, make `cell` larger, or make soft_step longer", "tool.stale"},
    {"contacts_cut", "soft.contacts_cut", "contacts were dropped because a soft step was full",
     "press with a smaller area, or coarsen the meshes in contact", "soft.contacts_cut"},
    {"halted", "soft.halted_s", "bodies were stopped, because they would have passed through each other",
     "make soft_step shorter, or press more slowly", "soft.halted"},
    {"unconverged", "soft.unconverged", "soft steps ended unconverged",
     "make soft_step shorter, or give bodies in contact more similar masses and stiffnesses", "soft.unconverged"},
    {"began_inside", "soft.began_inside_m", "bodies began inside each other", "move one of them in the level",
     "soft.began_inside"},
    {"time_lost", "soft.time_lost_s", "the soft clock did not keep up", "make `cell` larger or soft_step longer",
     "soft.time_lost"},
};

double number_in(const PlanJson& figures, const std::string& name) {
  return figures.contains(name) && figures[name].is_number() ? figures[name].get<double>() : 0.0;
}

bool is_figure_of(const LimitKind& kind, const std::string& name) {
  const std::string figure = kind.figure;
  if (figure.starts_with("soft.")) return name == figure;
  return name.ends_with("." + figure) || name.ends_with(".torque_" + figure);
}

// Severity in a run: the share if there is one, else the figure itself.
std::pair<double, std::string> severity(const PlanJson& figures, const std::string& name) {
  constexpr std::string_view kTicks = "_ticks";
  if (name.ends_with(kTicks)) {
    const std::string share = name.substr(0, name.size() - kTicks.size()) + "_share";
    if (figures.contains(share)) return {number_in(figures, share), share};
  }
  return {number_in(figures, name), name};
}

void find_limits(const SweepTable& table, SweepNotes& out) {
  for (const LimitKind& kind : kLimits) {
    SweepLimit limit{kind.key, kind.what, kind.cure, 0, 0.0, {}, 0};
    std::vector<std::pair<const char*, const std::string*>> names;  // its names in a line
    for (const std::string& name : table.figures)
      if (is_figure_of(kind, name)) names.emplace_back("figures", &name);
    for (const std::string& name : table.timings)
      if (is_figure_of(kind, name)) names.emplace_back("timing", &name);
    for (std::size_t row = 0; row < table.rows.size() && !names.empty(); ++row) {
      if (!table.rows[row].done()) continue;
      bool acted = false;
      for (const auto& [part, name] : names) {
        const PlanJson& figures = table.rows[row].line[part];
        if (!(number_in(figures, *name) > 0.0)) continue;
        // Creep below this is invisible, and the run does not report it either.
        if (kind.key == std::string_view("unconverged") && number_in(figures, "soft.residual") < 1e-4) continue;
        acted = true;
        const auto [worst, figure] = severity(figures, *name);
        if (limit.figure.empty() || worst > limit.worst) limit.worst = worst, limit.figure = figure, limit.row = row;
      }
      limit.runs += acted;
    }
    if (limit.runs > 0) out.limits.push_back(std::move(limit));
  }
}

bool is_limit(const std::string& code) {
  return !code.empty() && std::any_of(std::begin(kLimits), std::end(kLimits), [&](const LimitKind& kind) {
    return code == kind.code || code == kind.of_torque;
  });
}

// A sentence with '#' for its numbers, which differ between runs.
std::string without_numbers(const std::string& sentence) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string out;
  for (std::size_t i = 0; i < sentence.size();) {
    if (!digit(sentence[i])) {
      out += sentence[i++];
      continue;
    }
    const std::size_t end = std::min(sentence.find_first_not_of("0123456789.,e+-", i), sentence.size());
    std::size_t last = end;
    while (!digit(sentence[last - 1])) --last;  // what follows a number is punctuation
    out += '#';
    i = last;
  }
  return out;
}

void find_other_notes(const SweepTable& table, SweepNotes& out) {
  std::map<std::array<std::string, 3>, std::size_t> known;  // code, of, sentence -> index in out.notes
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (!table.rows[row].done()) continue;
    std::vector<std::size_t> here;
    for (Note& note : notes_of(table.rows[row].line)) {
      if (is_limit(note.code)) continue;
      // A note without a code is another one wherever its sentence is, one with a code where its words are.
      const std::array key{note.code, note.of, note.code.empty() ? note.message() : without_numbers(note.message())};
      const auto [place, is_new] = known.try_emplace(key, out.notes.size());
      if (is_new) out.notes.push_back({std::move(note), 0, row});
      if (std::find(here.begin(), here.end(), place->second) != here.end()) continue;
      here.push_back(place->second);
      ++out.notes[place->second].runs;
    }
  }
  // Runs without contact are counted separately.
  std::erase_if(out.notes,
                [&](const SweepNote& each) { return each.runs <= out.untouched && each.note.code == kUntouched; });
  std::stable_sort(out.notes.begin(), out.notes.end(),
                   [](const SweepNote& a, const SweepNote& b) { return a.runs > b.runs; });
}

// True if runs that differ in this axis alone have equal figures up to rounding; false if no two runs can be compared.
bool is_idle(const SweepTable& table, std::size_t axis, const std::vector<std::vector<double>>& figures) {
  std::unordered_map<std::string, std::size_t> first;  // values of all other axes -> row
  bool compared = false;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (!table.rows[row].done()) continue;
    std::string others;
    for (std::size_t a = 0; a < table.axes.size(); ++a)
      if (a != axis) others += table.rows[row].values[a].dump() + '\n';
    const auto [place, is_new] = first.try_emplace(std::move(others), row);
    if (is_new || table.rows[row].values[axis] == table.rows[place->second].values[axis]) continue;
    compared = true;
    for (const std::vector<double>& figure : figures) {
      const double a = figure[place->second], b = figure[row];
      if (std::isnan(a) != std::isnan(b)) return false;
      if (!std::isnan(a) && a != b && !is_flat(std::min(a, b), std::max(a, b))) return false;
    }
  }
  return compared;
}

void find_idle_axes(const SweepTable& table, SweepNotes& out) {
  std::vector<std::vector<double>> figures;
  for (const std::string& name : table.figures) {
    std::vector<double>& of_row = figures.emplace_back();
    for (const SweepRow& row : table.rows) {
      const bool has = row.done() && row.line["figures"].contains(name) && row.line["figures"][name].is_number();
      of_row.push_back(has ? row.line["figures"][name].get<double>() : std::nan(""));
    }
  }
  for (std::size_t a = 0; a < table.axes.size(); ++a)
    if (!table.axes[a].sampled && is_idle(table, a, figures)) out.idle_axes.push_back(table.axes[a].name);
}

std::string run_words(const SweepTable& table, std::size_t row) {
  std::string words = "run " + table.rows[row].id;
  for (std::size_t a = 0; a < table.axes.size(); ++a)
    words += (a ? ", " : ": ") + table.axes[a].name + " = " + brief(table.rows[row].values[a]);
  return words;
}

std::string worst_words(const SweepLimit& limit) {
  const auto ends = [&](const char* end) { return limit.figure.ends_with(end); };
  if (ends("_share")) return fmt::format("at most {:.3g} % of it was missing", 100 * limit.worst);
  if (ends("_ticks")) return fmt::format("in at most {:g} ticks", limit.worst);
  if (ends("_m")) return fmt::format("by at most {:.3g} mm", 1e3 * limit.worst);
  if (ends("_s")) return fmt::format("for at most {:.3g} s", limit.worst);
  return fmt::format("at most {:g}", limit.worst);
}

}  // namespace

SweepNotes find_notes(const SweepTable& table) {
  SweepNotes out;
  for (const SweepRow& row : table.rows) out.done += row.done();
  out.untouched = untouched(table);
  find_limits(table, out);
  find_other_notes(table, out);
  find_idle_axes(table, out);
  return out;
}

std::vector<std::string> sentences_of(const SweepNotes& notes, const SweepTable& table, bool whole) {
  std::vector<std::string> out;
  const auto in_runs = [&](std::size_t runs) {
    return fmt::format("in {} of {} run{}", runs, notes.done, notes.done == 1 ? "" : "s");
  };
  if (notes.untouched > 0)
    out.push_back(in_runs(notes.untouched) +
                  " no probe touched anything: missed_by_m in results.csv says by how much; make runs longer, or lead "
                  "the probes farther");
  for (const SweepLimit& limit : notes.limits)
    out.push_back(fmt::format("{} {} ({}: {}); {}", in_runs(limit.runs), limit.what, worst_words(limit),
                              run_words(table, limit.row), limit.cure));
  for (std::size_t i = 0; i < std::min(notes.notes.size(), kNamedNotes); ++i)
    out.push_back(in_runs(notes.notes[i].runs) + ": " + notes.notes[i].note.message());
  if (notes.notes.size() > kNamedNotes)
    out.push_back(
        fmt::format("the runs have {} more notes; report.json of a merge has them", notes.notes.size() - kNamedNotes));
  if (whole && !notes.idle_axes.empty())
    out.push_back(
        fmt::format("nothing changes along {}: no figure differs there by more than rounding; give it a "
                    "wider range, or leave it out of the plan",
                    fmt::join(notes.idle_axes, ", ")));
  return out;
}

void add_notes(const SweepNotes& notes, const SweepTable& table, PlanJson& report) {
  report["untouched"] = notes.untouched;
  report["clipped"] = 0;
  report["limits"] = PlanJson::object();
  for (const SweepLimit& limit : notes.limits) {
    if (limit.key == "clipped") report["clipped"] = limit.runs;
    report["limits"][limit.key] = {
        {"runs", limit.runs}, {"worst", limit.worst}, {"figure", limit.figure}, {"id", table.rows[limit.row].id}};
  }
  report["notes"] = PlanJson::array();
  for (const SweepNote& each : notes.notes) {
    report["notes"].push_back(
        {{"sentence", each.note.message()}, {"runs", each.runs}, {"id", table.rows[each.row].id}});
    if (!each.note.code.empty()) report["notes"].back()["code"] = each.note.code;
    if (!each.note.of.empty()) report["notes"].back()["of"] = each.note.of;
  }
  report["idle_axes"] = notes.idle_axes;
}

}  // namespace pliant
