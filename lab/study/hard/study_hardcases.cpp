#include "lab/study/hard/study_hardcases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/csv.h"
#include "lab/study/corpus_folder.h"
#include "lab/study/pareto.h"
#include "lab/study/studies.h"

namespace pliant {
namespace {

std::string shown(double figure) {
  return std::isfinite(figure) ? fmt::format("{:.3g}", figure) : "failed";
}

// The figure, with its interval if it scatters.
std::string shown(const HardFigure& figure) {
  if (figure.is_absent()) return "-";
  if (!figure.scatters()) return shown(figure.value());
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", figure.value(), figure.low(), figure.high());
}

// The figure and its bound, for a case that fails or cannot be judged.
std::string with_bound(const JudgedCase& each) {
  return fmt::format("{} ({} {}, at most {:g})", words_of(each.hard.name), shown(each.figure), each.hard.unit,
                     each.hard.bound);
}

void list(std::string& words, const std::string& item) {
  words += (words.empty() ? "" : "; ") + item;
}

nlohmann::ordered_json to_json(const std::vector<JudgedCase>& cases, const std::vector<std::string>& sentences) {
  nlohmann::ordered_json json;
  json["study"] = "hardcases";
  for (const JudgedCase& each : cases) {
    nlohmann::ordered_json row{{"case", each.hard.name},      {"entry", each.hard.entry},
                               {"must_hold", each.hard.must}, {"verdict", name_of(each.verdict())},
                               {"figure", nullptr},           {"bound", each.hard.bound},
                               {"unit", each.hard.unit},      {"where", each.figure.where()}};
    if (std::isfinite(each.figure.value())) row["figure"] = each.figure.value();
    if (each.figure.scatters()) row["interval"] = {each.figure.low(), each.figure.high()};
    if (!each.figure.looked_at().empty()) row["looked_at"] = each.figure.looked_at();
    if (*each.hard.defect) row["known_defect"] = each.hard.defect;
    if (each.hard.timed) row["timed"] = true;
    json["cases"].push_back(std::move(row));
  }
  json["shows"] = sentences;
  return json;
}

}  // namespace

const char* name_of(HardVerdict verdict) {
  constexpr const char* kNames[] = {"yes", "no", "not judged"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::string words_of(const std::string& name) {
  std::string words;
  for (const char c : name) {
    if (std::isupper(static_cast<unsigned char>(c)) && !words.empty()) words += ' ';
    words += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return words;
}

std::string to_csv(const std::vector<JudgedCase>& cases) {
  const auto nine = [](double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(); };
  std::string csv = "entry,case,must_hold,verdict,figure,low,high,bound,unit,where,looked_at,known_defect\n";
  for (const JudgedCase& each : cases) {
    const HardFigure& figure = each.figure;
    csv += fmt::format("{},{},{},{},{},{},{},{:g},{},{},{},{}\n", csv_text(each.hard.entry), each.hard.name,
                       csv_text(each.hard.must), name_of(each.verdict()), nine(figure.value()),
                       figure.scatters() ? nine(figure.low()) : "", figure.scatters() ? nine(figure.high()) : "",
                       each.hard.bound, csv_text(each.hard.unit), csv_text(figure.where()),
                       csv_text(figure.looked_at()), csv_text(each.hard.defect));
  }
  return csv;
}

std::vector<std::string> sentences_of(const std::vector<JudgedCase>& cases) {
  std::size_t yes = 0, absent = 0;
  std::string failing, undecided, nearest;
  double share = -1.0;
  for (const JudgedCase& each : cases) {
    const HardVerdict verdict = each.verdict();
    yes += verdict == HardVerdict::kYes;
    absent += each.figure.is_absent();
    if (verdict == HardVerdict::kNo) list(failing, with_bound(each));
    if (verdict == HardVerdict::kNotJudged && !each.figure.is_absent()) list(undecided, with_bound(each));
    // A bound of one has no meaningful margin.
    if (verdict != HardVerdict::kYes || !(each.hard.bound > 0.0) || std::abs(each.hard.bound - 1.0) < 1e-6) continue;
    if (each.figure.value() / each.hard.bound > share) {
      share = each.figure.value() / each.hard.bound;
      nearest = words_of(each.hard.name);
    }
  }
  std::string first = fmt::format("{} of {} hard cases hold", yes, cases.size());
  if (absent > 0) first += fmt::format("; {} were not judged because what they need is absent", absent);
  if (!undecided.empty()) first += "; the bound lies within what the figure scatters of: " + undecided;
  if (!failing.empty()) first += "; these do not: " + failing;
  return {first + ".", share < 0.0 ? "Of those that hold, none has a bound that its figure could come near to."
                                   : fmt::format("The nearest to its bound of those that hold: {}, at {:.0f} % of it.",
                                                 nearest, 100 * share)};
}

Status study_hardcases(OutputFolder& out, StudySize size, const Interrupt& interrupt) {
  Progress progress("study hardcases");
  const HardSetting setting{corpus_folder(), size != StudySize::kFull};
  std::vector<JudgedCase> cases;
  for (const HardCase& hard : hard_cases()) {
    if (interrupt.requested()) return interrupted();
    cases.push_back({hard, hard.measure(setting)});
    progress.update(static_cast<double>(cases.size()) / static_cast<double>(hard_cases().size()));
  }
  const std::vector<std::string> sentences = sentences_of(cases);
  for (const JudgedCase& each : cases)
    print("{:>10}  {:>9}, at most {:<6g} {:<26} {}\n", name_of(each.verdict()), shown(each.figure), each.hard.bound,
          each.hard.unit, words_of(each.hard.name));
  for (const std::string& sentence : sentences) print("hardcases: {}\n", sentence);
  if (const Status done = write_text(out, "hardcases.csv", to_csv(cases)); !done) return done;
  if (const Status done = write_text(out, "hardcases.json", to_json(cases, sentences).dump(2, ' ', true) + "\n"); !done)
    return done;
  return plot_hardcases(out, cases, sentences);
}

}  // namespace pliant
