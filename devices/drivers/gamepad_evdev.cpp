#include "devices/drivers/gamepad_evdev.h"

#include <dirent.h>
#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "devices/ports/hid_port.h"
#include "devices/ports/newest_writer.h"

namespace pliant {
namespace {

constexpr std::uint16_t kShakesFor = 500;  // [ms] duration of an effect: it ends if we stop renewing it

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// sysfs prints a bitmap as hexadecimal words, the highest first.
class Bits {
 public:
  explicit Bits(const std::string& text) {
    std::istringstream in(text);
    for (std::string word; in >> word;) words_.insert(words_.begin(), std::strtoul(word.c_str(), nullptr, 16));
  }
  bool operator[](std::size_t bit) const {
    constexpr std::size_t kWord = 8 * sizeof(unsigned long);
    return bit / kWord < words_.size() && (words_[bit / kWord] >> bit % kWord & 1);
  }

 private:
  std::vector<unsigned long> words_;
};

// Returns false if it is not a gamepad.
bool read_traits(const std::string& folder, GamepadTraits& traits) {
  const Bits axes(first_line(folder + "/capabilities/abs")), keys(first_line(folder + "/capabilities/key")),
      effects(first_line(folder + "/capabilities/ff"));
  for (std::size_t i = 0; i < traits.axes.size(); ++i) traits.axes[i].there = axes[i];
  bool plays = false;
  for (std::uint16_t code = BTN_JOYSTICK; code < BTN_DIGI; ++code) plays = plays || keys[code];
  for (std::uint16_t code = BTN_MISC; code < KEY_MAX && traits.key_count < traits.keys.size(); ++code)
    if (keys[code]) traits.keys[traits.key_count++] = code;
  traits.rumble = effects[FF_RUMBLE];
  traits.constant = effects[FF_CONSTANT];
  traits.name = first_line(folder + "/name");
  return plays && axes[ABS_X] && axes[ABS_Y];
}

class EvdevLine final : public GamepadLine {
 public:
  EvdevLine(int file, std::string path, const GamepadTraits& traits)
      : file_(file), path_(std::move(path)), traits_(traits), writer_(std::in_place, Play{this}) {}
  ~EvdevLine() override {
    writer_.reset();  // its last output is written
    for (const int id : {rumble_.id, constant_.id})
      if (id >= 0) ::ioctl(file_, EVIOCRMFF, id);
    ::close(file_);
  }

  const GamepadTraits& traits() const override { return traits_; }
  Result<std::size_t> read(std::span<GamepadEvent> into) override {
    std::array<input_event, 64> events;
    const std::size_t most = std::min(into.size(), events.size());
    const ssize_t bytes = ::read(file_, events.data(), most * sizeof(input_event));
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t(0);
    if (bytes <= 0 || writer_->failed()) return Error{traits_.name, "is gone; plug it in again"};
    const std::size_t count = static_cast<std::size_t>(bytes) / sizeof(input_event);
    for (std::size_t i = 0; i < count; ++i) into[i] = {events[i].type, events[i].code, events[i].value};
    return count;
  }
  Status whole_state(GamepadState& state) override {
    state = {};
    for (std::size_t code = 0; code < traits_.axes.size(); ++code) {
      input_absinfo info{};
      if (traits_.axes[code].there && ::ioctl(file_, EVIOCGABS(code), &info) == 0) state.axes[code] = info.value;
    }
    std::array<unsigned char, KEY_MAX / 8 + 1> keys{};
    if (::ioctl(file_, EVIOCGKEY(keys.size()), keys.data()) < 0)
      return Error{traits_.name, "is gone; plug it in again"};
    for (std::size_t i = 0; i < traits_.key_count; ++i)
      if (keys[traits_.keys[i] / 8] >> traits_.keys[i] % 8 & 1) state.buttons |= 1u << i;
    return Done{};
  }
  Status render(const GamepadOutput& output) override {
    if (writer_->failed()) return Error{traits_.name, "is gone; plug it in again"};
    writer_->give([&](GamepadOutput& next) { next = output; });
    return Done{};
  }
  std::string node() const override { return path_; }
  // The end of what plays. Where nothing ever has, an event without meaning: a file that a guard process holds is not
  // closed with this program, which would end what plays as well.
  bool safe_line(SafeLine& line) const override {
    std::array<input_event, 2> events{};
    std::size_t count = 0;
    for (const std::atomic<int>* playing : {&rumbles_, &pushes_})
      if (const int id = *playing; id >= 0) {
        events[count].type = EV_FF;
        events[count++].code = static_cast<std::uint16_t>(id);
      }
    if (count == 0) count = 1;  // EV_SYN, SYN_REPORT
    line.descriptor = file_;
    line.size = count * sizeof(input_event);
    std::memcpy(line.bytes.data(), events.data(), line.size);
    return true;
  }

