#include "editor/ui/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace pliant::ui {
namespace {

// Exponents of metre, kilogram, second, radian, lux, candela.
using Dimension = std::array<int, 6>;
constexpr Dimension kNumber{0, 0, 0, 0, 0, 0};
constexpr int kAngle = 3, kMostExponent = 12, kDeepest = 32;
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

struct Unit {
  double si = 1.0;
  Dimension dimension = kNumber;
};

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

std::string lowered(std::string_view word) {
  std::string out(word);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// "did you mean kPa?" of "KPA".
std::string spelled(std::string_view name) {
  for (const UnitRow& row : kUnits) {
    if (lowered(row.name) == lowered(name)) return fmt::format("did you mean {}?", row.name);
    for (const Prefix& prefix : kPrefixes)
      if (row.prefixes && lowered(std::string(prefix.name) + std::string(row.name)) == lowered(name))
        return fmt::format("did you mean {}{}?", prefix.name, row.name);
  }
  return {};
}

// A value in SI, and whether it contains a unit.
struct Quantity {
  double value = 0.0;
  Dimension dimension = kNumber;
  bool has_unit = false;
};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}

// One interpretation of a text. `tight`: a unit belongs to the number before it ("1 N / 2 mm" is half a newton per
// millimetre). Otherwise evaluation is left to right ("1/10 mm" is a tenth of one).
class Reading {
 public:
  Reading(std::string_view text, bool tight) : text_(text), tight_(tight) {}

  Result<Quantity> read() {
    const Quantity out = sum();
    blanks();
    if (wrong_.what.empty() && at_ < text_.size()) fail_here();
    if (wrong_.what.empty() && !std::isfinite(out.value)) fail("is no finite number", "divide by something else");
    if (!wrong_.what.empty()) return wrong_;
    return out;
  }

