// Files of documents: opening, saving, saving elsewhere, reverting, recovery, and reloading when another program has
// changed them. Slow work is done in the background.
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
  // `native`: the desktop's own dialogs, if available; else the built-in browser.
  Files(App& app, bool native);
  void update();  // once per frame

  void ask_open(const std::filesystem::path& folder = {});  // empty: a likely folder
  // Asks first if there are unsaved changes, or changes of a crashed run.
  void open(const std::filesystem::path& file, double unit = 1.0);
  // In the background, without a question. `failed`: hears why it cannot be opened; empty: the console says it.
  void load(const std::filesystem::path& file, double unit, bool read_only = false,
            std::function<void(const Error&)> failed = {});
  void add(const std::filesystem::path& file);  // to the level: all that its scene shows
  void ask_add();
  void give_up_opening();  // the level stays as it is
  static constexpr const char* kOpenJob = "open";
  void recover(const RecoveryCopy& copy);
  bool save();  // false: it asks for a name, or saving failed
  void save_as(std::function<void()> then = {});
  void save_copy();
  void revert();
  bool read_only() const { return read_only_; }  // saving asks for another name
  void close_in_order();                         // the user ends the program
  void save_what_can_be();                       // the program must end

  Autosave autosave;
  // Asks for a name; calls `then` with the choice.
  void choose(const FileRequest& request, std::function<void(const std::filesystem::path&)> then);
  // For the built-in browser: the current request.
  const FileRequest& request() const { return request_; }
  std::uint64_t requests() const { return requests_; }  // number of requests so far
  void chosen(const std::filesystem::path& file);       // by the built-in browser
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
    std::string name;  // as in the level
    FileStamp stamp;
  };
  using Watches = std::map<std::filesystem::path, Watch>;
  void compare(const Watches& now, const FileStamp& known, std::uint64_t document);
  void read_script_again(const std::string& name, const std::filesystem::path& path);
  void read_picture_again(const std::string& name, const std::filesystem::path& path);
  void reload(const std::string& what);

  App& app_;
  bool native_;
  FileRequest request_;
  std::uint64_t requests_ = 0;
  std::function<void(const std::filesystem::path&)> then_;
  std::unique_ptr<FileLock> lock_;  // of the document's file; locked or not
  std::uint64_t locked_document_ = ~std::uint64_t{0};
  std::filesystem::path locked_file_;
  double lock_tried_ = 0.0;                          // [s]
  bool read_only_ = false, next_read_only_ = false;  // of the document; of the one being opened
  RecoveryCopy recovered_;                           // the document's recovery copy, until there is a newer one
  // Watching.
  double watched_ = 0.0;                             // [s]
  std::map<std::filesystem::path, FileStamp> seen_;  // files that the level refers to
  std::uint64_t seen_document_ = ~std::uint64_t{0};
  FileStamp seen_level_;  // of the document's file at the last check
  FileStamp unsettled_;   // the level's stamp when first seen changed: it may still be being written
  bool asking_ = false;
};

// Whether a name has an extension in which a level can be saved.
bool is_level_name(const std::filesystem::path& file);
// "today 14:03:20", or with its date.
std::string time_text(std::filesystem::file_time_type time);
// For documents without a file: "liver.level.glb"
std::string suggested_name(const class Document& document);

}  // namespace pliant
