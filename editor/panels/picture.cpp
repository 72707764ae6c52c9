// The dialog that saves a picture or a film of the viewport.
#include <fmt/format.h>

#include <algorithm>

#include "editor/app/add.h"
#include "editor/app/files.h"
#include "editor/panels/dialog.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class PicturePanel : public Panel {
 public:
  explicit PicturePanel(App& app) : app_(app) {}
  const char* name() const override { return "Picture"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor& editor) override {
    const Dialog dialog(app_, name(), "Picture or film", {520, 250});
    const auto column = [] { ImGui::SameLine(ui::px(130)); };
    ui::label("Size", "The picture is drawn anew at this size");
    column();
    ui::number("width", width_, 16, 16384, "px", false, 90);
    ImGui::SameLine();
    ui::number("height", height_, 16, 16384, "px", false, 90);
    for (const auto& [label, w, h] : {std::tuple{"720p", 1280, 720}, {"1080p", 1920, 1080}, {"4K", 3840, 2160}}) {
      ImGui::SameLine(0, ui::px(4));
      if (ui::button(label)) width_ = w, height_ = h;
    }
    ui::label("From", "The viewport, or a camera of the level");
    column();
    std::vector<std::string> from{"the viewport"};
    for (const auto& each : editor.state().nodes)
      if (each->node.camera) from.push_back(each->node.name);
    if (std::find(from.begin(), from.end(), from_) == from.end()) from_ = from.front();
    ui::combo("from", from_, from, 220);
    if (ui::strong_button("Save picture\u2026", "A PNG", !app_.film.under_way(), 160)) picture(editor);
    ui::gap(ui::kPad);
    ui::label("Film");
    column();
    ui::number("seconds", seconds_, 0.1, 600, "s", false, 90);
    ImGui::SameLine();
    ui::number("frames a second", rate_, 1, 240, "Hz", false, 90);
    using Kind = FilmRequest::Kind;
    if (ui::button("Turntable\u2026", "Once around the target of the view", !app_.film.under_way(), 160))
      film(editor, Kind::kTurntable);
    ImGui::SameLine();
    if (ui::button("What is played\u2026", "From where it stands, step by step: exact, however long a picture takes",
                   !app_.film.under_way(), 160))
      film(editor, Kind::kPlayed);
    if (app_.film.under_way()) {
      ImGui::SameLine();
      if (ui::button("Give up")) app_.film.stop();
      ui::dim(app_.film.progress().c_str());
    }
    ui::dim("A film is a folder of PNGs; ffmpeg, where it is installed, makes an MP4 of them.");
  }

 private:
  FilmRequest request(const Editor& editor, FilmRequest::Kind kind, const fs::path& to) const {
    FilmRequest out;
    out.kind = kind;
    out.to = to;
    out.view = editor.camera.viewpoint();
    if (const DocumentNode* const camera = editor.state().find(from_); camera && camera->node.camera)
      out.view = view_of_camera(editor, *camera);
    out.width = static_cast<int>(width_);
    out.height = static_cast<int>(height_);
    out.seconds = seconds_;
    out.rate = rate_;
    return out;
  }

  std::string stem(const Editor& editor) const {
    return fs::path(suggested_name(editor.document)).stem().stem().string();
  }

  void picture(Editor& editor) {
    app_.close_panel(name());
    app_.files().choose({.title = "Save the picture as",
                         .save = true,
                         .folder = editor.document.folder(),
                         .name = stem(editor) + ".png"},
                        [this](fs::path file) {
                          if (file.extension() != ".png") file += ".png";
                          const auto save = [this, file] {
                            app_.film.start(request(app_.editor, FilmRequest::Kind::kPicture, file));
                          };
                          std::error_code gone;
                          if (!fs::exists(file, gone)) return save();
                          app_.ask({fmt::format("Replace {}?", printable(file.filename().string())),
                                    {"There is a file of this name already."},
                                    {{"Replace", "", save}, {"Cancel", "", {}}}});
                        });
  }

  void film(Editor& editor, FilmRequest::Kind kind) {
    app_.close_panel(name());
    app_.files().choose({.title = "Save the film in a folder named",
                         .save = true,
                         .folder = editor.document.folder(),
                         .name = stem(editor) + "_film"},
                        [this, kind](const fs::path& folder) { app_.film.start(request(app_.editor, kind, folder)); });
  }

  App& app_;
  double width_ = 1920, height_ = 1080, seconds_ = 4, rate_ = 30;
  std::string from_;
};

}  // namespace

std::unique_ptr<Panel> make_picture_panel(App& app) {
  return std::make_unique<PicturePanel>(app);
}

}  // namespace pliant
