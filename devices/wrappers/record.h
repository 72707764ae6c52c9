// Records samples and forces to a file (devices/pose_file.h) for `replay` and --probe NAME=script:FILE.
#pragma once

#include <vector>

#include "devices/pose_file.h"
#include "devices/wrappers/wrapper.h"

namespace pliant {

// Keeps a row per sample, in memory allocated by open(), and writes the file on close. Samples after `seconds` are
// counted, and the file states their number.
class Record : public Wrapper {
 public:
  Record(std::unique_ptr<Driver> inner, std::string file, double seconds)
      : Wrapper(std::move(inner)), file_(std::move(file)), seconds_(seconds) {}
  ~Record() override { finish(); }
  Status open(const std::string& id) override;
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  bool write_model(const DeviceModel& model, const DeviceWrench& wrench) override;
  void close() override;
  // After close(): why the file was not written.
  const Status& written() const { return written_; }

  static constexpr double kMost = 3600.0;  // [s]

 protected:
  Status begin() override;

 private:
  Status take_file();
  void leave_file() noexcept;
  void finish() noexcept;
  std::string file_;
  double seconds_;  // [s]
  std::vector<PoseFileRow> rows_;
  std::uint64_t samples_ = 0, lost_ = 0;
  double first_ = 0.0;  // [s] of the first sample
  bool open_ = false;
  int place_ = -1;  // the file, empty and locked until it is written, so that no other process records into it
  Status written_ = Done{};
};

}  // namespace pliant
