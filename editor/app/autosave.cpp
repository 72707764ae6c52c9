#include "editor/app/autosave.h"

#include "editor/core/editor.h"

namespace pliant {

void Autosave::follow(const Editor& editor) {
  if (place_ && document_ == editor.documents && file_ == editor.document.file() && shared == of_shared_) return;
  forget();
  document_ = editor.documents;
  file_ = editor.document.file();
  of_shared_ = shared;
  written_ = ~std::uint64_t{0};
  said_ = false;
  place_ = std::make_shared<RecoveryPlace>(shared ? std::filesystem::path() : file_, editor.document.folder(),
                                           editor.document.title(), state_folder_);
}

void Autosave::update(Editor& editor) {
  follow(editor);
  const std::uint64_t revision = editor.document.revision();
  if (!editor.document.dirty()) {
    if (written_ != ~std::uint64_t{0}) {
      place_->forget();
      place_.reset();  // a new one at the next change
    }
    return;
  }
  if (revision == written_ || !editor.document.worth_keeping() || editor.now - began_ < interval || *writes_) return;
  began_ = editor.now;
  written_ = revision;
  *writes_ = true;
  editor.jobs.start("autosave", "",
                    [place = place_, writes = writes_, state = editor.state(),
                     unsaved = editor.document.unsaved_scripts(), this](const Jobs::Stop&) {
                      struct AtTheEnd {
                        std::atomic<bool>& flag;
                        ~AtTheEnd() { flag = false; }
                      } at_the_end{*writes};
                      const Status status = place->write(state, unsaved);
                      const std::string fault = status ? "" : status.error().message();
                      return [fault, this](Editor& to) {
                        if (fault.empty() || said_) return;
                        said_ = true;
                        to.say("No copy for recovery could be written: " + fault, Severity::kWarning);
                      };
                    });
}

void Autosave::write_now(Editor& editor) {
  follow(editor);
  if (editor.document.worth_keeping()) (void)place_->write(editor.state(), editor.document.unsaved_scripts());
}

void Autosave::forget() {
  if (place_) place_->forget();
  place_.reset();
}

}  // namespace pliant
