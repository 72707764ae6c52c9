// Writes what is not saved yet, now and then, in the background; nothing that was done is lost with the program.
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
  double interval = 30.0;  // [s] between two copies; what is lost at most, and what is done while a copy is written

  // Another editor has the document's file open: copies do not go where its own go.
  bool shared = false;

  // Once a frame. A copy is written where the document differs from its file and from the copy before, and taken away
  // where it does not differ from its file any more, or another document was opened.
  void update(Editor& editor);
  // At once, on this thread: the program has to end.
  void write_now(Editor& editor);
  // The document is closed in order.
  void forget();
  bool has_copy() const { return place_ && place_->written(); }  // of the document that is open

 private:
  void follow(const Editor& editor);
  std::filesystem::path state_folder_;
  std::shared_ptr<RecoveryPlace> place_;
  std::shared_ptr<std::atomic<bool>> writes_ = std::make_shared<std::atomic<bool>>(false);
  std::uint64_t document_ = ~std::uint64_t{0};  // Editor::documents that `place_` is of
  std::filesystem::path file_;
  bool of_shared_ = false;
  std::uint64_t written_ = ~std::uint64_t{0};  // revision
  double began_ = -1e9;                        // [s] the copy before
  bool said_ = false;
};

}  // namespace pliant
