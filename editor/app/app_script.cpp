// A script that drives the program: its steps and its requests.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "editor/app/app.h"
#include "editor/core/painting.h"
#include "viewer/picture/window_png.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr int kFramesAfterScript = 5;  // for what its last step does

}  // namespace

Status App::follow_script(std::vector<InputEvent>& events) {
  // Only the script controls mouse and keys: a pointer resting over the new window would interfere.
  std::erase_if(events, [](const InputEvent& event) { return event.kind != InputKind::kClose; });
  ui::Script::Surroundings at;
  at.under_way = under_way();
  at.now = editor.now;
  at.screenshot = [this](const std::string& name) { screenshot(fs::path(options_.out) / name); };
  at.figures = [this](const std::string& name) { say_figures(name); };
  at.felt = [this](const std::string& name) { return write_felt(fs::path(options_.out) / name); };
  at.slow = [this](double seconds) { slow_ = std::clamp(seconds, 0.0, 2.0); };
  at.has_said = [this](const std::string& text) {
    return std::any_of(editor.said.begin(), editor.said.end(),
                       [&](const Said& said) { return said.text.find(text) != std::string::npos; });
  };
  if (host_->has_waiting()) at.under_way = "what was pressed before";
  if (Status s = script_->next(at, events); !s) {
    take_screenshot(fs::path(options_.out) / "failed.png");
    return s;
  }
  if (script_->done() && settled() && ++frames_after_script_ > kFramesAfterScript) {
    take_screenshot(fs::path(options_.out) / "failed.png");
    if (wants_out_)
      return script_->ended("closes a level with changes that are in no file, and answers no question",
                            "end with `click Unsaved/Discard` or `click Unsaved/Save`");
    return script_->ended("leaves the editor open", "end with `close`");
  }
  return Done{};
}

std::string App::under_way() const {
  if (!editor.jobs.idle()) {
    const std::vector<std::string> jobs = editor.jobs.under_way();
    return jobs.empty() ? "a job" : jobs.front();
  }
  if (film.under_way()) return "a film";
  if (editor.painting->working()) return "a stroke";
  if (editor.camera.moving()) return "the camera's way";
  if (play_.on()) return play_.ready() ? "" : "opening the level to play";  // playing redraws forever
  if (rendered_.waits()) return "the rendered picture";
  return stage_->busy() || picture_.order != order_ || dirty_picture_ ? "a picture" : "";
}

void App::say_figures(const std::string& name) {
  std::vector<double> all = std::exchange(frames_ms_, {});
  if (all.empty()) return;
  std::sort(all.begin(), all.end());
  const auto slow = std::count_if(all.begin(), all.end(), [](double ms) { return ms > 50.0; });
  const std::string line = fmt::format(
      "{}: {} frames of the interface, median {:.1f} ms, 99 % within {:.1f} ms, slowest {:.1f} ms, {} above 50 ms; at "
      "most {:.1f} ms of it computing; picture {:.0f} ms",
      name, all.size(), all[all.size() / 2], all[all.size() * 99 / 100], all.back(), slow,
      std::exchange(most_computed_ms_, 0.0), picture_.draw_ms);
  editor.say(line);
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void App::screenshot(const fs::path& file) {
  shot_ = file;
}

void App::take_screenshot(const fs::path& file) {
  std::error_code ignored;
  if (!file.parent_path().empty()) fs::create_directories(file.parent_path(), ignored);
  const Status written = write_file(file, window_png(window_.width(), window_.height()));
  editor.say(written ? "Screenshot in " + file.string() : written.error().message(),
             written ? Severity::kNote : Severity::kError);
}

}  // namespace pliant
