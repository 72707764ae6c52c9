#include "editor/ui/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "content/files/file_io.h"
#include "editor/ui/seen.h"
#include "editor/ui/widgets.h"

namespace pliant::ui {
namespace {

constexpr double kScriptPatience = 60.0;  // [s] limit for `await`, and for the editor to become idle
constexpr int kLateFrames = 10;           // to wait for the target of a click
constexpr int kRestFrames = 3;            // for an opened window to be drawn and laid out

struct NamedKey {
  const char* name;
  int key;
};
constexpr NamedKey kNamed[] = {
    {"Tab", GLFW_KEY_TAB},         {"Esc", GLFW_KEY_ESCAPE},
    {"Space", GLFW_KEY_SPACE},     {"Home", GLFW_KEY_HOME},
    {"End", GLFW_KEY_END},         {"Enter", GLFW_KEY_ENTER},
    {"Delete", GLFW_KEY_DELETE},   {"Backspace", GLFW_KEY_BACKSPACE},
    {"Left", GLFW_KEY_LEFT},       {"Right", GLFW_KEY_RIGHT},
    {"Up", GLFW_KEY_UP},           {"Down", GLFW_KEY_DOWN},
    {"PageUp", GLFW_KEY_PAGE_UP},  {"PageDown", GLFW_KEY_PAGE_DOWN},
    {".", GLFW_KEY_PERIOD},        {",", GLFW_KEY_COMMA},
    {"/", GLFW_KEY_SLASH},         {"-", GLFW_KEY_MINUS},
    {"=", GLFW_KEY_EQUAL},         {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET}, {"Escape", GLFW_KEY_ESCAPE}};  // the first of two names is written

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

InputEvent at(InputKind kind, double x, double y, MouseButton button = MouseButton::kLeft, std::uint8_t modifiers = 0) {
  InputEvent event;
  event.kind = kind;
  event.x = x;
  event.y = y;
  event.button = button;
  event.modifiers = modifiers;
  return event;
}

// Words after a place: a button, modifiers.
struct Manner {
  MouseButton button = MouseButton::kLeft;
  std::uint8_t modifiers = 0;
  bool twice = false;
  double seconds = 0.2;
};
Manner manner_of(const std::vector<std::string>& words) {
  Manner m;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "right") m.button = MouseButton::kRight;
    if (words[i] == "middle") m.button = MouseButton::kMiddle;
    if (words[i] == "double") m.twice = true;
    if (words[i] == "shift") m.modifiers |= kShift;
    if (words[i] == "control") m.modifiers |= kControl;
    if (words[i] == "alt") m.modifiers |= kAlt;
    if (words[i] == "in" && i + 1 < words.size()) m.seconds = number_of(words[i + 1]).value_or(m.seconds);
  }
  return m;
}

bool is_manner(const std::string& word) {
  constexpr const char* kWords[] = {"right", "middle", "double", "shift", "control", "alt", "in", "to"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

// Addresses may contain blanks: everything up to a modifier word.
std::string address_of(const std::vector<std::string>& words, std::size_t& i) {
  std::string address;
  for (; i < words.size() && !is_manner(words[i]); ++i) address += (address.empty() ? "" : " ") + words[i];
  return address;
}

}  // namespace

bool parse_keys(const std::string& keys, int& key, std::uint8_t& modifiers) {
  modifiers = 0;
  key = 0;
  std::string rest = keys;
  for (;;) {
    const std::size_t plus = rest.find('+', 1);
    if (plus == std::string::npos) break;
    const std::string word = rest.substr(0, plus);
    if (word == "Ctrl")
      modifiers |= kControl;
    else if (word == "Shift")
      modifiers |= kShift;
    else if (word == "Alt")
      modifiers |= kAlt;
    else
      return false;
    rest = rest.substr(plus + 1);
  }
  if (rest.size() == 1 && std::isalnum(static_cast<unsigned char>(rest[0]))) {
    key = std::toupper(static_cast<unsigned char>(rest[0]));
    return true;
  }
  for (const NamedKey& named : kNamed)
    if (rest == named.name) {
      key = named.key;
      return true;
    }
  if (rest.size() >= 2 && rest[0] == 'F')
    if (const auto n = number_of(rest.substr(1)); n && *n >= 1 && *n <= 12) {
      key = GLFW_KEY_F1 + static_cast<int>(*n) - 1;
      return true;
    }
  return false;
}

std::string keys_text(int key, std::uint8_t modifiers) {
  std::string text;
  if (modifiers & kControl) text += "Ctrl+";
  if (modifiers & kAlt) text += "Alt+";
  if (modifiers & kShift) text += "Shift+";
  if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return text + fmt::format("F{}", key - GLFW_KEY_F1 + 1);
  for (const NamedKey& named : kNamed)
    if (key == named.key) return text + named.name;
  if (key > 32 && key < 127) return text + static_cast<char>(key);
  return {};
}

Result<Script> Script::load(const std::filesystem::path& file) {
  const Result<Bytes> bytes = read_file(file, limits::kInputFile);
  if (!bytes) return bytes.error();
  Script script;
  script.file_ = file.string();
  std::istringstream in(std::string(bytes->begin(), bytes->end()));
  std::string line;
  for (std::size_t row = 1; std::getline(in, line); ++row) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::istringstream words(line);
    Step step;
    step.line = row;
    if (!(words >> step.verb) || step.verb[0] == '#') continue;
    std::getline(words >> std::ws, step.rest);
    std::istringstream rest(step.rest);
    for (std::string word; rest >> word;) step.words.push_back(word);
    constexpr const char* kVerbs[] = {"click",     "drag",  "press",   "move",       "release", "wheel",
                                      "key",       "type",  "set",     "wait",       "await",   "expect",
                                      "expect-no", "say",   "hear",    "screenshot", "drop",    "figures",
                                      "felt",      "close", "at-once", "now",        "apart",   "slow"};
    if (std::find(std::begin(kVerbs), std::end(kVerbs), step.verb) == std::end(kVerbs))
      return Error{fmt::format("{}:{}", script.file_, row), "'" + step.verb + "' is no step",
                   "write, say, `click Inspector/stiffness`"};
    script.steps_.push_back(std::move(step));
  }
  return script;
}

