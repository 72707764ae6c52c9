#include "content/author/save_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {

double smooth_step(double from, double to, double t) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * s * (s * (s * 6.0 - 15.0) + 10.0);
}

Status save_script(const Path& path, const std::string& comment, const std::filesystem::path& file, Existing existing) {
  bool turns = false;
  int digits = 2;  // of times
  for (const PathRow& row : path.rows) {
    turns = turns || row.rotation != dquat(1, 0, 0, 0);
    if (std::abs(100.0 * row.time - std::round(100.0 * row.time)) > 1e-6) digits = 3;
  }
  const char* const end = path.grips ? ",grip\n" : "\n";
  std::string text = "# " + comment + (turns ? "\ntime_s,x,y,z,qw,qx,qy,qz" : "\ntime_s,x,y,z") + end;
  for (const PathRow& row : path.rows) {
    const dvec3 p = row.position;
    const dquat q = row.rotation;
    text += fmt::format("{:.{}f},{:.7f},{:.7f},{:.7f}", row.time, digits, p.x, p.y, p.z);
    if (turns) text += fmt::format(",{:.8f},{:.8f},{:.8f},{:.8f}", q.w, q.x, q.y, q.z);
    text += path.grips ? fmt::format(",{:.4f}\n", row.grip) : "\n";
  }
  return write_file(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, existing);
}

}  // namespace pliant
