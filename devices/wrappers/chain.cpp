#include "devices/wrappers/chain.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "devices/spec.h"
#include "devices/wrappers/delay.h"
#include "devices/wrappers/drop.h"
#include "devices/wrappers/gain.h"
#include "devices/wrappers/jitter.h"
#include "devices/wrappers/quantise.h"
#include "devices/wrappers/record.h"
#include "devices/wrappers/refound.h"
#include "devices/wrappers/replay.h"
#include "devices/wrappers/workspace.h"

namespace pliant {
namespace {

constexpr double kLargestGain = 1e3;
constexpr std::size_t kMostWrappers = 12;

// The options of one wrapper. Each query specifies the allowed values; the first invalid one is the error.
struct Words {
  std::string name, value, where;
  std::map<std::string, std::string> keys;
  std::optional<Error> wrong;

  using Reader = std::optional<double> (*)(std::string_view);
  double read(const std::string& text, Reader reader, double least, double most, const std::string& what) {
    const std::optional<double> number = reader(text);
    if (number && *number >= least && *number <= most) return *number;
    if (!wrong) wrong = Error{where, fmt::format("must be {}; got '{}'", what, text)};
    return least;
  }
  double first(Reader reader, double least, double most, const std::string& what) {
    return read(value, reader, least, most, what);
  }
  double key(const std::string& key, Reader reader, double least, double most, double otherwise,
             const std::string& what) {
    const auto found = keys.find(key);
    if (found == keys.end()) return otherwise;
    const std::string text = found->second;
    keys.erase(found);
    return read(text, reader, least, most, key + "= " + what);
  }
};

using Driven = std::unique_ptr<Driver>;
using Maker = Result<Driven> (*)(Driven, Words&, std::vector<std::string>&);

Result<Driven> checked(Words& words, Driven made) {
  if (words.wrong) return *words.wrong;
  if (!words.keys.empty()) return Error{words.where, "unknown key '" + words.keys.begin()->first + "'", "leave it out"};
  return made;
}

std::uint64_t seed_of(Words& words) {
  return static_cast<std::uint64_t>(
      std::llround(words.key("seed", plain_number, 0.0, 1e15, 1.0, "must be a whole number from 0")));
}

Result<Driven> make_record(Driven inner, Words& words, std::vector<std::string>&) {
  if (words.value.empty()) return Error{words.where, "must name a file", "write record=FILE"};
  const double seconds = words.key("seconds", seconds_of, 1e-3, Record::kMost, 60.0, "must be a time up to 3600");
  return checked(words, std::make_unique<Record>(std::move(inner), words.value, seconds));
}

Result<Driven> make_replay(Driven inner, Words& words, std::vector<std::string>&) {
  auto rows = read_poses(words.value);
  if (!rows) return rows.error();
  return checked(words, std::make_unique<Replay>(std::move(inner), std::move(rows).value()));
}

// A bare number counts samples; then both options do.
Result<Driven> make_delay(Driven inner, Words& words, std::vector<std::string>&) {
  DelayParameters delay;
  delay.samples = plain_number(words.value).has_value();
  const double most = delay.samples ? 1e5 : Delay::kMost;
  const char* what = delay.samples ? "samples, at most 100000" : "a time up to 10s, as 5ms, or a number of samples";
  if (const auto written = words.keys.find("written");
      written != words.keys.end() && plain_number(written->second).has_value() != delay.samples)
    return Error{words.where, "says one delay in samples and one in seconds", "give both in the same unit"};
  delay.sensed = words.first(seconds_of, 0.0, most, what);
  delay.written = words.key("written", seconds_of, 0.0, most, 0.0, std::string("must be ") + what);
  return checked(words, std::make_unique<Delay>(std::move(inner), delay));
}

Result<Driven> make_jitter(Driven inner, Words& words, std::vector<std::string>&) {
  const double most = words.first(seconds_of, 0.0, Jitter::kMost, "a time up to 10s, as 2ms");
  const std::uint64_t seed = seed_of(words);
  return checked(words, std::make_unique<Jitter>(std::move(inner), most, seed));
}

Result<Driven> make_drop(Driven inner, Words& words, std::vector<std::string>&) {
  const double sensed = words.first(share_of, 0.0, 1.0, "a share from 0% to 100%");
  const double written = words.key("written", share_of, 0.0, 1.0, 0.0, "must be a share from 0% to 100%");
  const std::uint64_t seed = seed_of(words);
  return checked(words, std::make_unique<Drop>(std::move(inner), sensed, written, seed));
}

Result<Driven> make_quantise(Driven inner, Words& words, std::vector<std::string>&) {
  const double position = words.first(metres_of, 0.0, 1.0, "a length up to 1m, as 0.1mm");
  const double force = words.key("force", newtons_of, 0.0, 100.0, 0.0, "must be a force, as 5mN");
  return checked(words, std::make_unique<Quantise>(std::move(inner), position, force));
}

Result<Driven> make_gain(Driven inner, Words& words, std::vector<std::string>& notes) {
  const double motion = words.first(plain_number, 1.0 / kLargestGain, kLargestGain, "a number from 0.001 to 1000");
  const double force = words.key("force", plain_number, 1.0 / kLargestGain, kLargestGain,
                                 words.name == "scale" ? 1.0 : motion, "must be a number from 0.001 to 1000");
  if (motion != force && !words.wrong)
    notes.push_back(
        fmt::format("{}: does not keep power: the hand does {:.3g} times the work that the world takes, and "
                    "feels it {:.3g} times as stiff; gain={:g} keeps power",
                    words.where, force / motion, motion * force, motion));
  return checked(words, std::make_unique<Gain>(std::move(inner), motion, force));
}

Result<Driven> make_frame(Driven inner, Words& words, std::vector<std::string>&) {
  const std::optional<dvec3> degrees = vector_of(words.value);
  if (!degrees) return Error{words.where, fmt::format("must be three angles X:Y:Z in degrees; got '{}'", words.value)};
  WorkspaceParameters map;
  const dvec3 half = glm::radians(*degrees) / 2.0;
  map.frame = dquat(std::cos(half.z), 0, 0, std::sin(half.z)) * dquat(std::cos(half.y), 0, std::sin(half.y), 0) *
              dquat(std::cos(half.x), std::sin(half.x), 0, 0);
  return checked(words, std::make_unique<Workspace>(std::move(inner), map));
}

Result<Driven> make_clutch(Driven inner, Words& words, std::vector<std::string>&) {
  WorkspaceParameters map;
  map.clutch = static_cast<int>(words.first(plain_number, 0.0, 31.0, "a button from 0 to 31"));
  return checked(words, std::make_unique<Workspace>(std::move(inner), map));
}

Result<Driven> make_border(Driven inner, Words& words, std::vector<std::string>&) {
  WorkspaceParameters map;
  map.border = words.first(metres_of, 1e-6, 10.0, "a length from 1um to 10m, as 40mm");
  map.rate = words.key("rate", plain_number, 0.0, 100.0, map.rate, "must be a rate from 0 to 100 1/s");
  return checked(words, std::make_unique<Workspace>(std::move(inner), map));
}

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> all{
      {"record", make_record}, {"replay", make_replay},     {"delay", make_delay},  {"jitter", make_jitter},
      {"drop", make_drop},     {"quantise", make_quantise}, {"gain", make_gain},    {"scale", make_gain},
      {"frame", make_frame},   {"clutch", make_clutch},     {"border", make_border}};
  return all;
}

}  // namespace

