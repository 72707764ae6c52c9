#include "content/tets/tet_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace pliant {
namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

}  // namespace

bool to_number(std::string_view word, double& out) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, out);
  return error == std::errc{} && stop == end && std::isfinite(out);
}

bool to_integer(std::string_view word, std::int64_t& out) {
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, out);
  return error == std::errc{} && stop == end;
}

bool TetText::line(std::string_view& out) {
  taken_ = at_;
  if (left() == 0) return false;
  const std::size_t end = std::min(text().find('\n', at_), text().size());
  out = text().substr(at_, end - at_);
  while (!out.empty() && is_space(out.back())) out.remove_suffix(1);
  at_ = std::min(end + 1, text().size());
  return true;
}

bool TetText::word(std::string_view& out, bool comments) {
  const std::string_view all = text();
  for (;;) {
    while (at_ < all.size() && is_space(all[at_])) ++at_;
    if (at_ == all.size()) {
      taken_ = at_;
      return false;
    }
    if (!comments || all[at_] != '#') break;
    at_ = std::min(all.find('\n', at_), all.size());
  }
  taken_ = at_;
  while (at_ < all.size() && !is_space(all[at_])) ++at_;
  out = all.substr(taken_, at_ - taken_);
  return true;
}

bool TetText::number(double& out, bool comments) {
  std::string_view w;
  return word(w, comments) && to_number(w, out);
}

bool TetText::integer(std::int64_t& out, bool comments) {
  std::string_view w;
  return word(w, comments) && to_integer(w, out);
}

bool TetText::skip(std::uint64_t bytes) {
  if (bytes > left()) return false;
  at_ += bytes;
  return true;
}

bool TetText::skip_past(std::string_view mark) {
  const std::size_t found = text().find(mark, at_);
  if (found == std::string_view::npos) return false;
  at_ = found + mark.size();
  return true;
}

Error TetText::fault(const std::string& what, const std::string& cure) const {
  if (binary_) return {fmt::format("{} at byte {}", name_, at_), what, cure, "tets.file"};
  const std::string_view before = text().substr(0, taken_);
  return {fmt::format("{}:{}", name_, 1 + std::count(before.begin(), before.end(), '\n')), what, cure, "tets.file"};
}

}  // namespace pliant
