// The hard cases: where haptic engines break, what must hold there, and by how much it does. One table, which `pliant
// study hardcases` prints and the tests walk, an entry each. The entries are those of methods.md section 3 item 9 and
// of contact-energy.md section 4; an entry that says two things has two rows.
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
  bool brief = false;            // a part of the work, seconds instead of minutes
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

  double value() const { return value_; }
  const std::string& where() const { return where_; }  // of the worst; or what is absent
  bool is_measured() const { return value_ > -std::numeric_limits<double>::infinity(); }
  bool is_absent() const { return absent_; }

 private:
  double value_ = -std::numeric_limits<double>::infinity();
  std::string where_;
  bool absent_ = false;
};

struct HardCase {
  const char* name;   // of the row and of the test
  const char* entry;  // of the list that asks for it
  const char* must;   // what must hold
  const char* unit;   // of the figure
  double bound;       // the figure is at most this
  HardFigure (*measure)(const HardSetting&);
  const char* defect = "";  // a known one, and why: the figure is above the bound
  bool timed = false;       // the figure is a time: it differs from run to run, and tests leave it
};

enum class HardVerdict : std::uint8_t { kYes, kNo, kNotJudged };
HardVerdict verdict_of(const HardCase& hard, const HardFigure& figure);

const std::vector<HardCase>& hard_cases();
// Its parts, in the table's order.
std::vector<HardCase> hard_numbers();   // numerics
std::vector<HardCase> hard_elements();  // tetrahedra
std::vector<HardCase> hard_places();    // geometry
std::vector<HardCase> hard_contacts();  // several probes; devices
std::vector<HardCase> hard_surfaces();  // contact-energy.md section 4: what a surface must feel like
std::vector<HardCase> hard_loops();     // closed loops
std::vector<HardCase> hard_levels();    // levels and meshes, touched by the built-in orbit; cost

}  // namespace pliant