Result<DeviceChain> wrap(std::unique_ptr<Driver> driver, const std::string& words) {
  DeviceChain chain{std::move(driver), {}, {}};
  const std::vector<std::string> parts = split(words, '|');
  if (parts.size() > kMostWrappers)
    return Error{"wrappers", fmt::format("are {}, and a device has at most {}", parts.size(), kMostWrappers),
                 "leave some out"};
  for (const std::string& part : parts) {
    Words one;
    bool first = true;
    one.where = "wrapper `" + part + "`";
    for (const std::string& piece : split(part, ',')) {
      const Option option = option_of(piece);
      if (first)
        one.name = option.key, one.value = option.value;
      else
        one.keys[option.key] = option.value;
      first = false;
    }
    const auto maker = makers().find(one.name);
    if (maker == makers().end()) {
      std::string names;
      for (const auto& [name, ignored] : makers()) names += (names.empty() ? "" : ", ") + name;
      return Error{one.where, "is no WRAPPER=VALUE", "wrappers are: " + names};
    }
    auto made = maker->second(std::move(chain.driver), one, chain.notes);
    if (!made) return made.error();
    chain.driver = std::move(made).value();
  }
  return chain;
}

Result<DeviceChain> make_device(const std::string& words) {
  const std::size_t bar = words.find('|');
  const std::string device = words.substr(0, bar);
  const std::size_t colon = device.find(':');
  auto driver = make_driver(device.substr(0, colon));
  if (!driver) return driver.error();
  auto chain = wrap(std::make_unique<Refound>(std::move(driver).value()),
                    bar == std::string::npos ? std::string() : words.substr(bar + 1));
  if (!chain) return chain;
  if (colon != std::string::npos) chain->id = device.substr(colon + 1);
  return chain;
}

}  // namespace pliant
