#include "devices/wrappers/record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "runtime/log.h"

namespace pliant {

// Called before the device is opened: nothing has moved yet.
Status Record::open(const std::string& id) {
  if (const Status taken = take_file(); !taken) return taken;
  Status opened = Wrapper::open(id);
  if (!opened) leave_file();
  return opened;
}

// An empty unlocked file is left over from a killed process.
Status Record::take_file() {
  leave_file();
  place_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  const auto refused = [this](const std::string& why) {
    if (place_ >= 0) ::close(std::exchange(place_, -1));
    return Error{file_, why, "give the name of a new file"};
  };
  if (place_ < 0) return refused(std::string("cannot be written: ") + std::strerror(errno));
  struct stat there = {};
  if (::fstat(place_, &there) != 0 || !S_ISREG(there.st_mode) || there.st_size > 0)
    return refused("is there already, and a recording replaces nothing");
  if (::flock(place_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return refused("is being recorded into by another device or run");
  return Done{};
}

void Record::leave_file() noexcept {
  if (place_ < 0) return;
  ::unlink(file_.c_str());
  ::close(std::exchange(place_, -1));
}

Status Record::begin() {
  rows_.clear();
  rows_.reserve(static_cast<std::size_t>(std::min(seconds_, kMost) * rate()) + 1);
  samples_ = lost_ = 0;
  open_ = true;
  written_ = Done{};
  return Done{};
}

// If a device gives no times, or decreasing ones, they are computed from its rate.
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

// Written to a temporary file and renamed: the file is complete or absent.
void Record::finish() noexcept {
  const bool recorded = std::exchange(open_, false) && !rows_.empty();
  try {
    if (recorded) {
      const std::string aside = fmt::format("{}.{}.part", file_, ::getpid());
      written_ = write_poses(aside, rows_,
                             lost_ > 0 ? fmt::format("{} samples; {} more did not fit", rows_.size(), lost_)
                                       : fmt::format("{} samples", rows_.size()));
      if (written_ && std::rename(aside.c_str(), file_.c_str()) != 0)
        written_ = Error{aside, std::string("cannot be put in place: ") + std::strerror(errno), "check the folder"};
      if (written_) return void(::close(std::exchange(place_, -1)));
      ::unlink(aside.c_str());
      log_sentence(LogLevel::kWarning, written_.error().message());
    }
  } catch (...) {  // the recording is lost; the device is closed
  }
  leave_file();
}

}  // namespace pliant
