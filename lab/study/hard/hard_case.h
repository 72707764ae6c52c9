// The hard cases: where haptic engines break, what must hold there, and by how much it does. One table, which `pliant
// study hardcases` prints and the tests walk, an entry each. The entries are those of docs/methods.md section 3, items
// 9 and 10; an entry that says two things has two rows.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace pliant {

// What a case may need.
struct HardSetting {
  std::filesystem::path corpus;  // of meshes; absent: what needs it is not judged
  bool brief = false;            // fewer and smaller files and meshes
};

// The worst of what a case has met, as one figure; infinite where something failed that has no size.
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
  // Of a figure that scatters: where it lies.
  void between(double low, double high) { low_ = low, high_ = high; }
  void looked_at(const std::string& what) { looked_at_ = what; }

  double value() const { return value_; }
  double low() const { return std::isnan(low_) ? value_ : low_; }
  double high() const { return std::isnan(high_) ? value_ : high_; }
  bool scatters() const { return !std::isnan(low_); }
  const std::string& where() const { return where_; }          // of the worst; or what is absent
  const std::string& looked_at() const { return looked_at_; }  // how much; empty: what must hold says it
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
  const char* entry;  // of docs/methods.md that asks for it: "methods.md 3.9: " and its name there
  const char* must;   // what must hold
  const char* unit;   // of the figure
  double bound;       // the figure is at most this
  HardFigure (*measure)(const HardSetting&);
  const char* defect = "";  // a known one, and why: the figure is above the bound
  bool timed = false;       // the figure is a time: it differs from run to run, and tests leave it
};

// Not judged: what it needs is absent, or the bound lies within what the figure scatters.
enum class HardVerdict : std::uint8_t { kYes, kNo, kNotJudged };
HardVerdict verdict_of(const HardCase& hard, const HardFigure& figure);

const std::vector<HardCase>& hard_cases();
// Its parts, in the table's order.
std::vector<HardCase> hard_numbers();   // numerics
std::vector<HardCase> hard_time();      // ticks that are missed, samples that are early, late or absent
std::vector<HardCase> hard_elements();  // tetrahedra
std::vector<HardCase> hard_places();    // geometry: vertices, edges, borders, creases
std::vector<HardCase> hard_meshes();    // geometry: meshes that are not sound, walls that are thin
std::vector<HardCase> hard_contacts();  // several probes; devices
std::vector<HardCase> hard_loops();     // closed loops
std::vector<HardCase> hard_surfaces();  // what a surface must feel like
std::vector<HardCase> hard_levels();    // levels and meshes, touched by the built-in orbit
std::vector<HardCase> hard_cost();      // what a tick and a query may cost

}  // namespace pliant
