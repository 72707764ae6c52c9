#include "engine/run/device_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include "devices/choose.h"
#include "devices/wrappers/chain.h"
#include "engine/run/sources.h"
#include "engine/run/stiffness_note.h"
#include "runtime/has_threads.h"
#include "systems/device/devices.h"
#include "systems/device/hands.h"

namespace pliant {

namespace {

std::string name_in(const World& world, Entity hand) {
  const Name* const named = world.registry.find<Name>(hand);
  return named ? named->value : std::string();
}

// A device being opened, by a thread that may outlive the caller.
struct Opening {
  std::vector<DeviceInfo> there;
  Result<DeviceChoice> chosen = Error{};
  Result<DeviceChain> made = Error{};
  DriverLink link;
  Status done = Done{};
};

// Runs `work` on a separate thread, where there are threads. Returns false if `stop` became true first.
bool does(const std::function<void()>& work, const std::function<bool()>& stop) {
  if (!kHasThreads) return work(), true;
  std::packaged_task<void()> task(work);
  std::future<void> done = task.get_future();
  std::thread(std::move(task)).detach();
  while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
    if (stop()) return false;
  done.get();
  return true;
}

void open_request(Opening& opening, const std::string& request, bool list) {
  if (list) opening.there = list_devices();
  opening.chosen = choose_device(request, opening.there);
  if (!opening.chosen || opening.chosen->id.empty()) return;
  const std::string& id = opening.chosen->id;
  opening.made = make_device(id);
  if (opening.made)
    opening.done = opening.link.connect(std::move(opening.made->driver), opening.made->id, "device `" + id + "`", id);
}

}  // namespace

void DeviceLinks::begin(World& world, Held opened, dvec3 middle, std::vector<std::string>& notes) {
  HapticDevice& device = world.registry.get<HapticDevice>(opened.device);
  device.path = {};
  device.status = DeviceStatus::kLost;
  opened.link.begin(device, device.rotation, middle);
  begin_anew(world, opened.hand);
  if (const std::optional<Note> stiff = stiffness_note(world, opened.hand, opened.name))
    notes.push_back(stiff->message());
  if (!opened.link.note().empty()) notes.push_back(fmt::format("`{}`: {}", opened.name, opened.link.note()));
  links_.push_back(std::move(opened));
}

Status DeviceLinks::open(World& world, SimulatedHands& held, bool windowed, const std::function<bool()>& stop,
                         std::vector<std::string>& notes) {
  for (SimulatedHands::Held& one : held.held()) {
    const Entity device = device_of(world, one.hand);
    Held opened{name_in(world, one.hand), one.hand,  device, {}, world.registry.get<HapticDevice>(device).id,
                "a simulated hand",       one.device};
    if (Status s = opened.link.connect(std::move(one.driver), "", "--probe " + opened.name); !s) return s;
    begin(world, std::move(opened), one.middle, notes);
  }
  std::vector<DeviceInfo> there;
  bool listed = false;
  for (const Entity hand : hands(world)) {
    if (!find_device(world, hand) || held.moves(hand)) continue;
    HapticDevice& device = world.registry.get<HapticDevice>(device_of(world, hand));
    if (device.driver != DriverKind::kExternal || device.id.empty()) continue;
    const std::string name = name_in(world, hand);
    const auto opening = std::make_shared<Opening>();
    opening->there = there;
    if (!does([opening, request = device.id, list = !listed] { open_request(*opening, request, list); }, stop)) {
      gave_up_ = true;
      return Error{"probe `" + name + "`", "its device was still being opened when the run was interrupted"};
    }
    there = opening->there;
    listed = true;
    const Result<DeviceChoice>& chosen = opening->chosen;
    if (!chosen) return Error{"probe `" + name + "`", chosen.error().message()};
    for (const std::string& sentence : chosen->notes) notes.push_back(fmt::format("`{}`: {}", name, sentence));
    if (chosen->id.empty()) {
      if (!windowed)
        return Error{"probe `" + name + "`", "the mouse would move it, and needs a window",
                     "set DISPLAY, or plug in a device"};
      device.driver = DriverKind::kMouse;
      continue;
    }
    const Result<DeviceChain>& made = opening->made;
    if (!made) return made.error();
    for (const std::string& sentence : made->notes) notes.push_back(fmt::format("`{}`: {}", name, sentence));
    if (!opening->done) return opening->done;
    Held opened{name, hand, device_of(world, hand), std::move(opening->link), chosen->id, chosen->name, nullptr};
    device.id = chosen->id;
    begin(world, std::move(opened), place_of(world, hand), notes);
  }
  for (const Entity hand : hands(world)) {
    const Name* const named = world.registry.find<Name>(hand);
    if (!moves(hand)) others_.push_back({named ? named->value : std::string(), describe_source(world, hand)});
  }
  for (DeviceInfo& device : there)
    if (!device.missing.empty()) unusable_.push_back(std::move(device));
  return Done{};
}

bool DeviceLinks::any_real() const {
  return std::any_of(links_.begin(), links_.end(), [](const Held& held) { return !held.simulated; });
}

void DeviceLinks::use_clock(DeviceClock clock) {
  for (Held& held : links_)
    if (held.simulated) held.simulated->use_clock(clock);
}

bool DeviceLinks::moves(Entity hand) const {
  return std::any_of(links_.begin(), links_.end(), [&](const Held& held) { return held.hand == hand; });
}

Status DeviceLinks::may_step() const {
  for (const Held& held : links_)
    if (Status s = held.link.may_step(); !s) return s;
  return Done{};
}

TickPart DeviceLinks::tick_part(World& world) {
  TickPart made;
  made.before = [this, &world](Tick tick) {
    for (Held& held : links_) held.link.read(world.registry.get<HapticDevice>(held.device), tick);
  };
  made.after = [this, &world](Tick tick) {
    for (Held& held : links_) held.link.write(world, held.hand, held.device, tick);
  };
  made.idle = [this](Tick) {
    for (Held& held : links_) held.link.idle(), held.link.forget();
  };
  made.end = [this] {
    for (Held& held : links_) held.link.zero();
  };
  made.start = [this] { return start(); };
  made.halt = [this] { halt(); };
  return made;
}

Status DeviceLinks::start() {
  for (Held& held : links_)
    if (Status s = held.link.start(); !s) {
      halt();
      return s;
    }
  return Done{};
}

void DeviceLinks::halt() noexcept {
  for (Held& held : links_) held.link.halt();
}

void DeviceLinks::view(DevicesView& out) {
  out.devices.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i)
    out.devices[i] = {links_[i].name, links_[i].id, links_[i].called, links_[i].link.can(), links_[i].link.report()};
  out.others = others_;
  out.unusable = unusable_;
}

