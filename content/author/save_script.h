// Writes paths as scripts (content/level/script.h reads them). Also the smooth step from which smooth paths are made.
#pragma once

#include <filesystem>
#include <string>

#include "content/files/file_io.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

// 0 before `from`, 1 after `to`, twice continuously differentiable. Times [s].
double smooth_step(double from, double to, double t);

// Rotations are written if any row rotates. `comment` becomes the first line.
Status save_script(const Path& path, const std::string& comment, const std::filesystem::path& file,
                   Existing existing = Existing::kReplace);

}  // namespace pliant
