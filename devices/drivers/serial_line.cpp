#include "devices/drivers/serial_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace pliant {
namespace {

constexpr std::size_t kLongest = 96;        // of a line
constexpr long kMostMicrometres = 5000000;  // 5 m
constexpr long kMostMillinewtons = 100000;
constexpr int kPoseWords = 6;  // words of a pose, after its P

unsigned sum_of(std::string_view text) {
  unsigned sum = 0;
  for (const char letter : text) sum ^= static_cast<unsigned char>(letter);
  return sum;
}

// The part before the checksum, if that is correct.
std::optional<std::string_view> checked(std::string_view line, SerialFault& why) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  why = line.size() < 4 ? SerialFault::kTooShort : SerialFault::kForm;
  if (line.size() < 4 || line.size() > kLongest || line[line.size() - 3] != '*') return {};
  unsigned sum = 0;
  const char* end = line.data() + line.size();
  const auto [at, fault] = std::from_chars(end - 2, end, sum, 16);
  if (fault != std::errc() || at != end) return {};
  line.remove_suffix(3);
  why = SerialFault::kSum;
  if (sum != sum_of(line)) return {};
  why = SerialFault::kNone;
  return line;
}

// Words of a line, separated by single blanks.
struct Words {
  std::string_view rest;
  bool good = true;
  std::string_view word() {
    const std::size_t blank = rest.find(' ');
    const std::string_view first = rest.substr(0, blank);
    rest = blank == std::string_view::npos ? std::string_view() : rest.substr(blank + 1);
    good = good && !first.empty() && (blank == std::string_view::npos || !rest.empty());
    return first;
  }
  long number(long least, long most) {
    const std::string_view text = word();
    long value = 0;
    const auto [at, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    good = good && fault == std::errc() && at == text.data() + text.size() && value >= least && value <= most;
    return good ? value : 0;
  }
  bool done() const { return good && rest.empty(); }
};

std::size_t finish(SerialText& text, int length) {
  const unsigned sum = sum_of({text.data(), static_cast<std::size_t>(length)});
  return static_cast<std::size_t>(
      length + std::snprintf(text.data() + length, text.size() - static_cast<std::size_t>(length), "*%02X\n", sum));
}

long rounded(double value, double scale, long most) {
  const auto limit = static_cast<double>(most);
  return std::isfinite(value) ? static_cast<long>(std::clamp(value * scale, -limit, limit)) : 0;
}

}  // namespace

std::optional<SerialPose> parse_serial_pose(std::string_view line, SerialFault* fault) {
  SerialFault ignored, &why = fault ? *fault : ignored;
  const auto text = checked(line, why);
  if (!text) return {};
  Words words{*text};
  why = SerialFault::kForm;
  if (words.word() != "P") return {};
  const auto blanks = std::count(text->begin(), text->end(), ' ');
  if (blanks == kPoseWords) why = SerialFault::kNumber;  // the only remaining fault
  SerialPose pose;
  pose.time_ms = static_cast<std::uint32_t>(words.number(0, 0xFFFFFFFFL));
  for (int i = 0; i < 3; ++i)
    pose.sample.position[i] = 1e-6 * static_cast<double>(words.number(-kMostMicrometres, kMostMicrometres));
  pose.sample.buttons = static_cast<std::uint32_t>(words.number(0, 0xFFFFFFFFL));
  pose.sample.grip = 1e-3 * static_cast<double>(words.number(0, 1000));
  if (!words.done()) return {};
  why = SerialFault::kNone;
  return pose;
}

std::optional<SerialIdentity> parse_serial_identity(std::string_view line) {
  SerialFault ignored;
  const auto text = checked(line, ignored);
  if (!text) return {};
  Words words{*text};
  if (words.word() != "I") return {};
  SerialIdentity who;
  who.name = words.word();
  who.axes = static_cast<int>(words.number(0, 3));
  who.max_force = 1e-3 * static_cast<double>(words.number(0, kMostMillinewtons));
  if (!words.done()) return {};
  for (char& letter : who.name)
    if (letter < 33 || letter > 126) letter = '?';  // printed to terminals
  return who;
}

std::size_t serial_force(unsigned number, const dvec3& force, SerialText& into) {
  const long x = rounded(force.x, 1e3, kMostMillinewtons), y = rounded(force.y, 1e3, kMostMillinewtons),
             z = rounded(force.z, 1e3, kMostMillinewtons);
  return finish(into, std::snprintf(into.data(), into.size(), "F %u %ld %ld %ld", number, x, y, z));
}

std::string serial_question() {
  SerialText text;
  const int length = std::snprintf(text.data(), text.size(), "?");
  return {text.data(), finish(text, length)};
}

void SerialLines::add(std::string_view more) {
  std::copy(bytes_.begin() + static_cast<long>(taken_), bytes_.begin() + static_cast<long>(size_), bytes_.begin());
  size_ -= taken_;
  taken_ = 0;
  for (const char letter : more) {
    if (size_ == bytes_.size()) {  // unread lines or noise: discarded up to the next end of line
      size_ = 0;
      skipping_ = true;
    }
    if (!skipping_) bytes_[size_++] = letter;
    if (letter == '\n') skipping_ = false;
  }
}

bool SerialLines::next(std::string_view& line) {
  const std::string_view left(bytes_.data() + taken_, size_ - taken_);
  const std::size_t end = left.find('\n');
  if (end == std::string_view::npos) return false;
  line = left.substr(0, end);
  taken_ += end + 1;
  return true;
}

}  // namespace pliant
