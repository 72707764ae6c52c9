// Periodically saves unsaved changes in the background, so that a crash loses little.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "editor/document/recovery.h"

namespace pliant {

class Editor;

class Autosave {
 public:
  explicit Autosave(std::filesystem::path state_folder) : state_folder_(std::move(state_folder)) {}
  double interval = 30.0;  // [s] between two copies; at most this much, and what is done during writing, is lost

  // Another editor has the document's file open: copies must not replace that editor's.
  bool shared = false;

  // Call once per frame. Writes a copy if the document differs from its file and from the last copy; removes it if the
  // document equals its file again, or another document was opened.
  void update(Editor& editor);
  // At once, on this thread: the program must end.
  void write_now(Editor& editor);
  // The document is closed normally.
  void forget();
  bool has_copy() const { return place_ && place_->written(); }  // of the open document

 private:
  void follow(const Editor& editor);
  std::filesystem::path state_folder_;
  std::shared_ptr<RecoveryPlace> place_;
  std::shared_ptr<std::atomic<bool>> writes_ = std::make_shared<std::atomic<bool>>(false);
  std::uint64_t document_ = ~std::uint64_t{0};  // Editor::documents for `place_`
  std::filesystem::path file_;
  bool of_shared_ = false;
  std::uint64_t written_ = ~std::uint64_t{0};  // revision
  double began_ = -1e9;                        // [s] time of the last copy
  bool said_ = false;
};

}  // namespace pliant