void DeviceLinks::order(const DeviceOrders& orders) {
  const auto each = [&](const std::vector<std::string>& names, void (DriverLink::*what)()) {
    for (Held& held : links_)
      if (std::find(names.begin(), names.end(), held.name) != names.end()) (held.link.*what)();
  };
  each(orders.arm, &DriverLink::arm);
  each(orders.disarm, &DriverLink::disarm);
  each(orders.stop, &DriverLink::stop);
  if (orders.stop_all) stop_all();
}

void DeviceLinks::stop_all() {
  for (Held& held : links_) held.link.stop();
}

bool DeviceLinks::never_ready(Entity hand) {
  for (Held& held : links_)
    if (held.hand == hand && !held.simulated) {
      const DeviceReport& report = held.link.report();
      return report.figures.periods > 0 && report.figures.samples == report.dropped.not_ready;
    }
  return false;
}

namespace {

// Findings for a device that could not be used.
void find_unused(const std::string& name, const DeviceReport& report, std::vector<Note>& all) {
  const std::string who = "device of `" + name + "`: ";
  const auto add = [&](const char* code, const std::string& what, const std::string& cure) {
    all.push_back({who + what, cure, code, name});
  };
  const std::uint64_t samples = report.figures.samples, not_ready = report.dropped.not_ready;
  if (const std::string frames = describe(report.dropped); !frames.empty())
    add("device.frames",
        fmt::format("not everything that it sent could be used, but {} frames or lines were dropped: {}",
                    report.dropped.dropped(), frames),
        cure_for(report.dropped));
  if (samples > 0 && not_ready == samples)
    add("device.not_ready",
        fmt::format("it was not ready for the whole run ({} samples, and each says that its state is not known)",
                    samples),
        "calibrate or home it, release its emergency stop, let it cool");
  else if (not_ready > 0)
    add("device.not_ready", fmt::format("{} of {} samples say that it is not ready", not_ready, samples),
        "nothing was felt meanwhile");
  if (samples == 0 && report.figures.periods > 0)
    add("device.silent", "no sample came in the whole run", "check that it is switched on and sends where it is");
}

}  // namespace

std::vector<Note> DeviceLinks::findings() {
  std::vector<Note> all;
  for (Held& held : links_) {
    if (std::optional<Note> late = held.link.late_note(held.name)) all.push_back(std::move(*late));
    const DeviceReport& report = held.link.report();
    if (!held.simulated) find_unused(held.name, report, all);
    std::uint64_t worse = 0;
    std::string last;
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(report.transitions, DeviceReport::kKept); ++i) {
      const DeviceTransition& one = report.transition(i);
      const bool lost = one.from == DeviceState::kActive && one.cause != DeviceCause::kLetGo &&
                        one.cause != DeviceCause::kClosed && one.cause != DeviceCause::kDisarmed;
      if (!lost && one.to != DeviceState::kTripped) continue;
      ++worse;
      last = describe(one);
    }
    const std::string who = "device of `" + held.name + "`: ";
    if (worse > 0)
      all.push_back({worse == 1
                         ? who + last
                         : fmt::format("{}its force was taken away {} times, the last time: {}", who, worse, last),
                     {},
                     "device.lost",
                     held.name});
    if (report.figures.missed > 0)
      all.push_back({fmt::format("{}{} of {} periods of its servo began late ({:.0f} us at most)", who,
                                 report.figures.missed, report.figures.periods, report.figures.period_max),
                     "close other programs, or grant SCHED_FIFO (`ulimit -r`)", "device.servo_late", held.name});
  }
  return all;
}

}  // namespace pliant
