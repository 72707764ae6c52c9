#include "viewer/window/window_input.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "content/files/file_io.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

constexpr std::size_t kLongestLine = 4096;  // [bytes]

std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return {};
  return value;
}

// The remaining words are a button and modifiers.
bool take_words(std::istringstream& words, InputEvent& event) {
  for (std::string word; words >> word;) {
    if (word == "left")
      event.button = MouseButton::kLeft;
    else if (word == "middle")
      event.button = MouseButton::kMiddle;
    else if (word == "right")
      event.button = MouseButton::kRight;
    else if (word == "shift")
      event.modifiers |= kShift;
    else if (word == "control")
      event.modifiers |= kControl;
    else if (word == "alt")
      event.modifiers |= kAlt;
    else
      return false;
  }
  return true;
}

std::optional<InputEvent> parse_event(const std::string& name, const std::string& arguments) {
  InputEvent event;
  std::istringstream words(arguments);
  std::string first, second;
  if (name == "move") {
    words >> first >> second;
    const std::optional<double> x = number(first), y = number(second);
    if (!x || !y) return {};
    event.x = *x;
    event.y = *y;
  } else if (name == "press" || name == "release") {
    event.kind = name == "press" ? InputKind::kPress : InputKind::kRelease;
  } else if (name == "wheel") {
    event.kind = InputKind::kWheel;
    words >> first;
    const std::optional<double> clicks = number(first);
    if (!clicks) return {};
    event.y = *clicks;
  } else if (name == "key") {
    event.kind = InputKind::kKey;
    words >> first;
    if (!parse_keys(first, event.key, event.modifiers)) return {};
  } else if (name == "drop") {
    event.kind = InputKind::kDrop;
    event.file = arguments;
    return arguments.empty() ? std::nullopt : std::optional(event);
  } else if (name == "click") {
    event.kind = InputKind::kWidget;
    event.file = arguments;
    return arguments.empty() ? std::nullopt : std::optional(event);
  } else if (name == "close") {
    event.kind = InputKind::kClose;
  } else {
    return {};
  }
  return take_words(words, event) ? std::optional(event) : std::nullopt;
}

}  // namespace

Result<InputScript> InputScript::load(const std::string& file) {
  const Result<Bytes> bytes = read_file(file, limits::kInputFile);  // rejects files without end, such as a pipe or
                                                                    // /dev/zero
  if (!bytes) return bytes.error();
  std::istringstream in(std::string(bytes->begin(), bytes->end()));
  InputScript script;
  std::string line;
  for (std::size_t row = 1; std::getline(in, line); ++row) {
    const std::string where = file + ":" + std::to_string(row);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.size() > kLongestLine) return Error{where, "is too long", "shorten it"};
    if (row > most(limits::kInputRows))
      return error_at(file, beyond("has", limits::kInputRows, static_cast<double>(row), "shorten it"));
    if (row == 1) {
      if (line != "time_s,event,args") return Error{where, "is not the header", "begin with time_s,event,args"};
      continue;
    }
    if (line.empty()) continue;
    const std::size_t comma = line.find(','), second = comma == std::string::npos ? comma : line.find(',', comma + 1);
    const std::optional<double> time = number(line.substr(0, comma));
    const std::string name = comma == std::string::npos ? "" : line.substr(comma + 1, second - comma - 1);
    const std::optional<InputEvent> event =
        parse_event(name, second == std::string::npos ? std::string() : line.substr(second + 1));
    if (!time || !event) return Error{where, "is not an event", "write, say, 0.5,move,320 200"};
    if (!script.rows_.empty() && *time < script.rows_.back().time)
      return Error{where, "goes back in time", "put events in order"};
    script.rows_.push_back({*time, *event});
  }
  return script;
}

void InputScript::take(double now, std::vector<InputEvent>& events) {
  time_ += std::min(now - last_.value_or(now), kLongestPause);
  last_ = now;
  for (; next_ < rows_.size() && rows_[next_].time <= time_; ++next_) events.push_back(rows_[next_].event);
}

}  // namespace pliant
