#include "viewer/ui/units.h"

#include <fmt/format.h>

namespace pliant::ui {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct UnitRow {
  std::string_view name;
  double si;
  Dimension dimension;
  bool prefixes;
};
constexpr Dimension kLength{1, 0, 0, 0, 0, 0}, kMass{0, 1, 0, 0, 0, 0}, kTime{0, 0, 1, 0, 0, 0},
    kTurn{0, 0, 0, 1, 0, 0}, kForce{1, 1, -2, 0, 0, 0}, kPressure{-1, 1, -2, 0, 0, 0}, kRate{0, 0, -1, 0, 0, 0},
    kMoment{2, 1, -2, 0, 0, 0}, kPower{2, 1, -3, 0, 0, 0};
constexpr UnitRow kUnits[] = {{"m", 1.0, kLength, true},
                              {"g", 1e-3, kMass, true},
                              {"s", 1.0, kTime, true},
                              {"N", 1.0, kForce, true},
                              {"Pa", 1.0, kPressure, true},
                              {"Hz", 1.0, kRate, true},
                              {"J", 1.0, kMoment, true},
                              {"W", 1.0, kPower, true},
                              {"rad", 1.0, kTurn, true},
                              {"lx", 1.0, {0, 0, 0, 0, 1, 0}, true},
                              {"cd", 1.0, {0, 0, 0, 0, 0, 1}, true},
                              {"in", 0.0254, kLength, false},
                              {"inch", 0.0254, kLength, false},
                              {"ft", 0.3048, kLength, false},
                              {"l", 1e-3, {3, 0, 0, 0, 0, 0}, true},
                              {"t", 1e3, kMass, false},
                              {"lb", 0.45359237, kMass, false},
                              {"min", 60.0, kTime, false},
                              {"h", 3600.0, kTime, false},
                              {"bar", 1e5, kPressure, true},
                              {"mmHg", 133.322387415, kPressure, false},
                              {"psi", 6894.757293168, kPressure, false},
                              {"Nm", 1.0, kMoment, true},
                              {"Nmm", 1e-3, kMoment, true},
                              {"Ns", 1.0, {1, 1, -1, 0, 0, 0}, true},
                              {"deg", kPi / 180.0, kTurn, false},
                              {"\u00b0", kPi / 180.0, kTurn, false},
                              {"turn", 2.0 * kPi, kTurn, false},
                              {"rpm", 2.0 * kPi / 60.0, {0, 0, -1, 1, 0, 0}, false},
                              {"%", 1e-2, kNumber, false},
                              {"\u2030", 1e-3, kNumber, false},
                              {"\u00d7", 1.0, kNumber, false}};
struct Prefix {
  std::string_view name;
  double factor;
};
constexpr Prefix kPrefixes[] = {{"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6}, {"\u00b5", 1e-6}, {"\u03bc", 1e-6}, {"m", 1e-3},
                                {"c", 1e-2},  {"d", 1e-1}, {"h", 1e2},  {"k", 1e3},       {"M", 1e6},       {"G", 1e9}};

std::string lowered(std::string_view word) {
  std::string out(word);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view name) {
  for (const UnitRow& row : kUnits)
    if (name == row.name) return Unit{row.si, row.dimension};
  for (const Prefix& prefix : kPrefixes) {
    if (!name.starts_with(prefix.name)) continue;
    for (const UnitRow& row : kUnits)
      if (row.prefixes && name.substr(prefix.name.size()) == row.name)
        return Unit{prefix.factor * row.si, row.dimension};
  }
  return {};
}

std::string spelled(std::string_view name) {
  for (const UnitRow& row : kUnits) {
    if (lowered(row.name) == lowered(name)) return fmt::format("did you mean {}?", row.name);
    for (const Prefix& prefix : kPrefixes)
      if (row.prefixes && lowered(std::string(prefix.name) + std::string(row.name)) == lowered(name))
        return fmt::format("did you mean {}{}?", prefix.name, row.name);
  }
  return {};
}

}  // namespace pliant::ui