 private:
  void fail(const std::string& why, const std::string& cure) {
    if (wrong_.what.empty()) wrong_ = {"", why, cure};
    at_ = text_.size();
  }
  void fail_two() { fail("has two numbers side by side", "write one, or +, -, * or / between them"); }
  void fail_here() {
    if (is_digit(text_[at_])) return fail_two();
    fail(fmt::format("cannot be read from '{}' on", text_.substr(at_, 20)),
         "write a number and its unit, 5 mm, or a sum, 1/10");
  }
  void blanks() {
    for (;;) {
      if (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t'))
        ++at_;
      else if (text_.substr(at_).starts_with("\u00a0"))
        at_ += 2;
      else
        return;
    }
  }
  bool take(std::string_view word) {
    blanks();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  Quantity sum() {
    Quantity left = product();
    for (;;) {
      const bool plus = take("+"), minus = !plus && (take("-") || take("\u2212"));
      if (!plus && !minus) return left;
      const Quantity right = product();
      if (!wrong_.what.empty()) return left;
      if (left.has_unit != right.has_unit)
        fail("adds a number with a unit and one without", "give both a unit");
      else if (left.dimension != right.dimension)
        fail("adds two things of different kinds", "write units of the same kind");
      left.value += plus ? right.value : -right.value;
    }
  }

  Quantity product() {
    Quantity left = factor();
    for (;;) {
      blanks();
      const bool times = take("*") || take("\u00b7") || take("\u22c5"), over = !times && take("/");
      if (times || over) {
        left = multiplied(left, factor(), over);
        continue;
      }
      // Implicit multiplication: a unit follows, or a bracket after one.
      if (at_ < text_.size() && wrong_.what.empty() && is_letter(text_[at_])) {
        left = multiplied(left, unit(), false);
        continue;
      }
      return left;
    }
  }

  Quantity factor() {
    if (++depth_ > kDeepest) fail("is nested too deeply", "write fewer signs and brackets");
    Quantity out;
    if (!wrong_.what.empty()) return out;
    if (take("+")) {
      out = factor();
    } else if (take("-") || take("\u2212")) {
      out = factor();
      out.value = -out.value;
    } else if (take("(")) {
      out = sum();
      if (wrong_.what.empty() && !take(")")) fail("lacks a closing bracket", "write it");
      out = with_units(raised(out));
    } else {
      blanks();
      if (at_ >= text_.size()) {
        fail("ends too early", "write a number behind the last sign");
      } else if (is_digit(text_[at_]) || text_[at_] == '.' || text_[at_] == ',') {
        out.value = number();
        out = with_units(raised(out));
      } else if (is_letter(text_[at_])) {
        out = unit();
      } else {
        fail_here();
      }
    }
    --depth_;
    return out;
  }

  // In the tight interpretation, the units directly after a number: "5 N mm" too.
  Quantity with_units(Quantity out) {
    if (!tight_) return out;
    for (blanks(); wrong_.what.empty() && at_ < text_.size() && is_letter(text_[at_]); blanks())
      out = multiplied(out, unit(), false);
    return out;
  }

  double number() {
    const std::size_t begin = at_;
    std::string digits;
    std::size_t marks = 0, before = 0, behind = 0;
    bool comma = false;
    for (; at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.' || text_[at_] == ','); ++at_) {
      const bool mark = !is_digit(text_[at_]);
      marks += mark;
      comma |= text_[at_] == ',';
      (marks == 0 ? before : behind) += !mark;
      digits += mark ? '.' : text_[at_];
    }
    const std::string_view typed = text_.substr(begin, at_ - begin);
    if (marks > 1) {
      fail(fmt::format("has the number {}, which can be read in two ways", typed),
           "write one point and no other sign in it");
      return 0;
    }
    if (before + behind == 0) {
      fail("has a point without digits", "write a number");
      return 0;
    }
    // Ambiguous: a thousands separator, or a decimal comma with three digits?
    if (comma && behind == 3 && before >= 1 && before <= 3 && typed[0] != '0') {
      fail(fmt::format("can be {}{} or {}.{}", typed.substr(0, before), typed.substr(before + 1),
                       typed.substr(0, before), typed.substr(before + 1)),
           "write one of them");
      return 0;
    }
    // An exponent only if digits follow: "1e-3", but not "5 eV" or "2e".
    std::size_t end = at_;
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t k = end + 1;
      if (k < text_.size() && (text_[k] == '+' || text_[k] == '-')) ++k;
      if (k < text_.size() && is_digit(text_[k])) {
        while (k < text_.size() && is_digit(text_[k])) ++k;
        digits += text_.substr(end, k - end);
        at_ = k;
      }
    }
    double value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value))
      fail("is too large or too small for a number", "write another");
    return value;
  }

