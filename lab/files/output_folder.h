// The folder of a run's results. Files appear whole: everything is written into a hidden folder beside its place and
// moved there by commit(). Without a commit nothing remains, not even the folders that had to be made.
//
// Nothing is touched that a run did not write: `.pliant-run` in the folder lists what one wrote. Where a folder has
// results already, the next goes into FOLDER-2, FOLDER-3 and so on, or, if that is asked for, takes their place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class OutputFolder {
 public:
  // Makes `folder` (and its parents) if need be, and removes what a killed run left staged there. Fails where that
  // cannot be written to. `replace`: an earlier run's results go with commit(); fails where others' files are in the
  // way.
  static Result<OutputFolder> create(const std::filesystem::path& folder, bool replace = false);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  // Where to write the file that will be called `name`.
  std::filesystem::path stage(const std::string& name);
  // Gives back the space that is kept for the last, small files: the report is written on a full disk too.
  void free_reserve();
  // Moves every staged file that was written into place, their list first. Where somebody else took a name meanwhile,
  // all of them go into the next folder that is free. A file that cannot be moved keeps no other from its place.
  Status commit();

  const std::filesystem::path& path() const { return folder_; }      // absolute
  const std::filesystem::path& staging() const { return staging_; }  // absolute
  std::filesystem::path shown() const;                               // as it was given, with its number
  const std::filesystem::path& asked() const { return given_; }
  bool moved() const { return folder_ != asked_; }  // it has a number, which what was asked for has not
  const std::vector<std::string>& written() const { return names_; }  // after commit()
  // The same error, of a staged file's place.
  Error at_place(Error error) const;

 private:
  OutputFolder() = default;
  Status open(const std::filesystem::path& folder);
  Status move_on();
  int place_list();
  bool replaces() const { return replace_ && !moved(); }
  Status choose_next();
  std::filesystem::path given_, asked_, folder_, staging_;
  bool replace_ = false;
  int marker_ = -1;                          // holds the lock that says this run is alive
  std::vector<std::filesystem::path> made_;  // folders that did not exist before, outermost first
  std::vector<std::string> names_;
};

}  // namespace pliant
