#include "devices/wrappers/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "runtime/log.h"

namespace pliant {

// Before the device is: nothing has moved yet.
Status Record::open(const std::string& id) {
  if (std::FILE* there = std::fopen(file_.c_str(), "rb")) {
    std::fclose(there);
    return Error{file_, "is there already, and a recording replaces nothing; give the name of a new file"};
  }
  return Wrapper::open(id);
}

Status Record::begin() {
  rows_.clear();
  rows_.reserve(static_cast<std::size_t>(std::min(seconds_, kMost) * rate()) + 1);
  samples_ = lost_ = 0;
  open_ = true;
  written_ = Done{};
  return Done{};
}

// Times of a device that says none, or goes back, are by its rate.
bool Record::read(DeviceSample& sample) {
  if (!inner().read(sample)) return false;
  if (samples_ == 0) first_ = sample.time;
  double time = sample.time > 0.0 ? sample.time - first_ : static_cast<double>(samples_) / rate();
  if (!rows_.empty() && !(time > rows_.back().sample.time)) time = rows_.back().sample.time + 1.0 / rate();
  ++samples_;
  if (rows_.size() == rows_.capacity()) {
    ++lost_;
    return true;
  }
  rows_.push_back({sample, {}});
  rows_.back().sample.time = time;
  return true;
}

void Record::write(const DeviceWrench& wrench) {
  if (!rows_.empty() && lost_ == 0) rows_.back().wrench = wrench;
  inner().write(wrench);
}

bool Record::write_model(const DeviceModel& model, const DeviceWrench& wrench) {
  if (!rows_.empty() && lost_ == 0) rows_.back().wrench = wrench;
  return inner().write_model(model, wrench);
}

void Record::close() {
  Wrapper::close();
  finish();
}

void Record::finish() noexcept {
  if (!open_) return;
  open_ = false;
  try {
    if (rows_.empty()) return;
    written_ = write_poses(file_, rows_,
                           lost_ > 0 ? fmt::format("{} samples; {} more did not fit", rows_.size(), lost_)
                                     : fmt::format("{} samples", rows_.size()));
    if (!written_) log_sentence(LogLevel::kWarning, written_.error().message());
  } catch (...) {  // the recording is lost; the device is closed
  }
}

}  // namespace pliant