Result<std::pair<double, double>> Script::place(const std::string& text, bool& there, Need need) const {
  there = true;
  double fx = 0.5, fy = 0.5;
  std::string address = text;
  if (const std::size_t mark = text.rfind('@'); mark != std::string::npos) {
    const std::size_t comma = text.find(',', mark);
    const auto x = number_of(text.substr(mark + 1, comma == std::string::npos ? comma : comma - mark - 1));
    const auto y = comma == std::string::npos ? std::nullopt : number_of(text.substr(comma + 1));
    if (x && y) {
      fx = *x;
      fy = *y;
      address = text.substr(0, mark);
    }
  }
  if (const std::size_t blank = address.find(' '); blank != std::string::npos)
    if (const auto x = number_of(address.substr(0, blank)), y = number_of(address.substr(blank + 1)); x && y)
      return std::pair{*x, *y};
  const std::optional<Place> found = find_widget(address);
  if (!found) {
    there = false;
    std::string like;
    for (const std::string& each : widget_addresses())
      if (like.size() < 600) like += (like.empty() ? "" : ", ") + each;
    return Error{"", "there is no single widget '" + address + "' now", "there are: " + like};
  }
  const double x = static_cast<double>(found->low.x) + fx * static_cast<double>(found->high.x - found->low.x),
               y = static_cast<double>(found->low.y) + fy * static_cast<double>(found->high.y - found->low.y);
  if (fx < 0 || fx > 1 || fy < 0 || fy > 1 || need == Need::kThere) return std::pair{x, y};
  const auto px = static_cast<float>(x), py = static_cast<float>(y);
  // A scrolled-out place counts as uncovered.
  const bool scrolled =
      px < found->seen_low.x || px > found->seen_high.x || py < found->seen_low.y || py > found->seen_high.y;
  if (need == Need::kUncovered && scrolled) return std::pair{x, y};
  if (const std::string why = need == Need::kPress ? why_unpressable(*found, px, py) : why_unseen(*found, px, py);
      !why.empty()) {
    there = false;
    return Error{"", why};
  }
  return std::pair{x, y};
}

void Script::key_events(const std::string& keys, bool) {
  int key = 0;
  std::uint8_t modifiers = 0;
  if (!parse_keys(keys, key, modifiers)) return;
  InputEvent down;
  down.kind = InputKind::kKey;
  down.key = key;
  down.modifiers = modifiers;
  InputEvent up = down;
  up.kind = InputKind::kKeyUp;
  up.modifiers = 0;
  frames_.push_back({down});
  frames_.push_back({up});
}

