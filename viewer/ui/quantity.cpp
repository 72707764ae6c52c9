#include "viewer/ui/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "viewer/ui/quantity_text.h"
#include "viewer/ui/units.h"

namespace pliant::ui {
namespace {

constexpr int kMostExponent = 12, kDeepest = 32;

// A value in SI, and whether it contains a unit.
struct Quantity {
  double value = 0.0;
  Dimension dimension = kNumber;
  bool has_unit = false;
};

// One interpretation of a text. `tight`: a unit belongs to the number before it ("1 N / 2 mm" is half a newton per
// millimetre). Otherwise evaluation is left to right ("1/10 mm" is a tenth of one).
class Reading {
 public:
  Reading(std::string_view text, bool tight) : text_(text), tight_(tight) {}

  Result<Quantity> read() {
    const Quantity out = sum();
    text_.blanks();
    if (!text_.failed() && !text_.ended()) text_.fail_here();
    if (!text_.failed() && !std::isfinite(out.value)) text_.fail("is no finite number", "divide by something else");
    if (text_.failed()) return text_.wrong();
    return out;
  }

 private:
  Quantity sum() {
    Quantity left = product();
    for (;;) {
      const bool plus = text_.take("+"), minus = !plus && (text_.take("-") || text_.take("\u2212"));
      if (!plus && !minus) return left;
      const Quantity right = product();
      if (text_.failed()) return left;
      if (left.has_unit != right.has_unit)
        text_.fail("adds a number with a unit and one without", "give both a unit");
      else if (left.dimension != right.dimension)
        text_.fail("adds two things of different kinds", "write units of the same kind");
      left.value += plus ? right.value : -right.value;
    }
  }

  Quantity product() {
    Quantity left = factor();
    for (;;) {
      text_.blanks();
      const bool times = text_.take("*") || text_.take("\u00b7") || text_.take("\u22c5"),
                 over = !times && text_.take("/");
      if (times || over) {
        left = multiplied(left, factor(), over);
        continue;
      }
      // Implicit multiplication: a unit follows, or a bracket after one.
      if (!text_.failed() && is_letter(text_.here())) {
        left = multiplied(left, unit(), false);
        continue;
      }
      return left;
    }
  }

  Quantity factor() {
    if (++depth_ > kDeepest) text_.fail("is nested too deeply", "write fewer signs and brackets");
    Quantity out;
    if (text_.failed()) return out;
    if (text_.take("+")) {
      out = factor();
    } else if (text_.take("-") || text_.take("\u2212")) {
      out = factor();
      out.value = -out.value;
    } else if (text_.take("(")) {
      out = sum();
      if (!text_.failed() && !text_.take(")")) text_.fail("lacks a closing bracket", "write it");
      out = with_units(raised(out));
    } else {
      text_.blanks();
      if (text_.ended()) {
        text_.fail("ends too early", "write a number behind the last sign");
      } else if (is_digit(text_.here()) || text_.here() == '.' || text_.here() == ',') {
        out.value = text_.number();
        out = with_units(raised(out));
      } else if (is_letter(text_.here())) {
        out = unit();
      } else {
        text_.fail_here();
      }
    }
    --depth_;
    return out;
  }

  // In the tight interpretation, the units directly after a number: "5 N mm" too.
  Quantity with_units(Quantity out) {
    if (!tight_) return out;
    for (text_.blanks(); !text_.failed() && is_letter(text_.here()); text_.blanks())
      out = multiplied(out, unit(), false);
    return out;
  }

  Quantity unit() {
    const std::string_view name = text_.word();
    const std::optional<Unit> found = find_unit(name);
    if (!found) {
      const std::string meant = spelled(name);
      text_.fail(fmt::format("has '{}', which is no unit here", name.substr(0, 20)),
                 meant.empty() ? "write m, mm, N, kPa, kg, s, Hz, deg or %, or none" : meant);
      return {};
    }
    Quantity out{found->si, found->dimension, true};
    if (is_digit(text_.here())) {  // m3
      const int exponent = text_.here() - '0';
      text_.step();
      if (found->dimension == kNumber) {
        text_.fail_two();
        return {};
      }
      if (is_digit(text_.here())) {
        text_.fail("has an exponent of two digits", "write one");
        return {};
      }
      return power(out, exponent);
    }
    return raised(out);
  }

  // ^2, ², ^-1
  Quantity raised(const Quantity& base) {
    if (text_.failed()) return base;
    if (text_.take("\u00b2")) return power(base, 2);
    if (text_.take("\u00b3")) return power(base, 3);
    if (!text_.take("^")) return base;
    const bool negative = text_.take("-");
    text_.blanks();
    if (!is_digit(text_.here()) || is_digit(text_.after())) {
      text_.fail("has an exponent that is no digit", "write ^2");
      return base;
    }
    const int exponent = text_.here() - '0';
    text_.step();
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
    if (over && b.value == 0.0) text_.fail("divides by zero", "divide by something else");
    for (std::size_t i = 0; i < out.dimension.size(); ++i) out.dimension[i] += over ? -b.dimension[i] : b.dimension[i];
    check(out);
    return out;
  }
  void check(const Quantity& it) {
    for (const int each : it.dimension)
      if (std::abs(each) > kMostExponent) text_.fail("has units to a power that nothing here has", "write fewer");
  }

  QuantityText text_;
  bool tight_;
  int depth_ = 0;
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
  if (a[kAngle] != 0 || b == kAngleOnly) return false;
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
