// Uneven time: missed ticks; samples that are early, late or absent; stalls.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include "engine/session/session_world.h"
#include "lab/study/hard/hard_case.h"
#include "runtime/clock.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"

namespace pliant {
namespace {

constexpr double kStall = 0.05;  // [s]

// The clock misses ticks, and the device is sampled irregularly: some poses are old, some ticks have none, some have
// two, of which the later one counts.
HardFigure uneven_ticks(const HardSetting&) {
  HardFigure worst;
  std::mt19937 random(5);
  const auto share = [&] { return std::uniform_real_distribution(0.0, 1.0)(random); };
  Stage stage;
  stage.add(scenes::sphere(20, 0.1), frictionless());
  constexpr double kPath = 6.0;  // [s]
  const auto path = [](double t) {
    const double a = 0.4 * std::sin(2 * M_PI * t / kPath);
    return (0.1 + 0.003 * std::cos(2 * M_PI * t)) * dvec3(std::sin(a), std::cos(a), 0);
  };
  const Entity probe = stage.add_probe(path(0));
  stage.prepare();
  RawMeter meter;
  scenes::WorkMeter sent;
  double sensed_at = 0.0;
  int missed = 0, without = 0, twice = 0;
  while (stage.time() < kPath) {
    if (share() < 0.1) {
      const auto ticks = static_cast<std::uint64_t>(1 + 8 * share());
      stage.skip(ticks);
      missed += static_cast<int>(ticks);
    }
    if (share() > 0.1 || stage.time() - sensed_at > 0.5 * kStaleAfter) {
      if (share() < 0.3) stage.place(probe, path(sensed_at + share() * (stage.time() - sensed_at))), ++twice;
      sensed_at = std::max(sensed_at, stage.time() - 1e-3 * share());
      stage.place(probe, path(std::min(sensed_at, kPath)));
    } else {
      ++without;
    }
    stage.tick(stage.time() - sensed_at);
    meter.add(stage, probe, stage.read(probe).position);
    sent.add(stage.read(probe));
    worst.need(std::isfinite(length(raw_force(stage, probe))), "the force");
    worst.need(length(stage.read(probe).force - raw_force(stage, probe)) < 1e-12, "what is sent is not the force");
  }
  stage.place(probe, path(kPath));
  stage.tick();
  meter.add(stage, probe, path(kPath));
  worst.need((stage.world.dropped & (kDroppedJump | kDroppedStale | kDroppedNonFinite)) == 0, "a pose was dropped");
  worst.need(meter.most > 1e-4, "it was not pressed");
  worst.add(meter.work / meter.most);
  worst.looked_at(fmt::format("{} ticks missed, {} without a sample, {} with two", missed, without, twice));
  return worst;
}

// The force sent to a device with limits around a stall of the touch clock.
class Sent {
 public:
  Sent(HardFigure& worst, double slew, double dt)
      : worst_(worst), rise_(slew * dt), change_(std::max(slew, kLeastFall) * dt) {}
  // The larger of two ratios: the increase of the magnitude over the slew limit, and any change over the limit of
  // release.
  void add(dvec3 force, const std::string& where) {
    worst_.need(std::isfinite(length(force)), where + ": no number");
    const double rise = length(force) - length(last_);
    if (started_) worst_.add(std::max(rise / rise_, length(force - last_) / change_), where);
    last_ = force;
    started_ = true;
  }
  // A force that was not renewed for kForceHolds has ended.
  void let_go() { last_ = dvec3(0); }
  dvec3 last() const { return last_; }

