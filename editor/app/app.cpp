// The program: its parts, its loop, and one frame.
#include "editor/app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <thread>

#include "editor/app/files.h"
#include "editor/core/painting.h"
#include "runtime/clock.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr double kIdleWait = 0.25, kBusyWait = 0.016;  // [s] between frames

// [ms] CPU time of this thread, without waiting for other threads, programs and the display.
double computed_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

App::App(const EditOptions& options, Window& window) : options_(options), window_(window) {
  std::string note;
  settings = Settings::load(options.config, note);
  ui::remember_sections(&settings.sections);
  play_.answers = DeviceAnswers::load(options.config);
  host_.emplace(window_);
  set_look();
  editor.request_close = [this] { close(); };
  editor.jobs.wake = [] { glfwPostEmptyEvent(); };
  files_ = std::make_unique<Files>(*this, options.input.empty());
  actions_ = make_actions(*this);
  tools_ = make_tools(*this);
  panels_ = make_panels(*this);
  play_.show = [this](auto make) {
    rendered_.forget();
    stage_->show(std::move(make));
  };
  editor.on_change.push_back([this](const State& before, const State& after) { play_.changed(before, after); });
  if (!note.empty()) editor.say(note, Severity::kWarning);
}

void App::set_look() {
  host_->set_theme(settings.light ? ui::Theme::kLight : ui::Theme::kDark,
                   settings.scale > 0.0 ? static_cast<float>(settings.scale) : window_.scale());
}

App::~App() {
  play_.stop();  // devices are released first
  stage_.reset();
  host_.reset();
}

Status App::run() {
  auto stage = Stage::create(window_, [] { glfwPostEmptyEvent(); });
  if (!stage) return stage.error();
  stage_ = *std::move(stage);
  if (!options_.input.empty()) {
    auto script = ui::Script::load(options_.input);
    if (!script) return script.error();
    script_ = *std::move(script);
  }
  if (!options_.file.empty() && (find_recovery(options_.file, state_folder()) || lock_holder(options_.file))) {
    files_->open(options_.file, options_.unit);  // asks for a file, or reports who has it open
  } else if (!options_.file.empty()) {
    files_->load(options_.file, options_.unit, false, [this](const Error& why) { not_opened_ = why; });
  }
  window_.show("Pliant");
  std::uint64_t before = now_ns();
  const std::uint64_t began = before;
  std::vector<InputEvent> events;
  while (!closing_) {
    const bool busy = script_ || !settled() || editor.playing || dragging_view_;
    events.clear();
    window_.poll(events, host_->has_waiting() ? 0.0 : busy ? kBusyWait : kIdleWait);
    if (Window::lost()) {
      files_->save_what_can_be();
      return Window::loss();
    }
    if (slow_ > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(slow_));
    const std::uint64_t now = now_ns();
    editor.now = static_cast<double>(now - began) * 1e-9;
    if (script_) {
      if (Status s = follow_script(events); !s) return s;
    }
    if (std::exchange(look_changed_, false)) {
      set_look();
      dirty_picture_ = true;
    }
    frame(events, static_cast<double>(now - before) * 1e-9);
    before = now;
    if (not_opened_) return *not_opened_;
    window_.present();
  }
  files_->close_in_order();
  return settings.save();
}

ViewTool* App::tool() {
  for (const auto& each : tools_)
    if (editor.tool == each->name()) return each.get();
  return tools_.empty() ? nullptr : tools_.front().get();
}

void App::take_tool(const std::string& name) {
  if (editor.tool == name) return;
  if (ViewTool* before = tool()) before->leave(editor);
  editor.tool = name;
  if (name == "Paint") show_panel(name);  // its brush is there
}

Panel* App::panel(const std::string& name) {
  for (const auto& each : panels_)
    if (name == each->name()) return each.get();
  return nullptr;
}

void App::show_panel(const std::string& name) {
  wanted_tabs_.insert(name);
  open_[name] = true;
}

std::string App::keys_of(const Action& action) const {
  const auto bound = settings.keys.find(action.id);
  return bound == settings.keys.end() ? action.keys : bound->second;
}

std::string App::keys_of(const std::string& id) const {
  for (const Action& each : actions_)
    if (each.id == id) return keys_of(each);
  return {};
}

void App::do_action(const std::string& id) {
  for (const Action& each : actions_)
    if (each.id == id && each.enabled(editor)) {
      each.run(editor);
      return;
    }
}

void App::leave_document(std::function<void()> then) {
  if (!editor.document.worth_keeping()) {
    then();
    return;
  }
  after_leaving_ = std::move(then);
}

void App::open(const fs::path& file) {
  files_->open(file);
}

void App::new_document() {
  leave_document([this] { editor.take(Document()); });
}

bool App::save() {
  return files_->save();
}

void App::close() {
  wants_out_ = true;
  leave_document([this] { closing_ = true; });
}

void App::notice_changes() {
  if (editor.document.revision() != shown_revision_) {
    shown_revision_ = editor.document.revision();
    for (const auto& each : editor.state().nodes) ui::draws(each->node.name);
    ui::draws(editor.document.title());
    dirty_picture_ = true;
  }
  if (!(editor.view == shown_view_)) {
    shown_view_ = editor.view;
    dirty_picture_ = true;
  }
}

void App::frame(std::span<const InputEvent> arrived, double dt) {
  const std::uint64_t began = now_ns();
  const double computed_before = computed_ms();
  popup_was_open_ = ui::popup_is_open();
  const std::vector<InputEvent> events = host_->begin(arrived, editor.now, dt);
  editor.jobs.deliver(editor);
  editor.painting->update();
  files_->update();
  findings_.update(editor);
  keys(events);
  notice_changes();
  if (ViewTool* t = tool();
      !ImGui::IsMouseDown(0) && !ImGui::IsAnyItemActive() && !(t && t->wants_keys()) && !editor.painting->stroking())
    editor.document.end_gesture();
  const bool was_moving = editor.camera.moving();
  editor.camera.update(std::min(dt, 0.1));
  dirty_picture_ |= was_moving;

  play_.update();
  film.update();
  rendered_.update(editor, *stage_, editor.view.shading == Shading::kRendered && !play_.on());
  picture_ = stage_->picture();
  if (picture_.trouble != said_trouble_) {
    said_trouble_ = picture_.trouble;
    if (!said_trouble_.empty()) editor.say(said_trouble_, Severity::kError);
  }
  for (auto it = editor.said.rbegin(); it != editor.said.rend() && it - editor.said.rbegin() < 8; ++it)
    ui::draws(it->text);
  if (const std::string news = ui::take_undrawable(); !news.empty()) editor.say(news, Severity::kWarning);
  editor.hovered = kNoNode;  // set again by the tree and the viewport
  draw_all(layout(), dt);
  wanted_tabs_.clear();
  ui::end_widgets();
  if (const auto refused = ui::take_refused()) editor.say(*refused, Severity::kWarning);
  host_->end();
  order_picture();
  extra_lines.clear();
  if (!shot_.empty()) take_screenshot(std::exchange(shot_, {}));
  frame_ms_ = static_cast<double>(now_ns() - began) * 1e-6;
  if (!script_) return;
  frames_ms_.push_back(frame_ms_);
  most_computed_ms_ = std::max(most_computed_ms_, computed_ms() - computed_before);
}

Status edit(const EditOptions& options) {
  auto window = Window::create(options.width, options.height);
  if (!window) {
    Error error = window.error();
    error.where = "pliant edit";
    return error;
  }
  App app(options, **window);
  return app.run();
}

}  // namespace pliant
