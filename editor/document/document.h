// The edited level: a single function for every change, undo and redo limited only by memory, saved state.
//
//   document.change("Rename", renamed(document.state(), id, "liver"));
//
// A change is a new State. Changes of one gesture (a dragged slider, a stroke) become one step: consecutive changes
// with the same gesture replace each other until end_gesture().
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "editor/document/file_stamp.h"
#include "editor/document/state.h"
#include "runtime/result.h"

namespace pliant {

class Document {
 public:
  // An empty level without a file.
  Document();
  // Opens a level or a mesh. A bare mesh becomes a level without touchable objects and without a file: saving asks for
  // one. `unit` [m]: length unit of a bare mesh.
  static Result<Document> open(const std::filesystem::path& file, double unit = 1.0);
  // As `open` of `copy`, but the saved state is `file`: after a crash. `file` may be empty. Referenced files are looked
  // up beside it, else in `folder`.
  static Result<Document> recover(const std::filesystem::path& copy, const std::filesystem::path& file,
                                  const std::filesystem::path& folder = {});

  const State& state() const { return steps_[now_].state; }
  // Identifies a state: the same number is the same state.
  std::uint64_t revision() const { return steps_[now_].revision; }

  // The only way to change the level. An error is returned and changes nothing; an identical state has no effect.
  Status change(const std::string& what, Result<State> next, const std::string& gesture = {});
  void end_gesture() { gesture_.clear(); }
  // Discards the gesture in progress; true: it had changed something.
  bool drop_gesture(const std::string& gesture);
  NodeId new_id() { return next_id_++; }
  NodeId& next_id() { return next_id_; }

  bool can_undo() const { return now_ > 0; }
  bool can_redo() const { return now_ + 1 < steps_.size(); }
  const std::string& undo_what() const { return steps_[now_].what; }
  const std::string& redo_what() const { return steps_[now_ + 1].what; }
  void undo();
  void redo();
  std::size_t step_count() const { return steps_.size(); }  // including undone ones
  std::size_t step() const { return now_; }
  const std::string& step_what(std::size_t i) const { return steps_[i].what; }
  void go_to_step(std::size_t i);

  // Scripts of the state that differ from their files, by their name in devices.
  Scripts unsaved_scripts() const;
  bool dirty() const { return revision() != saved_; }
  // There are changes in no file, beyond opening a bare mesh.
  bool worth_keeping() const { return dirty() && (revision() != 0 || recovered_); }
  const std::filesystem::path& file() const { return file_; }      // empty: none yet
  const std::filesystem::path& folder() const { return folder_; }  // folder of referenced files
  std::string title() const;                                       // the file's name; "untitled"
  Status save();                                                   // to its file
  Status save_as(const std::filesystem::path& file);               // and uses that file from now on
  Status save_copy(const std::filesystem::path& file) const;
  Status revert();  // reloads the file; one undoable step
  void revert_to(Level level, const FileStamp& stamp, const std::string& what = "Revert");  // to this content of the
                                                                                            // file
  // Whether the file has changed since it was last read or written here.
  bool file_changed() const;
  const FileStamp& file_stamp() const { return stamp_; }
  void accept_file();  // keeps the document although the file has changed; it then counts as modified

  // A referenced script has changed on disk. Every state with the old content gets the new one; this is no change of
  // the document. False: the script was also changed here, and is kept.
  bool script_read_again(const std::string& name, const ScriptKeys& keys);
  // The same for the picture with this number (glTF's), in files that refer to it by this name.
  void picture_read_again(const std::string& uri, const Image& image, const std::vector<std::uint8_t>& encoded);
  bool is_on_disk(const std::string& name, const ScriptKeys& keys) const;  // according to what was last read or written
                                                                           // here

  // Notes on unexpected conversions.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Step {
    std::string what;  // the change that led to this step
    State state;
    std::uint64_t revision;
  };
  explicit Document(State state, NodeId next);
  Status write(const std::filesystem::path& file, const State& state, bool scripts_too) const;
  void remember_file();
  void in_every_state(const std::function<bool(State&)>& change);
  void read_scripts(State& state);

  std::vector<Step> steps_;
  std::size_t now_ = 0;
  std::string gesture_;
  NodeId next_id_ = 1;
  std::uint64_t next_revision_ = 1, saved_ = 0;
  std::filesystem::path file_, folder_;
  std::vector<std::string> notes_;
  Scripts scripts_on_disk_;
  FileStamp stamp_;  // of the file as last read or written
  bool recovered_ = false;
};

}  // namespace pliant
