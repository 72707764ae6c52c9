// Poses in CSV files: the level's scripts, and the output of the wrapper `record`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pliant/driver.h"
#include "pliant/parameters.h"

namespace pliant {

// A row: a sample, and the wrench written after it.
struct PoseFileRow {
  DeviceSample sample;  // its time [s]: since the first row
  DeviceWrench wrench;
};

inline constexpr std::string_view kPoseFileHeader =
    "time_s,x,y,z,qw,qx,qy,qz,ready,grip,buttons,fx,fy,fz,tx,ty,tz,fgrip";
inline constexpr std::size_t kMostPoseRows = 4'000'000;

// Header `time_s,x,y,z`, `time_s,x,y,z,qw,qx,qy,qz` or kPoseFileHeader, then rows of finite numbers, time strictly
// ascending. Errors name the file and the line.
Result<std::vector<PoseFileRow>> parse_poses(std::string_view text, const std::string& where);
Result<std::vector<PoseFileRow>> read_poses(const std::string& file);
Path path_of(const std::vector<PoseFileRow>& rows);

// Creates a new file; does not replace an existing one.
Status write_poses(const std::string& file, const std::vector<PoseFileRow>& rows, const std::string& comment);

}  // namespace pliant
