// Paths written as scripts (content/level/script.h reads them), and the step of which smooth ones are made.
#pragma once

#include <filesystem>
#include <string>

#include "content/files/file_io.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

// 0 before `from`, 1 after `to`, twice continuously differentiable. Times [s].
double smooth_step(double from, double to, double t);

// With rotations if any row turns. `comment` is the first line.
Status save_script(const Path& path, const std::string& comment, const std::filesystem::path& file,
                   Existing existing = Existing::kReplace);

}  // namespace pliant
