#include "viewer/ui/quantity_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace pliant::ui {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}

void QuantityText::fail(const std::string& why, const std::string& cure) {
  if (!failed()) wrong_ = {"", why, cure};
  at_ = text_.size();
}

void QuantityText::fail_two() {
  fail("has two numbers side by side", "write one, or +, -, * or / between them");
}

void QuantityText::fail_here() {
  if (is_digit(text_[at_])) return fail_two();
  fail(fmt::format("cannot be read from '{}' on", text_.substr(at_, 20)),
       "write a number and its unit, 5 mm, or a sum, 1/10");
}

void QuantityText::blanks() {
  for (;;) {
    if (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t'))
      ++at_;
    else if (text_.substr(at_).starts_with("\u00a0"))
      at_ += 2;
    else
      return;
  }
}

bool QuantityText::take(std::string_view word) {
  blanks();
  if (!text_.substr(at_).starts_with(word)) return false;
  at_ += word.size();
  return true;
}

double QuantityText::number() {
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
    fail(fmt::format("can be {}{} or {}.{}", typed.substr(0, before), typed.substr(before + 1), typed.substr(0, before),
                     typed.substr(before + 1)),
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

std::string_view QuantityText::word() {
  const std::size_t begin = at_;
  while (at_ < text_.size() && is_letter(text_[at_])) {
    // A UTF-8 operator or exponent ends the word.
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("\u00b7") || rest.starts_with("\u22c5") || rest.starts_with("\u00b2") ||
        rest.starts_with("\u00b3") || rest.starts_with("\u2212") || rest.starts_with("\u00a0"))
      break;
    ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

}  // namespace pliant::ui