 private:
  HardFigure& worst_;
  double rise_, change_;  // [N] in a tick
  dvec3 last_{0};
  bool started_ = false;
};

// The clock misses 49 ticks during a press. Meanwhile the hand has moved deeper, or out of the surface.
HardFigure stalled_ticks(const HardSetting&) {
  HardFigure worst;
  for (const bool out : {false, true})
    for (const double contact_damping : {0.0, 3.0})
      for (const double friction : {0.0, 0.3}) {
        const std::string where = fmt::format("{}, damping {:g} N s/m, friction {:g}", out ? "leaves" : "presses on",
                                              contact_damping, friction);
        Stage stage;
        Deformable d = frictionless();
        d.contact_damping = contact_damping;
        d.friction_static = d.friction_sliding = friction;
        stage.add(scenes::sheet(20, 0.2), d);
        const Entity probe = stage.add_probe({-0.02, 0.001, 0});
        HapticDevice& device = stage.device(probe);
        device.max_force = 3.3;
        device.max_slew = 200;
        stage.prepare();
        Sent sent(worst, device.max_slew, stage.dt());
        const auto look = [&](const ProbeReading& r) { sent.add(r.force, where); };
        stage.move(probe, {-0.02, -0.004, 0}, 0.2, look);
        worst.need(std::abs(sent.last().y - law(d, 0.004)) < 0.1 * law(d, 0.004), where + ": not pressed");
        const dvec3 to = out ? dvec3(0, 0.005, 0.01) : dvec3(0, -0.006, 0.01);
        stage.skip(static_cast<std::uint64_t>(std::lround(kStall / stage.dt())) - 1);
        sent.let_go();
        stage.move(probe, to, stage.dt(), look);
        worst.need(!out || sent.last() == dvec3(0), where + ": a force in free air");
        worst.need((stage.world.dropped & (kDroppedJump | kDroppedStale)) == 0, where + ": it counted as a jump");
        worst.need(stage.read(probe).in_contact != out, where + ": the contact");
        for (int i = 0; i < 20; ++i) {
          stage.tick();
          look(stage.read(probe));
        }
        worst.need(std::abs(sent.last().y - (out ? 0.0 : law(d, 0.006))) < 1e-6, where + ": not back to the law");
        worst.need(friction > 0 || std::hypot(sent.last().x, sent.last().z) < 1e-6, where + ": sideways");
      }
  return worst;
}

// No sample arrived during the stall either: the pose is old in the first tick after it.
HardFigure stalled_samples(const HardSetting&) {
  HardFigure worst;
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sheet(20, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.move(probe, {0, -0.004, 0}, 0.2);
  worst.need(std::abs(stage.read(probe).force.y - law(d, 0.004)) < 1e-6, "not pressed");
  stage.skip(static_cast<std::uint64_t>(std::lround(kStall / stage.dt())) - 1);
  stage.tick(kStall);
  worst.add(length(stage.read(probe).force), "an old pose");
  worst.need((stage.world.dropped & kDroppedStale) != 0, "nothing said so");
  stage.move(probe, {0, -0.006, 0}, 0.1,
             [&](const ProbeReading& r) { worst.add(length(r.force), "the gate is shut"); });
  stage.move(probe, {0, 0.001, 0}, 0.1);
  stage.move(probe, {0, -0.004, 0}, 0.2);
  worst.need(std::abs(stage.read(probe).force.y - law(d, 0.004)) < 1e-6, "the force stayed away");
  return worst;
}

// A device in a hand that moves to its target at 50 mm/s of real time, with a record of all written forces.
struct RealHand {
  struct Write {
    std::uint64_t ns;
    dvec3 force;
  };
  std::atomic<double> target{0.002};  // [m] height
  std::atomic<double> force{0.0};     // [N] upwards, last written
  double rate = 0.0;
  std::vector<Write> writes;  // owned by the writing thread until it has ended
};
class RealDevice final : public Driver {
 public:
  explicit RealDevice(RealHand& hand) : hand_(hand) { hand.writes.reserve(100'000); }
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return {.max_force = 3.3, .rate = hand_.rate}; }
  bool read(DeviceSample& sample) override {
    const std::uint64_t now = now_ns();
    const double most = at_ > 0 ? 0.05e-9 * static_cast<double>(now - at_) : 0.0, to = hand_.target;
    at_ = now;
    height_ += std::clamp(to - height_, -most, most);
    // The hand trembles slightly.
    tremor_ = -tremor_;
    sample.position = {0, height_ + tremor_, 0};
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    if (hand_.writes.size() < hand_.writes.capacity()) hand_.writes.push_back({now_ns(), wrench.force});
    hand_.force = wrench.force.y;
  }
  void close() override {}

 private:
  RealHand& hand_;
  std::uint64_t at_ = 0;
  double height_ = 0.002, tremor_ = 1e-8;
};

template <class Done>
bool within(double seconds, Done done) {
  for (const std::uint64_t begin = now_ns(); !done(); std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    if (ms_since(begin) > 1e3 * seconds) return false;
  return true;
}

constexpr double kLate = 6.0;  // [ms] between two ticks, or two servo periods: above it the machine itself was late
constexpr int kTries = 5;

enum class RealRun : std::uint8_t { kJudged, kLateElsewhere };

// Figures around a stall.
struct StallSeen {
  bool held = false, fell = true, shut = true, back = false, left = false, missed = false;
  bool stopped = false;
  std::uint64_t begin = 0;  // [ns]
  std::atomic<int> late{0};
};

// Starts the clocks. The hand presses, the touch clock is blocked for kStall, the hand presses on and leaves. With a
// servo it leaves and comes back before that, because the force has ended.
Status play_stall(Session& session, RealHand& hand, double stiffness, bool servo, StallSeen& seen) {
  std::atomic<bool> stall{false};
  std::atomic<std::uint64_t> stalled{0};  // [tick]
  std::uint64_t before = 0;
  on_tick(session, [&](Tick tick) {
    if (before > 0 && 1e3 * static_cast<double>(tick.index - before) * tick.dt > kLate && stalled != before)
      ++seen.late;
    before = tick.index;
    if (!stall.exchange(false)) return;
    stalled = tick.index;
    std::this_thread::sleep_for(std::chrono::duration<double>(kStall));
  });
  const auto force_is = [&](double depth) {
    return within(3.0, [&] { return std::abs(hand.force - stiffness * depth) < 1e-3; });
  };
  const auto let_go = [&] { return within(3.0, [&] { return hand.force == 0.0; }); };
  const Status started = session.start();
  hand.target = -0.004;
  seen.held = force_is(0.004);
  hand.target = -0.006;
  seen.begin = now_ns();
  stall = true;
  seen.held = within(1.0, [&] { return stalled > 0; }) && seen.held;
  if (servo) seen.fell = let_go();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  if (servo) {
    seen.shut = hand.force == 0.0;
    hand.target = 0.002;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    hand.target = -0.006;
  }
  seen.back = force_is(0.006);
  hand.target = 0.002;
  seen.left = let_go();
  seen.stopped = session.stop().ok();
  seen.missed = session.figures().overruns >= 40;
  for (std::size_t i = 1; servo && i < hand.writes.size(); ++i)
    seen.late += 1e-6 * static_cast<double>(hand.writes[i].ns - hand.writes[i - 1].ns) > kLate;
  return started;
}

// With a servo, no force is sent once the last tick's model is no longer valid (kModelHolds).
void judge_servo(const std::vector<RealHand::Write>& writes, std::uint64_t begin, const std::string& where,
                 HardFigure& worst) {
  for (const RealHand::Write& write : writes) worst.need(std::isfinite(length(write.force)), where + ": a number");
  for (const RealHand::Write& write : writes) {
    const double since = 1e-9 * (static_cast<double>(write.ns) - static_cast<double>(begin));
    if (since > 0.02 && since < 0.2) worst.need(write.force == dvec3(0), where + ": a force that nobody renews");
  }
}

void judge_ticks(const std::vector<RealHand::Write>& writes, double slew, const std::string& where, HardFigure& worst) {
  Sent sent(worst, slew, 1e-3);
  std::uint64_t before = 0;
  for (const RealHand::Write& write : writes) {
    if (before > 0 && 1e-9 * static_cast<double>(write.ns - before) > kForceHolds) sent.let_go();
    before = write.ns;
    sent.add(write.force, where);
  }
}

// The clocks of a session run; the touch clock is blocked for 50 ms. Without a servo the first tick after it continues.
// With a servo the device is released as soon as the model is old, and its force must end too.
RealRun real_stall(HardFigure& worst, double rate) {
  const bool servo = rate > 0;
  const std::string where = servo ? "servo" : "no servo";
  RealHand hand;  // outlives the session, which writes zero at its end
  hand.rate = rate;
  Scene scene;
  const Primitive sheet = scenes::sheet(20, 0.2);
  DeformableParameters surface = frictionless();
  scene.add_surface("sheet", {sheet.position, sheet.index}, surface);
  DeviceParameters limits;
  limits.max_slew = 200;
  scene.add_probe("finger", {}, limits);
  StallSeen seen;  // outlives the session's clocks
  auto session = Session::open(scene);
  worst.need(session.ok(), where + ": it does not open");
  if (!session) return RealRun::kJudged;
  worst.need(session->connect("finger", std::make_unique<RealDevice>(hand)).ok(), where + ": it does not connect");
  worst.need(play_stall(*session, hand, surface.stiffness, servo, seen).ok(), where + ": it does not start");
  if (seen.late > 0) return RealRun::kLateElsewhere;  // delayed by the machine itself
  worst.need(seen.stopped, where + ": it does not stop");
  worst.need(seen.held, where + ": the law before it");
  worst.need(seen.missed, where + ": there was no stall");
  worst.need(seen.fell, where + ": the force stays while nobody renews it");
  worst.need(seen.shut, where + ": the force comes back by itself");
  worst.need(seen.back, where + ": not back to the law");
  worst.need(seen.left, where + ": a force in free space");
  if (servo)
    judge_servo(hand.writes, seen.begin, where, worst);
  else
    judge_ticks(hand.writes, limits.max_slew, where, worst);
  worst.need(!hand.writes.empty() && hand.writes.back().force == dvec3(0), where + ": the last force is not zero");
  return RealRun::kJudged;
}

HardFigure stalled_session(const HardSetting&) {
  HardFigure worst;
  for (const double rate : {0.0, 1000.0}) {
    int tries = 0;
    while (real_stall(worst, rate) == RealRun::kLateElsewhere && ++tries < kTries) {
    }
    if (tries == kTries)
      worst.absent(fmt::format("a machine whose clocks are not late by {:g} ms by themselves", kLate));
  }
  return worst;
}

}  // namespace

std::vector<HardCase> hard_time() {
  constexpr const char* kStallEntry = "methods.md 3.9: a 50 ms stall";
  return {
      {"TicksThatAreMissedAndSamplesThatJitterGiveOutNoEnergy", "methods.md 3.9: dt jitter",
       "up to 8 ticks missed, samples up to 5 ms old, none or two in a tick: work of the raw force over a closed path, "
       "the same as is sent",
       "of the stored energy [1]", 1e-3, uneven_ticks},
      {"AfterAStallTheForceGoesOnWithinItsSlewLimit", kStallEntry,
       "the hand presses on or leaves, contact damping and friction with and without: largest change of what is sent "
       "in a tick, from none, as the device has let go; none at once in free air; back to the law within 20 ms; no "
       "jump "
       "counted",
       "of the limit [1]", 1 + 1e-9, stalled_ticks},
      {"AStallWithoutSamplesEndsTheForceUntilTheHandLetsGo", kStallEntry,
       "none at once and while the gate is shut, said so, then the law", "N", 0, stalled_samples},
      {"ARealTimeSessionSurvivesAStallOfItsTouchClock", kStallEntry,
       "without a servo: change of what a driver is written in a tick, from none after 20 ms, back to the law. With a "
       "servo: nothing leaves "
       "while the model is old and until the hand lets go, then the law",
       "of the slew limit [1]", 1 + 1e-9, stalled_session},
  };
}

}  // namespace pliant
