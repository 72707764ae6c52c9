#include "devices/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "devices/spec.h"

namespace pliant {
namespace {

constexpr std::string_view kPositions = "time_s,x,y,z", kPoses = "time_s,x,y,z,qw,qx,qy,qz";
constexpr std::size_t kMostColumns = 18;
constexpr std::size_t kMostBytes = std::size_t{512} << 20;

bool parse_row(std::string_view line, double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i == count - 1)) return false;
    const std::string_view cell = trimmed(line.substr(0, comma));
    const std::from_chars_result read = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    if (read.ec != std::errc{} || read.ptr != cell.data() + cell.size() || !std::isfinite(values[i])) return false;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return true;
}

std::size_t columns_of(std::string_view line) {
  std::string names(line);
  std::erase_if(names, [](char c) { return c == ' ' || c == '\t'; });
  return names == kPositions ? 4 : names == kPoses ? 8 : names == kPoseFileHeader ? kMostColumns : 0;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

}  // namespace

Result<std::vector<PoseFileRow>> parse_poses(std::string_view text, const std::string& where) {
  std::vector<PoseFileRow> rows;
  std::size_t columns = 0;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const auto error = [&](const std::string& what) { return Error{fmt::format("{}:{}", where, number), what}; };
    if (line.empty() || line.front() == '#') continue;
    if (columns == 0) {
      columns = columns_of(line);
      if (columns == 0)
        return error(fmt::format("the header is none of `{}`, `{}` and `{}`; begin the file with one", kPositions,
                                 kPoses, kPoseFileHeader));
      continue;
    }
    double v[kMostColumns] = {0, 0, 0, 0, 1, 0, 0, 0, 1};
    if (!parse_row(line, v, columns))
      return error(fmt::format("this row is not {} finite numbers between commas; correct the line", columns));
    if (!rows.empty() && !(v[0] > rows.back().sample.time))
      return error("time does not grow from the row before; sort the rows and remove doubles");
    const dquat rotation(v[4], v[5], v[6], v[7]);
    const double norm = length(rotation);
    if (!(norm > 1e-6) || !std::isfinite(norm))
      return error("the quaternion has no length; write 1,0,0,0 for no rotation");
    if (rows.size() == kMostPoseRows)
      return error(fmt::format("more than {} rows; split the file or sample it more coarsely", kMostPoseRows));
    PoseFileRow row;
    row.sample.time = v[0];
    row.sample.position = {v[1], v[2], v[3]};
    row.sample.rotation = rotation / norm;
    row.sample.ready = v[8] != 0.0;
    row.sample.grip = v[9];
    row.sample.buttons = v[10] >= 0.0 && v[10] <= 4294967295.0 ? static_cast<std::uint32_t>(v[10]) : 0;
    row.wrench = {{v[11], v[12], v[13]}, {v[14], v[15], v[16]}, v[17]};
    rows.push_back(row);
  }
  if (rows.empty()) return Error{where, "holds no rows", "write a header and at least one row below it"};
  return rows;
}

Result<std::vector<PoseFileRow>> read_poses(const std::string& file) {
  const File in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!in) return Error{file, std::string("cannot be opened: ") + std::strerror(errno), "check the path"};
  std::string text;
  char part[65536];
  for (std::size_t got; (got = std::fread(part, 1, sizeof part, in.get())) > 0;) {
    text.append(part, got);
    if (text.size() > kMostBytes) return Error{file, "is larger than 512 MiB", "split it or sample it more coarsely"};
  }
  if (std::ferror(in.get())) return Error{file, "cannot be read", "is it a file?"};
  return parse_poses(text, file);
}

Path path_of(const std::vector<PoseFileRow>& rows) {
  Path path;
  path.rows.reserve(rows.size());
  path.turns = true;
  for (const PoseFileRow& row : rows) path.rows.push_back({row.sample.time, row.sample.position, row.sample.rotation});
  return path;
}

Status write_poses(const std::string& file, const std::vector<PoseFileRow>& rows, const std::string& comment) {
  const File out(std::fopen(file.c_str(), "wbx"), std::fclose);
  if (!out)
    return Error{file, std::string("cannot be written: ") + std::strerror(errno), "give the name of a new file"};
  std::string text = fmt::format("# {}\n{}\n", comment, kPoseFileHeader);
  bool written = true;
  for (const PoseFileRow& row : rows) {
    const DeviceSample& s = row.sample;
    const DeviceWrench& w = row.wrench;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", s.time,
                   s.position.x, s.position.y, s.position.z, s.rotation.w, s.rotation.x, s.rotation.y, s.rotation.z,
                   s.ready ? 1 : 0, s.grip, s.buttons, w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y,
                   w.torque.z, w.grip);
    if (text.size() < 65536) continue;
    written = written && std::fwrite(text.data(), 1, text.size(), out.get()) == text.size();
    text.clear();
  }
  written = written && std::fwrite(text.data(), 1, text.size(), out.get()) == text.size();
  if (!written || std::fflush(out.get()) != 0) return Error{file, "cannot be written", "check the space left"};
  return Done{};
}

}  // namespace pliant
