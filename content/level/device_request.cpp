#include "content/level/device_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "components/device_spec.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

constexpr std::size_t kMostAlternatives = 8, kMostWrappers = 8, kLongestWord = 40, kLongestShown = 80;

constexpr std::array<std::string_view, 4> kKinds{"any-force", "any-pose", "any", "mouse"};
// Drivers of directly connected hardware or of a vendor's service; they open their first device.
constexpr std::array<std::string_view, 9> kHardware{"spacemouse", "dualsense", "dualshock4",     "gamepad", "polhem",
                                                    "falcon",     "haply",     "forcedimension", "touch"};
constexpr std::array<std::string_view, 15> kSimulatedKeys{
    "hand", "clock",   "stops",    "at",      "push",       "rate",      "delay",     "lag",
    "mass", "damping", "friction", "encoder", "force_step", "max_force", "max_torque"};
constexpr std::array<std::string_view, 9> kWrappers{"delay", "jitter", "drop",   "quantise", "gain",
                                                    "scale", "frame",  "clutch", "border"};

template <std::size_t N>
bool among(const std::array<std::string_view, N>& all, std::string_view word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

std::string_view bare(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? std::string_view{}
                                         : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> parts_of(std::string_view text, char mark) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(mark);
    parts.push_back(bare(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// Only words and numbers with units: excludes the characters that paths, addresses and shells need.
bool plain(std::string_view word) {
  const auto harmless = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(".:%+-_").find(c) != std::string_view::npos;
  };
  return !word.empty() && word.size() <= kLongestWord && std::all_of(word.begin(), word.end(), harmless);
}

struct Option {
  std::string_view key, value;  // empty if there is no '='
};
Option option(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {{}, text};
  return {bare(text.substr(0, equals)), bare(text.substr(equals + 1))};
}

// Returns "" and appends the words to `out`, or why a level may not request this.
std::string wrapper(std::string_view words, std::string& out) {
  bool first = true;
  for (const std::string_view piece : parts_of(words, ',')) {
    const Option it = option(piece);
    if (first && it.key == "record") return "writes a file";
    if (first && it.key == "replay") return "reads a file";
    if (first && !among(kWrappers, it.key)) return "has a wrapper that is none";
    if (!plain(it.key) || !plain(it.value)) return "has a wrapper that is neither a number nor a word";
    out += fmt::format("{}{}={}", first ? '|' : ',', it.key, it.value);
    first = false;
  }
  return {};
}

std::string simulated(const DeviceSpec& spec, std::string& out) {
  out = spec.driver;
  if (!spec.has_id) return {};
  bool first = true;
  for (const std::string_view piece : parts_of(spec.id, ',')) {
    const Option it = option(piece);
    if (it.key == "path") return "reads a file";
    const bool profile = first && it.key.empty();
    if (!profile && !among(kSimulatedKeys, it.key)) return "has a key that is none";
    if (!plain(it.value)) return "has a word that is neither a number nor a name";
    out += fmt::format("{}{}{}{}", first ? ':' : ',', it.key, it.key.empty() ? "" : "=", it.value);
    first = false;
  }
  return {};
}

std::string kind(const DeviceSpec& spec, std::string& out) {
  if (spec.driver == "simulated") return simulated(spec, out);
  out = spec.device();
  if (!spec.has_id && (among(kKinds, spec.driver) || among(kHardware, spec.driver))) return {};
  if (spec.driver == "network") return "talks to an address of the network";
  if (spec.driver == "serial") return "opens a serial line";
  if (among(kHardware, spec.driver)) return "names one device, or a file, of this machine";
  if (spec.driver.empty()) return "names no device";
  return "is no kind of device";
}

// Returns "" and what to open, or why a level may not request this.
std::string alternative(const DeviceSpec& spec, std::string& out) {
  if (std::string wrong = kind(spec, out); !wrong.empty()) return wrong;
  if (spec.wrappers.size() > kMostWrappers) return fmt::format("has more than {} wrappers", kMostWrappers);
  for (const std::string& words : spec.wrappers)
    if (std::string wrong = wrapper(words, out); !wrong.empty()) return wrong;
  return {};
}

std::string shown(std::string_view text) {
  return printable(std::string(text.substr(0, kLongestShown)) + (text.size() > kLongestShown ? "..." : ""));
}

// Within single quotes a shell interprets only the quote itself.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : printable(text)) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

DeviceRequest device_request(std::string_view id) {
  DeviceRequest request;
  std::vector<DeviceSpec> all = parse_device_specs(id);
  if (all.size() > kMostAlternatives) {
    request.refused.push_back(fmt::format("`{}` and more are {} alternatives; a level may give {}",
                                          shown(all.front().words()), all.size(), kMostAlternatives));
    all.clear();
  }
  for (const DeviceSpec& one : all) {
    std::string out;
    if (const std::string wrong = alternative(one, out); !wrong.empty())
      request.refused.push_back(
          fmt::format("`{}` {}, and a level may ask for kinds of devices only (any-force, any-pose, any, mouse, "
                      "simulated, a driver's name without an address)",
                      shown(one.words()), wrong));
    else
      request.allowed += (request.allowed.empty() ? "" : "; ") + out;
  }
  return request;
}

std::vector<LevelRequest> device_requests(const Level& level) {
  std::vector<LevelRequest> all;
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    const LevelNode& node = level.nodes[n];
    if (!node.device || node.device->id.empty()) continue;
    LevelRequest asked{n, node.name, node.device->id, node.device->driver == DriverKind::kExternal,
                       device_request(node.device->id)};
    for (const LevelNode& mover : level.nodes) {
      const std::string& named = mover.probe ? mover.probe_device : mover.handle ? mover.handle->device : mover.name;
      if ((mover.probe || mover.handle) && (named.empty() ? &mover == &node : named == node.name)) {
        asked.moves = mover.name;
        break;
      }
    }
    all.push_back(std::move(asked));
  }
  return all;
}

std::string device_cure(const LevelRequest& asked) {
  if (asked.id.size() > kLongestShown) return "say yourself which device you want: --probe NAME=device:ID";
  return "where you want that, say so yourself: --probe " + quoted(asked.moves + "=device:" + asked.id);
}

}  // namespace pliant
