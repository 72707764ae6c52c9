// The folder of a run's results. Files are written into a hidden staging folder and moved into place by commit(), so
// they appear whole. Without commit() nothing remains, not even folders that had to be created.
//
// Only files written by a run are ever touched: `.pliant-run` in the folder lists them. If the folder already has
// results, the next results go into FOLDER-2, FOLDER-3 and so on, or replace them on request.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class OutputFolder {
 public:
  // Creates `folder` and its parents if needed, and removes what a killed run left staged there. Fails if the folder is
  // not writable. `replace`: commit() removes an earlier run's results; fails if files of other origin are in the way.
  static Result<OutputFolder> create(const std::filesystem::path& folder, bool replace = false);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  // Path at which to write the file that will be called `name`.
  std::filesystem::path stage(const std::string& name);
  // Releases the disk space reserved for the last small files, so that the report can be written on a full disk.
  void free_reserve();
  // Moves every staged file into place, the list first. If another process has taken one of the names meanwhile, all
  // files go into the next free folder. A file that cannot be moved does not stop the others.
  Status commit();

  const std::filesystem::path& path() const { return folder_; }      // absolute
  const std::filesystem::path& staging() const { return staging_; }  // absolute
  std::filesystem::path shown() const;                               // as it was given, with its number
  const std::filesystem::path& asked() const { return given_; }
  bool moved() const { return folder_ != asked_; }  // the folder differs from the requested one by its number
  const std::vector<std::string>& written() const { return names_; }  // after commit()
  // The same error with a staged path replaced by its final path.
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
  int marker_ = -1;                          // file descriptor of the lock that marks this run as alive
  std::vector<std::filesystem::path> made_;  // folders that did not exist before, outermost first
  std::vector<std::string> names_;
};

}  // namespace pliant