Status Script::begin(const Step& step, const Surroundings& now, bool& waits) {
  waits = false;
  const auto placed = [&](const Error& error) { return error.at(fmt::format("{}:{}", file_, step.line)); };
  const auto wrong = [&](const std::string& what, const std::string& cure = {}) { return placed({"", what, cure}); };
  std::size_t i = 0;
  bool there = true;
  if (step.verb == "click" || step.verb == "press" || step.verb == "move" || step.verb == "drag") {
    const auto from = place(address_of(step.words, i), there, step.verb == "move" ? Need::kUncovered : Need::kPress);
    waits = !from && rest_ < kLateFrames;
    if (waits) return Done{};
    if (!from) return placed(from.error());
    std::pair<double, double> to = *from;
    if (step.verb == "drag") {
      if (i >= step.words.size() || step.words[i] != "to")
        return wrong("says no place to drag to", "write `drag A to B`");
      const auto target = place(address_of(step.words, ++i), there, Need::kThere);
      if (!target) return placed(target.error());
      to = *target;
    }
    const Manner m = manner_of({step.words.begin() + static_cast<std::ptrdiff_t>(i), step.words.end()});
    frames_.push_back({at(InputKind::kMove, from->first, from->second)});
    frames_.push_back({});
    if (step.verb == "move") return Done{};
    if (m.twice) {  // as fast as a user, however slow the frames are
      const InputEvent down = at(InputKind::kPress, 0, 0, m.button, m.modifiers),
                       up = at(InputKind::kRelease, 0, 0, m.button, m.modifiers);
      frames_.push_back({down, up, down, up});
    } else {
      frames_.push_back({at(InputKind::kPress, 0, 0, m.button, m.modifiers)});
      if (step.verb == "press") return Done{};
      if (step.verb == "drag") {
        const int steps = std::max(4, static_cast<int>(m.seconds * 40));
        for (int k = 1; k <= steps; ++k) {
          const double s = static_cast<double>(k) / steps;
          frames_.push_back({at(InputKind::kMove, from->first + s * (to.first - from->first),
                                from->second + s * (to.second - from->second))});
        }
        frames_.push_back({});
      }
      frames_.push_back({at(InputKind::kRelease, 0, 0, m.button, m.modifiers)});
    }
    return Done{};
  }
  if (step.verb == "release") {
    frames_.push_back({at(InputKind::kRelease, 0, 0, manner_of(step.words).button)});
    return Done{};
  }
  if (step.verb == "wheel") {
    if (step.words.size() < 2) return wrong("says no clicks", "write `wheel Viewport 3`");
    const auto clicks = number_of(step.words.back());
    const auto from = place(step.rest.substr(0, step.rest.rfind(' ')), there, Need::kUncovered);
    if (!from) return placed(from.error());
    if (!clicks) return wrong("says no clicks", "write `wheel Viewport 3`");
    frames_.push_back({at(InputKind::kMove, from->first, from->second)});
    frames_.push_back({at(InputKind::kWheel, 0, *clicks)});
    return Done{};
  }
  if (step.verb == "key") {
    int key = 0;
    std::uint8_t modifiers = 0;
    if (!parse_keys(step.rest, key, modifiers)) return wrong("'" + step.rest + "' is no key", "write, say, Ctrl+S");
    key_events(step.rest, false);
    return Done{};
  }
  if (step.verb == "type" || step.verb == "set") {
    std::string text = step.rest;
    if (step.verb == "set") {
      // The longest prefix that is a widget's address: names and values may both contain blanks.
      std::size_t last = step.rest.rfind(' ');
      if (last == std::string::npos) return wrong("says no value", "write `set Inspector/stiffness 500`");
      for (std::size_t at = last; at != std::string::npos && at > 0; at = step.rest.rfind(' ', at - 1))
        if (find_widget(step.rest.substr(0, at))) {
          last = at;
          break;
        }
      text = step.rest.substr(last + 1);
      const auto from = place(step.rest.substr(0, last), there, Need::kPress);
      waits = !from && rest_ < kLateFrames;
      if (waits) return Done{};
      if (!from) return placed(from.error());
      frames_.push_back({at(InputKind::kMove, from->first, from->second)});
      frames_.push_back({});
      // Ctrl-click edits a number, and selects a text.
      InputEvent down = at(InputKind::kPress, 0, 0, MouseButton::kLeft, kControl);
      frames_.push_back({down});
      frames_.push_back({at(InputKind::kRelease, 0, 0, MouseButton::kLeft, kControl)});
      frames_.push_back({});
      key_events("Ctrl+A", false);
    }
    for (const char* c = text.c_str(); *c != '\0';) {
      unsigned code_point = 0;
      c += std::max(1, ImTextCharFromUtf8(&code_point, c, nullptr));
      InputEvent event;
      event.kind = InputKind::kText;
      event.key = static_cast<int>(code_point);
      frames_.push_back({event});
    }
    if (step.verb == "set") key_events("Enter", false);
    return Done{};
  }
  if (step.verb == "wait") {
    if (began_ < 0) began_ = now.now;
    waits = now.now - began_ < number_of(step.rest).value_or(0.0);
    return Done{};
  }
  if (step.verb == "await") {
    if (began_ < 0) began_ = now.now;
    std::string address = step.rest;
    double patience = kScriptPatience;
    if (const std::size_t last = address.rfind(' '); last != std::string::npos)
      if (const auto seconds = number_of(address.substr(last + 1))) {
        patience = *seconds;
        address.resize(last);
      }
    const auto found = find_widget(address);
    const auto seen = place(address, there, Need::kUncovered);
    waits = !seen || (found && !found->enabled);
    if (waits && now.now - began_ > patience) return seen ? wrong("'" + address + "' stays off") : placed(seen.error());
    return Done{};
  }
  if (step.verb == "expect" || step.verb == "expect-no") {
    const auto found = place(step.rest, there, Need::kUncovered);
    waits = (step.verb == "expect") != there && rest_ < kLateFrames;
    if (waits) return Done{};
    if ((step.verb == "expect") != there)
      return found ? wrong("'" + step.rest + "' is there, and should not be") : placed(found.error());
    return Done{};
  }
  if (step.verb == "say") {
    if (!now.has_said(step.rest)) return wrong("the console does not say '" + step.rest + "'");
    return Done{};
  }
  if (step.verb == "hear") {
    if (began_ < 0) began_ = now.now;
    waits = !now.has_said(step.rest);
    if (waits && now.now - began_ > kScriptPatience) return wrong("the console does not say '" + step.rest + "'");
    return Done{};
  }
  if (step.verb == "figures") {
    now.figures(step.rest);
    return Done{};
  }
  if (step.verb == "felt") {
    const Status written = now.felt(step.rest);
    return written ? written : wrong(written.error().message());
  }
  if (step.verb == "screenshot") {
    now.screenshot(step.rest);
    frames_.push_back({});
    return Done{};
  }
  if (step.verb == "apart") {
    if (const std::string why = not_apart(); !why.empty()) return wrong(why);
    return Done{};
  }
  if (step.verb == "slow") {
    now.slow(number_of(step.rest).value_or(0.0));
    return Done{};
  }
  if (step.verb == "at-once" || step.verb == "now") {
    at_once_ = step.verb == "at-once";
    return Done{};
  }
  InputEvent event;
  event.kind = step.verb == "drop" ? InputKind::kDrop : InputKind::kClose;
  std::istringstream files(step.rest);
  for (std::string file; std::getline(files >> std::ws, file, '|');) {
    while (file.ends_with(' ')) file.pop_back();
    event.files.push_back(file);
  }
  frames_.push_back({event});
  return Done{};
}

