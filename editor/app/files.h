// What becomes of documents on disk: opened, saved, saved elsewhere, reverted, recovered, read again where another
// program has changed them. What takes long is done in the background.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "editor/app/autosave.h"
#include "editor/app/native_dialog.h"
#include "editor/document/file_lock.h"
#include "editor/document/file_stamp.h"

namespace pliant {

class App;

class Files {
 public:
  // `native`: the desktop's own dialogs, where there are any; else the built-in browser.
  Files(App& app, bool native);
  void update();  // once a frame

  void ask_open(const std::filesystem::path& folder = {});  // empty: where one is likely to look
  // Asks first where something is not saved, and where there are changes of a run that ended before they were saved.
  void open(const std::filesystem::path& file, double unit = 1.0);
  // In the background, without a question. `failed`: hears why it cannot be opened; empty: the console says it.
  void load(const std::filesystem::path& file, double unit, bool read_only = false,
            std::function<void(const Error&)> failed = {});
  void give_up_opening();  // the level stays as it is
  static constexpr const char* kOpenJob = "open";
  void recover(const RecoveryCopy& copy);
  bool save();  // false: asks for a name, or failed
  void save_as(std::function<void()> then = {});
  void save_copy();
  void revert();
  bool read_only() const { return read_only_; }  // saving asks for another name
  void close_in_order();                         // the program ends as the user wants it
  void save_what_can_be();                       // the program has to end

  Autosave autosave;
  // Asks for a name; `then` is called with what was chosen.
  void choose(const FileWish& wish, std::function<void(const std::filesystem::path&)> then);
  // Of the built-in browser: what it is to ask for now.
  const FileWish& wish() const { return wish_; }
  std::uint64_t wishes() const { return wishes_; }  // so far
  void chosen(const std::filesystem::path& file);   // by the built-in browser
  void given_up() { then_ = nullptr; }

 private:
  void ask_who_has(const std::filesystem::path& file, std::function<void(bool read_only)> then);
  void follow_lock();
  void write(const std::filesystem::path& file, bool copy, const std::function<void()>& then);
  void ask_name(const char* title, bool copy, std::function<void()> then);
  void watch();
  enum class Watched : std::uint8_t { kLevel, kBuffer, kScript, kPicture, kNamed, kShader };
  struct Watch {
    Watched kind = Watched::kNamed;
    std::string name;  // as the level has it
    FileStamp stamp;
  };
  using Watches = std::map<std::filesystem::path, Watch>;
  void compare(const Watches& now, const FileStamp& known, std::uint64_t document);
  void read_script_again(const std::string& name, const std::filesystem::path& path);
  void read_picture_again(const std::string& name, const std::filesystem::path& path);
  void reload(const std::string& what);

  App& app_;
  bool native_;
  FileWish wish_;
  std::uint64_t wishes_ = 0;
  std::function<void(const std::filesystem::path&)> then_;
  std::unique_ptr<FileLock> lock_;  // of the document's file; held or not
  std::uint64_t locked_document_ = ~std::uint64_t{0};
  std::filesystem::path locked_file_;
  double lock_tried_ = 0.0;                          // [s]
  bool read_only_ = false, next_read_only_ = false;  // of the document; of the one that is being opened
  RecoveryCopy recovered_;                           // where the document comes from, until there is a newer copy
  // Watching.
  double watched_ = 0.0;                             // [s]
  std::map<std::filesystem::path, FileStamp> seen_;  // of files that the level names
  std::uint64_t seen_document_ = ~std::uint64_t{0};
  FileStamp seen_level_;  // as the document had it when the others were looked at last
  FileStamp unsettled_;   // of the level, when it was another for the first time: it may still be written
  bool asking_ = false;
};

// Whether a name is one of the formats that a level is saved in.
bool is_level_name(const std::filesystem::path& file);
// For what has no file yet: "liver.level.glb"
std::string suggested_name(const class Document& document);

}  // namespace pliant
