// Copies of what is not saved yet, for the day the editor ends without being asked to. A document that has a file has
// its copy beside it, as .NAME.recovery.glb; where that folder cannot be written, and for a document without a file,
// the copy lies in a folder of the user's. A copy appears whole, and is gone once the document is saved or given up.
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
  std::filesystem::path file;    // that it is of; empty: it has none yet
  std::filesystem::path folder;  // where files that it names are sought
  std::string title;
  std::filesystem::file_time_type time;
};

std::filesystem::path recovery_beside(const std::filesystem::path& file);

// The newer one of the two places.
std::optional<RecoveryCopy> find_recovery(const std::filesystem::path& file, const std::filesystem::path& state_folder);
// In the user's folder, of editors that run no more; newest first.
std::vector<RecoveryCopy> find_recoveries(const std::filesystem::path& state_folder);
// The paths that were in no file when the copy was written; empty: there were none, or they cannot be read.
Scripts scripts_beside_copy(const std::filesystem::path& copy);
// With what belongs to it. A failure leaves it for the next time.
void remove_recovery(const RecoveryCopy& copy);

// Where one document's copy goes, for as long as it is open.
class RecoveryPlace {
 public:
  // `file` empty: the document has none. `folder`: where files that it names are sought.
  RecoveryPlace(std::filesystem::path file, std::filesystem::path folder, std::string title,
                std::filesystem::path state_folder);
  // `unsaved`: paths that are in no file as they are. On any thread, one at a time. Nothing is left once forget() was
  // called, even if that was meanwhile.
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
