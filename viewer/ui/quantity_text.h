// The text of a quantity as it is read: blanks, signs, numbers and words, up to the first fault.
#pragma once

#include <string>
#include <string_view>

#include "runtime/result.h"

namespace pliant::ui {

bool is_digit(char c);
bool is_letter(char c);  // of a unit; the bytes of a character beyond ASCII, too

class QuantityText {
 public:
  explicit QuantityText(std::string_view text) : text_(text) {}

  // The first fault counts; reading ends there.
  void fail(const std::string& why, const std::string& cure);
  void fail_two();
  void fail_here();
  bool failed() const { return !wrong_.what.empty(); }
  const Error& wrong() const { return wrong_; }  // the first one

  bool ended() const { return at_ >= text_.size(); }
  char here() const { return ended() ? '\0' : text_[at_]; }
  char after() const { return at_ + 1 < text_.size() ? text_[at_ + 1] : '\0'; }
  void step() { ++at_; }
  void blanks();
  bool take(std::string_view word);  // after blanks
  double number();
  std::string_view word();  // of letters

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  Error wrong_;
};

}  // namespace pliant::ui
