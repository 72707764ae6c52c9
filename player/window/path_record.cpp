#include "player/window/path_record.h"

#include <fmt/format.h>

#include "content/author/save_script.h"
#include "runtime/printable.h"

namespace pliant {

void PathRecord::begin(std::uint32_t probe) {
  *this = {};
  probe_ = probe;
}

double PathRecord::seconds() const {
  return path_.rows.empty() ? 0.0 : path_.rows.back().time;
}

void PathRecord::add(const TickRow& row) {
  if (!probe_ || row.probe != *probe_ || full()) return;
  if (!from_) from_ = row.time;
  const double due = static_cast<double>(path_.rows.size()) * kEvery;
  if (row.time - *from_ < due - 1e-9) return;
  path_.rows.push_back({due, row.device_position, row.device_rotation, 0.0});
}

Result<std::filesystem::path> PathRecord::save(const std::filesystem::path& folder, const std::string& name) {
  const PathRecord done = std::move(*this);
  *this = {};
  if (done.path_.rows.size() < 2)
    return Error{"the path of `" + name + "`", "is shorter than two rows, so it is not written", "record longer"};
  std::error_code ignored;
  for (int i = 1;; ++i) {
    const std::filesystem::path file = folder / fmt::format("path-{:03d}.csv", i);
    if (std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) continue;
    const Status saved = save_script(done.path_, printable(name) + ", recorded in a window", file, Existing::kRefuse);
    if (!saved) return saved.error();
    return file;
  }
}

}  // namespace pliant
