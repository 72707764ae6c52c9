#include "player/record/output_folder.h"

#include <unistd.h>

#include <algorithm>

namespace pliant {
namespace fs = std::filesystem;
namespace {

// What a run may leave out, and an earlier one into the same folder may have written.
bool comes_and_goes(const std::string& name) {
  return name == "bodies.csv" || (name.starts_with("frame-") && name.ends_with(".png"));
}

}  // namespace

Result<OutputFolder> OutputFolder::create(const fs::path& folder) {
  OutputFolder out;
  std::error_code error;
  out.folder_ = fs::absolute(folder, error).lexically_normal();
  if (!out.folder_.has_filename()) out.folder_ = out.folder_.parent_path();  // "out/" is "out"
  std::vector<fs::path> missing;
  for (fs::path at = out.folder_; !fs::exists(at, error) && at.has_relative_path(); at = at.parent_path())
    missing.push_back(at);
  std::reverse(missing.begin(), missing.end());
  for (const fs::path& at : missing) {
    if (!fs::create_directory(at, error))
      return Error{folder.string(), "cannot be made (" + error.message() + "); choose another with --out"};
    out.made_.push_back(at);
  }
  out.staging_ = out.folder_ / (".partial-" + std::to_string(::getpid()));
  fs::remove_all(out.staging_, error);
  if (!fs::create_directory(out.staging_, error))
    return Error{folder.string(), "cannot be written to (" + error.message() + "); choose another with --out"};
  return out;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      staging_(std::move(other.staging_)),
      made_(std::move(other.made_)),
      names_(std::move(other.names_)) {
  other.staging_.clear();
  other.made_.clear();
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  for (auto at = made_.rbegin(); at != made_.rend(); ++at) fs::remove(*at, ignored);  // only if empty
}

fs::path OutputFolder::stage(const std::string& name) {
  names_.push_back(name);
  return staging_ / name;
}

Status OutputFolder::commit() {
  std::error_code error;
  for (const std::string& name : names_)
    if (fs::is_directory(folder_ / name, error))
      return Error{(folder_ / name).string(), "is a folder where a file must go; move it away"};
  for (const std::string& name : names_) {
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) return Error{(folder_ / name).string(), "cannot be written (" + error.message() + "); free that name"};
  }
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    const std::string name = entry.path().filename().string();
    if (comes_and_goes(name) && std::find(names_.begin(), names_.end(), name) == names_.end())
      old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file, error);
  made_.clear();
  return Done{};
}

}  // namespace pliant