Status Script::next(const Surroundings& now, std::vector<InputEvent>& events) {
  if (!frames_.empty() && !at_once_) {
    events.insert(events.end(), frames_.front().begin(), frames_.front().end());
    frames_.pop_front();
    rest_ = 0;
    return Done{};
  }
  if (steps_.empty()) {
    ++rest_;
    return Done{};
  }
  const std::string& verb = steps_.front().verb;
  const bool in_parts = verb == "move" || verb == "release";  // of a press in parts: does not wait for idle
  if (++rest_ < kRestFrames) return Done{};
  const bool gives_up = awaited_.starts_with("Opening/");  // what is under way
  if (!now.under_way.empty() && !in_parts && !gives_up && verb != "wait" && verb != "await" && verb != "hear") {
    if (until_ == 0.0) until_ = now.now + kScriptPatience;
    if (now.now < until_) return Done{};
    return Error{fmt::format("{}:{}", file_, steps_.front().line),
                 "the editor did not come to rest within 60 s: " + now.under_way + " is under way"};
  }
  until_ = 0.0;
  line_ = steps_.front().line;
  if (const std::string both = shared_identity(); !both.empty())
    return Error{fmt::format("{}:{}", file_, steps_.front().line), both};
  bool waits = false;
  if (Status s = begin(steps_.front(), now, waits); !s) return s;
  if (waits) return Done{};
  began_ = -1.0;
  const bool gathered = steps_.front().verb == "now";
  if (verb != "screenshot") awaited_ = verb == "await" ? steps_.front().rest : "";
  steps_.pop_front();
  if (gathered) {
    std::vector<InputEvent> all;
    for (const std::vector<InputEvent>& each : frames_) all.insert(all.end(), each.begin(), each.end());
    frames_.assign(1, std::move(all));
  }
  return Done{};
}

bool Script::done() const {
  return steps_.empty() && frames_.empty() && rest_ > kRestFrames;
}

Error Script::ended(std::string why) const {
  return {fmt::format("{}:{}", file_, line_), std::move(why)};
}

}  // namespace pliant::ui