  Quantity unit() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_letter(text_[at_])) {
      // A UTF-8 operator or exponent ends the word.
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("\u00b7") || rest.starts_with("\u22c5") || rest.starts_with("\u00b2") ||
          rest.starts_with("\u00b3") || rest.starts_with("\u2212") || rest.starts_with("\u00a0"))
        break;
      ++at_;
    }
    const std::string_view name = text_.substr(begin, at_ - begin);
    const std::optional<Unit> found = find_unit(name);
    if (!found) {
      const std::string meant = spelled(name);
      fail(fmt::format("has '{}', which is no unit here", name.substr(0, 20)),
           meant.empty() ? "write m, mm, N, kPa, kg, s, Hz, deg or %, or none" : meant);
      return {};
    }
    Quantity out{found->si, found->dimension, true};
    if (at_ < text_.size() && is_digit(text_[at_])) {  // m3
      const int exponent = text_[at_] - '0';
      ++at_;
      if (found->dimension == kNumber) {
        fail_two();
        return {};
      }
      if (at_ < text_.size() && is_digit(text_[at_])) {
        fail("has an exponent of two digits", "write one");
        return {};
      }
      return power(out, exponent);
    }
    return raised(out);
  }

  // ^2, ², ^-1
  Quantity raised(const Quantity& base) {
    if (!wrong_.what.empty()) return base;
    if (take("\u00b2")) return power(base, 2);
    if (take("\u00b3")) return power(base, 3);
    if (!take("^")) return base;
    const bool negative = take("-");
    blanks();
    if (at_ >= text_.size() || !is_digit(text_[at_]) || (at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) {
      fail("has an exponent that is no digit", "write ^2");
      return base;
    }
    const int exponent = text_[at_++] - '0';
    return power(base, negative ? -exponent : exponent);
  }

  Quantity power(const Quantity& base, int exponent) {
    Quantity out{std::pow(base.value, exponent), base.dimension, base.has_unit};
    for (int& each : out.dimension) each *= exponent;
    check(out);
    return out;
  }
  Quantity multiplied(const Quantity& a, const Quantity& b, bool over) {
    Quantity out{over ? a.value / b.value : a.value * b.value, a.dimension, a.has_unit || b.has_unit};
    if (over && b.value == 0.0) fail("divides by zero", "divide by something else");
    for (std::size_t i = 0; i < out.dimension.size(); ++i) out.dimension[i] += over ? -b.dimension[i] : b.dimension[i];
    check(out);
    return out;
  }
  void check(const Quantity& it) {
    for (const int each : it.dimension)
      if (std::abs(each) > kMostExponent) fail("has units to a power that nothing here has", "write fewer");
  }

  std::string_view text_;
  bool tight_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Error wrong_;
};

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// The field's own unit, which has only one interpretation.
Unit unit_of_field(std::string_view unit) {
  if (unit.empty() || unit == "1" || unit == "linear RGB") return {};
  const Result<Quantity> read = Reading(unit == "%%" ? "%" : unit, false).read();
  return read ? Unit{read->value, read->dimension} : Unit{};
}

// Removes rounding of the conversion through SI units: 0.3 mm is 0.3 in a field of mm.
double as_typed(double value) {
  double rounded = value;
  const std::string text = fmt::format("{:.15g}", value);
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return std::abs(rounded - value) <= 1e-15 * std::abs(value) ? rounded : value;
}

bool fits(const Quantity& it, const Unit& field) {
  if (!it.has_unit || it.dimension == field.dimension) return true;
  // Radians are numbers: N m is a rotational stiffness, 1/s a rotational rate. An angle itself requires an angle.
  Dimension a = it.dimension, b = field.dimension;
  if (a[kAngle] != 0 || b == kTurn) return false;
  a[kAngle] = b[kAngle] = 0;
  return a == b;
}

}  // namespace

Result<double> parse_quantity(std::string_view text, std::string_view unit) {
  text = trimmed(text);
  if (text.empty()) return Error{"", "is empty", "write a number"};
  if (text.size() > 200) return Error{"", "is too long for a number", "write less"};
  if (std::none_of(text.begin(), text.end(), is_digit)) return Error{"", "has no number", "write one before the unit"};
  const Unit field = unit_of_field(unit);
  const Result<Quantity> tight = Reading(text, true).read(), loose = Reading(text, false).read();
  const Result<Quantity>& read = tight && fits(*tight, field) ? tight : loose && fits(*loose, field) ? loose : tight;
  if (!read) return read.error();
  if (!fits(*read, field)) {
    if (field.dimension == kNumber)
      return Error{"", "is a number with a unit, where a plain number is asked for", "leave the unit out"};
    return Error{"", fmt::format("is of another kind than {}", unit), fmt::format("write it in {}", unit)};
  }
  const double value = read->has_unit ? read->value / field.si : read->value;
  if (!std::isfinite(value)) return Error{"", "is too large for a number", "write another"};
  return read->has_unit ? as_typed(value) : value;
}

double in_si(std::string_view unit) {
  return 1.0 / unit_of_field(unit).si;
}

}  // namespace pliant::ui