 private:
  struct Play {
    EvdevLine* line;
    bool operator()(const GamepadOutput& output) const { return line->play(output); }
  };

  // An effect with an id is updated while it plays.
  bool play(const GamepadOutput& output) {
    bool done = true;
    if (traits_.rumble && (output.strong || output.weak || rumble_.id >= 0)) {
      rumble_.u.rumble.strong_magnitude = output.strong;
      rumble_.u.rumble.weak_magnitude = output.weak;
      done = start(rumble_, output.strong || output.weak) && done;
      rumbles_ = rumble_.id;
    }
    if (traits_.constant && (output.level || constant_.id >= 0)) {
      constant_.u.constant.level = output.level;
      constant_.direction = output.direction;
      done = start(constant_, output.level != 0) && done;
      pushes_ = constant_.id;
    }
    return done;
  }
  bool start(ff_effect& effect, bool plays) {
    if (::ioctl(file_, EVIOCSFF, &effect) < 0) return errno == EAGAIN || errno == EINTR || errno == ENOSPC;
    input_event event{};
    event.type = EV_FF;
    event.code = static_cast<std::uint16_t>(effect.id);
    event.value = plays ? 1 : 0;
    return ::write(file_, &event, sizeof event) == sizeof event;
  }
  static ff_effect effect_of(std::uint16_t type) {
    ff_effect effect{};
    effect.type = type;
    effect.id = -1;
    effect.replay.length = kShakesFor;
    return effect;
  }

  int file_;
  std::string path_;
  GamepadTraits traits_;
  ff_effect rumble_ = effect_of(FF_RUMBLE), constant_ = effect_of(FF_CONSTANT);
  std::atomic<int> rumbles_{-1}, pushes_{-1};                // the effects' ids, as the device has given them
  std::optional<NewestWriter<GamepadOutput, Play>> writer_;  // last: its thread uses all of the above
};

}  // namespace

std::vector<GamepadFound> find_gamepads() {
  std::vector<GamepadFound> found;
  DIR* const folder = ::opendir("/sys/class/input");
  if (!folder) return found;
  std::vector<std::string> events;
  while (const dirent* entry = ::readdir(folder))
    if (const std::string name = entry->d_name; name.starts_with("event")) events.push_back(name);
  ::closedir(folder);
  std::sort(events.begin(), events.end(),
            [](const auto& a, const auto& b) { return a.size() != b.size() ? a.size() < b.size() : a < b; });
  for (const std::string& event : events) {
    GamepadFound one;
    const std::string device = "/sys/class/input/" + event + "/device";
    if (!read_traits(device, one.traits)) continue;
    one.path = "/dev/input/" + event;
    one.id = first_line(device + "/uniq");
    one.hardware = first_line(device + "/id/vendor") + ":" + first_line(device + "/id/product") + ":" + one.id;
    if (one.id.empty()) one.id = one.path;
    const int file = ::open(one.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
      one.missing = cure_for_open(one.path, errno);
    else
      ::close(file);
    found.push_back(std::move(one));
  }
  return found;
}

Result<std::unique_ptr<GamepadLine>> open_gamepad(const std::string& id) {
  std::string ids, missing;
  for (const GamepadFound& found : find_gamepads()) {
    ids += (ids.empty() ? "" : ", ") + found.id;
    if (!id.empty() && id != found.id && id != found.path) continue;
    const int file = ::open(found.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
      if (missing.empty()) missing = cure_for_open(found.path, errno);
      continue;
    }
    GamepadTraits traits = found.traits;
    for (std::size_t code = 0; code < traits.axes.size(); ++code) {
      input_absinfo info{};
      if (!traits.axes[code].there || ::ioctl(file, EVIOCGABS(code), &info) < 0) continue;
      traits.axes[code].min = info.minimum;
      traits.axes[code].max = info.maximum;
    }
    return std::unique_ptr<GamepadLine>(std::make_unique<EvdevLine>(file, found.path, traits));
  }
  const std::string where = id.empty() ? "gamepad" : "gamepad `" + id + "`";
  if (!missing.empty()) return Error{where, missing};
  return Error{where, ids.empty() ? "none is there; plug it in and switch it on" : "is not there; there are: " + ids};
}

}  // namespace pliant
