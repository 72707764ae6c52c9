// Recovery copies of unsaved changes, in case the editor crashes. The copy of a document with a file is beside it, as
// .NAME.recovery.glb. If that folder is not writable, or the document has no file, the copy is in a folder of the
// user's. A copy is written atomically, and removed when the document is saved or closed.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "editor/document/state.h"

namespace pliant {

struct RecoveryCopy {
  std::filesystem::path copy;
  std::filesystem::path file;    // the original file; empty: none yet
  std::filesystem::path folder;  // folder of referenced files
  std::string title;
  std::filesystem::file_time_type time;
};

std::filesystem::path recovery_beside(const std::filesystem::path& file);

// The newer one of the two places.
std::optional<RecoveryCopy> find_recovery(const std::filesystem::path& file, const std::filesystem::path& state_folder);
// In the user's folder, from editors that no longer run; newest first.
std::vector<RecoveryCopy> find_recoveries(const std::filesystem::path& state_folder);
// The paths that were in no file when the copy was written; empty: none, or unreadable.
Scripts scripts_beside_copy(const std::filesystem::path& copy);
// With its associated files. After a failure it is left for the next time.
void remove_recovery(const RecoveryCopy& copy);

// The place of one document's copy, while it is open.
class RecoveryPlace {
 public:
  // Empty `file`: none yet. `folder`: of referenced files.
  RecoveryPlace(std::filesystem::path file, std::filesystem::path folder, std::string title,
                std::filesystem::path state_folder);
  // `unsaved`: paths that differ from their files. On any thread, one at a time. After forget(), also during this call,
  // nothing is left.
  Status write(const State& state, const Scripts& unsaved = {});
  void forget();  // on any thread
  bool written() const { return written_; }

 private:
  Status write_apart(const State& state, const Scripts& unsaved);
  void remove() const;
  const std::filesystem::path file_, folder_, beside_, apart_, state_folder_;
  const std::string title_;
  std::atomic<bool> wanted_{true}, written_{false};
};

}  // namespace pliant
