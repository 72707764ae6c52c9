// The hard cases: situations that break haptic engines, the condition that must hold, and its margin. One table,
// printed by `pliant study hardcases` and tested entry by entry. The entries are those of docs/methods.md section 3,
// items 9 and 10; an entry with two conditions has two rows.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace pliant {

// Inputs of a case.
struct HardSetting {
  std::filesystem::path corpus;  // of meshes; absent: cases that need it are not judged
  bool brief = false;            // fewer and smaller files and meshes
};

// The worst result of a case as one figure; infinite for a failure without magnitude.
class HardFigure {
 public:
  void add(double value, const std::string& where = {}) {
    if (value <= value_ && !std::isnan(value)) return;
    value_ = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    where_ = where;
  }
  void need(bool holds, const std::string& what) {
    if (!holds) add(std::numeric_limits<double>::infinity(), what);
  }
  void absent(const std::string& what) { absent_ = true, where_ = what; }
  // The interval of a figure that scatters.
  void between(double low, double high) { low_ = low, high_ = high; }
  void looked_at(const std::string& what) { looked_at_ = what; }

  double value() const { return value_; }
  double low() const { return std::isnan(low_) ? value_ : low_; }
  double high() const { return std::isnan(high_) ? value_ : high_; }
  bool scatters() const { return !std::isnan(low_); }
  const std::string& where() const { return where_; }          // place of the worst; or what is absent
  const std::string& looked_at() const { return looked_at_; }  // amount of data; empty: see `must`
  bool is_measured() const { return value_ > -std::numeric_limits<double>::infinity(); }
  bool is_absent() const { return absent_; }

 private:
  double value_ = -std::numeric_limits<double>::infinity();
  double low_ = std::numeric_limits<double>::quiet_NaN(), high_ = low_;
  std::string where_, looked_at_;
  bool absent_ = false;
};

struct HardCase {
  const char* name;   // of the row and of the test
  const char* entry;  // entry of docs/methods.md: "methods.md 3.9: " and its name there
  const char* must;   // what must hold
  const char* unit;   // of the figure
  double bound;       // largest allowed figure
  HardFigure (*measure)(const HardSetting&);
  const char* defect = "";  // a known defect and its reason: the figure is above the bound
  bool timed = false;       // the figure is a time: it varies between runs, and tests skip it
};

// Not judged: an input is absent, or the bound lies within the figure's scatter.
enum class HardVerdict : std::uint8_t { kYes, kNo, kNotJudged };
HardVerdict verdict_of(const HardCase& hard, const HardFigure& figure);

const std::vector<HardCase>& hard_cases();
// Parts of the table, in order.
std::vector<HardCase> hard_numbers();   // numerics
std::vector<HardCase> hard_time();      // missed ticks; samples that are early, late or absent
std::vector<HardCase> hard_elements();  // tetrahedra
std::vector<HardCase> hard_places();    // geometry: vertices, edges, borders, creases
std::vector<HardCase> hard_meshes();    // geometry: defective meshes, thin walls
std::vector<HardCase> hard_contacts();  // several probes; devices
std::vector<HardCase> hard_loops();     // closed loops
std::vector<HardCase> hard_surfaces();  // required feel of a surface
std::vector<HardCase> hard_levels();    // levels and meshes, touched by the built-in orbit
std::vector<HardCase> hard_cost();      // cost limits of a tick and a query

}  // namespace pliant
