// The level that is edited: one path for every change, undo and redo without limit but memory, saved or not.
//
//   document.change("Rename", renamed(document.state(), id, "liver"));
//
// A change is a new State. What belongs to one gesture of the hand (a slider that is dragged, a stroke) becomes one
// step: changes that name the same gesture in a row replace each other's result until end_gesture().
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
  // Of an empty level that has no file yet.
  Document();
  // A level or a mesh. A bare mesh is a level without anything that can be touched yet, which has no file: saving asks
  // for one. `unit` [m] that one unit of a bare mesh is.
  static Result<Document> open(const std::filesystem::path& file, double unit = 1.0);
  // As `open` of `copy`, but what was saved last is `file`: after a crash. `file` may be empty; files that the level
  // names are sought beside it, else in `folder`.
  static Result<Document> recover(const std::filesystem::path& copy, const std::filesystem::path& file,
                                  const std::filesystem::path& folder = {});

  const State& state() const { return steps_[now_].state; }
  // Another number for every state that was ever shown; the same number is the same state.
  std::uint64_t revision() const { return steps_[now_].revision; }

  // The one way to change. An error changes nothing and comes back; nothing happens where nothing differs.
  Status change(const std::string& what, Result<State> next, const std::string& gesture = {});
  void end_gesture() { gesture_.clear(); }
  // The gesture that is under way never was; true: it had changed something.
  bool drop_gesture(const std::string& gesture);
  NodeId new_id() { return next_id_++; }
  NodeId& next_id() { return next_id_; }

  bool can_undo() const { return now_ > 0; }
  bool can_redo() const { return now_ + 1 < steps_.size(); }
  const std::string& undo_what() const { return steps_[now_].what; }
  const std::string& redo_what() const { return steps_[now_ + 1].what; }
  void undo();
  void redo();
  std::size_t step_count() const { return steps_.size(); }  // undone ones included
  std::size_t step() const { return now_; }
  const std::string& step_what(std::size_t i) const { return steps_[i].what; }
  void go_to_step(std::size_t i);

  // Scripts of the state that no file holds as they are now, by the name that devices give.
  Scripts unsaved_scripts() const;
  bool dirty() const { return revision() != saved_; }
  // Something was done that is in no file: more than a bare mesh was opened.
  bool worth_keeping() const { return dirty() && (revision() != 0 || recovered_); }
  const std::filesystem::path& file() const { return file_; }      // empty: it has none yet
  const std::filesystem::path& folder() const { return folder_; }  // where files that it names are sought
  std::string title() const;                                       // the file's name; "untitled"
  Status save();                                                   // where it came from
  Status save_as(const std::filesystem::path& file);               // and from now on there
  Status save_copy(const std::filesystem::path& file) const;
  Status revert();  // as the file is now; one step that can be undone
  void revert_to(Level level, const FileStamp& stamp, const std::string& what = "Revert");  // to what was read of it
  // Whether the file is another than the one that was read or written here last.
  bool file_changed() const;
  const FileStamp& file_stamp() const { return stamp_; }
  void accept_file();  // keep what is here, whatever the file is now: from now on that is a change

  // A file that the level names is another one on disk. Every state that has it as it was gets it as it is; that is no
  // change of the document. False: the script was changed here, too, and stays as it is here.
  bool script_read_again(const std::string& name, const ScriptKeys& keys);
  // The picture of this number (glTF's), of files that name it so.
  void picture_read_again(const std::string& uri, const Image& image, const std::vector<std::uint8_t>& encoded);
  bool is_on_disk(const std::string& name, const ScriptKeys& keys) const;  // as far as is known here

  // What was read differently than one might expect.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Step {
    std::string what;  // that led here
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
  FileStamp stamp_;  // of the file as read or written last
  bool recovered_ = false;
};

}  // namespace pliant
