// Files appear whole: everything is written into a hidden folder beside its place and moved there by commit(). Without
// a commit nothing remains, not even the folders that had to be made.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class OutputFolder {
 public:
  // Makes `folder` (and its parents) if need be. Fails where that cannot be written to.
  static Result<OutputFolder> create(const std::filesystem::path& folder);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  // Where to write the file that will be called `name`.
  std::filesystem::path stage(const std::string& name);
  // Moves every staged file into place; what is an earlier run's alone goes: more pictures (frame-NNNN.png),
  // bodies.csv.
  Status commit();
  const std::filesystem::path& path() const { return folder_; }

 private:
  OutputFolder() = default;
  std::filesystem::path folder_, staging_;
  std::vector<std::filesystem::path> made_;  // folders that did not exist before, outermost first
  std::vector<std::string> names_;
};

}  // namespace pliant
