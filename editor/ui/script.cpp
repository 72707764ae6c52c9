#include "editor/ui/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "content/files/file_io.h"
#include "editor/ui/script_words.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"
#include "viewer/window/keys.h"

namespace pliant::ui {
namespace {

constexpr int kRestFrames = 3;  // for an opened window to be drawn and laid out

}  // namespace

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

Result<Spot> Script::place(const std::string& text, bool& there, Need need) const {
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

Error Script::ended(std::string why, std::string cure) const {
  return {fmt::format("{}:{}", file_, line_), std::move(why), std::move(cure)};
}

}  // namespace pliant::ui
