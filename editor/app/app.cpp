#include "editor/app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "editor/app/files.h"
#include "editor/tools/painting.h"
#include "runtime/clock.h"
#include "runtime/printable.h"
#include "viewer/picture/window_png.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr float kTop = 40, kBar = 26;  // [point]
constexpr float kTopPad = 9;           // [point] above the buttons of the top bar
constexpr float kTopRow = 32;          // [point] of a second row of it
constexpr float kLeastLeft = 160, kLeastRight = 300, kLeastBottom = 90, kLeastView = 200, kGoodView = 320;  // [point]
constexpr double kToastSeconds = 6.0;
constexpr int kFramesAfterScript = 5;                  // for what its last step does
constexpr double kIdleWait = 0.25, kBusyWait = 0.016;  // [s] between frames
constexpr float kClick = 4;                            // [point] a press that moves farther is a drag

vec4 as_vec(const ImVec4& c, float alpha = 1.0f) {
  return {c.x, c.y, c.z, alpha};
}

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

// [ms] CPU time of this thread, without waiting for other threads, programs and the display.
double computed_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

bool begin_fixed(const char* name, ImVec2 low, ImVec2 high, ImGuiWindowFlags flags = 0) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
  return ImGui::Begin(name, nullptr, kFixed | flags);
}

}  // namespace

App::App(const EditOptions& options, Window& window) : options_(options), window_(window) {
  std::string note;
  settings = Settings::load(options.config, note);
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

std::string App::under_way() const {
  if (!editor.jobs.idle()) {
    const std::vector<std::string> jobs = editor.jobs.under_way();
    return jobs.empty() ? "a job" : jobs.front();
  }
  if (editor.painting->working()) return "a stroke";
  if (editor.camera.moving()) return "the camera's way";
  if (play_.on()) return play_.ready() ? "" : "opening the level to play";  // playing redraws forever
  if (rendered_.waits()) return "the rendered picture";
  return stage_->busy() || picture_.order != order_ || dirty_picture_ ? "a picture" : "";
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

void App::screenshot(const fs::path& file) {
  shot_ = file;
}

void App::keys(std::span<const InputEvent> events) {
  for (const InputEvent& event : events) {
    if (event.kind == InputKind::kClose) close();
    if (event.kind == InputKind::kDrop) drop(event.files);
    if (event.kind != InputKind::kKey) continue;
    const std::string pressed = keys_text(event.key, event.modifiers);
    const auto urgent = std::find_if(actions_.begin(), actions_.end(), [&](const Action& each) {
      return each.always && !pressed.empty() && keys_of(each) == pressed && each.enabled(editor);
    });
    if (urgent != actions_.end()) {
      urgent->run(editor);
      continue;
    }
    if (!rebinding.empty()) {
      if (!pressed.empty()) rebound = pressed;
      continue;
    }
    const ViewTool* const t = tool();
    if (event.key == GLFW_KEY_TAB && (event.modifiers & (kControl | kAlt)) == 0 && !(t && t->wants_keys())) {
      ui::focus_next(event.modifiers & kShift);
      continue;
    }
    if (!questions_.empty() || after_leaving_) continue;  // they come first
    for (const Action& action : actions_) {
      if (pressed.empty() || keys_of(action) != pressed || !shortcut_counts(action, event)) continue;
      if (action.enabled(editor)) action.run(editor);
      break;
    }
  }
}

// Keys go to the text field with focus, then to the menu, dialog or widget with keyboard focus, then to the program.
bool App::shortcut_counts(const Action& action, const InputEvent& event) const {
  const ViewTool* const t = const_cast<App*>(this)->tool();
  if ((ImGui::GetIO().WantTextInput || (t && t->wants_keys())) && !action.while_typing) return false;
  if (event.repeated && !action.repeats && action.id != "edit.undo" && action.id != "edit.redo") return false;
  const bool plain = (event.modifiers & (kControl | kAlt)) == 0 && event.key < GLFW_KEY_F1;
  if (plain && popup_was_open_) return false;
  const bool dialog = std::any_of(panels_.begin(), panels_.end(), [&](const auto& each) {
    return each->place() == Panel::Place::kOver && is_open(each->name());
  });
  if (plain && dialog) return false;
  constexpr int kOfWidgets[] = {GLFW_KEY_SPACE, GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER, GLFW_KEY_LEFT,
                                GLFW_KEY_RIGHT, GLFW_KEY_UP,    GLFW_KEY_DOWN};
  return !(plain && ui::keyboard_has_focus() &&
           std::find(std::begin(kOfWidgets), std::end(kOfWidgets), event.key) != std::end(kOfWidgets));
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
  if (ViewTool* t = tool();
      !ImGui::IsMouseDown(0) && !ImGui::IsAnyItemActive() && !(t && t->wants_keys()) && !editor.painting->stroking())
    editor.document.end_gesture();
  const bool was_moving = editor.camera.moving();
  editor.camera.update(std::min(dt, 0.1));
  dirty_picture_ |= was_moving;

  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float rows = top_has_two_rows() ? kTop + kTopRow : kTop;
  const ImVec2 points(size.x / ui::scale(), size.y / ui::scale());
  // The wished size, reduced in a small window so that the viewport keeps its space.
  const auto shown = [](double wish, float least, float most) {
    return std::clamp(wish, static_cast<double>(least), static_cast<double>(std::max(most, least)));
  };
  const float view = std::clamp(points.x - kLeastLeft - kLeastRight, kLeastView, kGoodView);
  const double wide_right = shown(settings.right, kLeastRight, points.x - kLeastLeft - view),
               wide_left = shown(settings.left, kLeastLeft, points.x - static_cast<float>(wide_right) - view),
               high_bottom = shown(settings.bottom, kLeastBottom, points.y - rows - kBar - kLeastView);
  const float left = ui::px(static_cast<float>(wide_left)), right = size.x - ui::px(static_cast<float>(wide_right)),
              top = ui::px(rows), bar = size.y - ui::px(kBar), bottom = bar - ui::px(static_cast<float>(high_bottom)),
              seam = ui::px(3);

  play_.update();
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
  draw_top(top);
  draw_side(Panel::Place::kLeft, {0, top}, {left - seam, bar});
  draw_side(Panel::Place::kRight, {right + seam, top}, {size.x, bar});
  draw_side(Panel::Place::kBottom, {left, bottom + seam}, {right, bar});
  draw_viewport({left, top}, {right, bottom}, dt);
  draw_bottom_bar();
  splitter("Left edge", settings.left, wide_left, true, {left - seam, top}, {left, bar}, 1);
  splitter("Right edge", settings.right, wide_right, true, {right, top}, {right + seam, bar}, -1);
  splitter("Bottom edge", settings.bottom, high_bottom, false, {left, bottom}, {right, bottom + seam}, -1);
  for (const auto& each : panels_)
    if (each->place() == Panel::Place::kOver && open_[each->name()]) {
      const ui::Scope scope(each->name());
      each->draw(editor);
    }
  draw_banners();
  draw_toasts();
  draw_opening();
  ask_to_leave();
  draw_question();
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

float App::tools_width(bool signs) const {
  const ImGuiStyle& style = ImGui::GetStyle();
  float wide = 0;
  for (const auto& each : tools_)
    wide += ImGui::CalcTextSize(signs ? each->sign() : each->name()).x + 2 * style.FramePadding.x + ui::px(2);
  return wide + ui::px(ui::kWide) + 5 * (ImGui::GetFrameHeight() + ui::px(8));  // play buttons
}

bool App::top_has_two_rows() const {
  const ImGuiStyle& style = ImGui::GetStyle();
  float wide = ImGui::CalcTextSize("SolidRendered").x + 4 * style.FramePadding.x + ui::px(2 * ui::kPad + 3 * ui::kWide);
  std::string before;
  for (const Action& action : actions_)
    if (action.group != before)
      wide += ImGui::CalcTextSize((before = action.group).c_str()).x + 2 * style.FramePadding.x + ui::px(2);
  return wide + tools_width(false) > ImGui::GetIO().DisplaySize.x;
}

void App::draw_top(float high) {
  const ui::Palette& p = ui::palette();
  const float all = ImGui::GetIO().DisplaySize.x;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kPad), ui::px(kTopPad)));
  begin_fixed("top", {0, 0}, {all, high}, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  draw_menus();
  float used = ImGui::GetCursorPosX();
  const bool two_rows = top_has_two_rows();
  const auto tools = [&] {
    {
      const ui::Scope scope("Tools");
      const bool signs = tools_width(false) + ui::px(2 * ui::kPad) > all;
      for (const auto& each : tools_) {
        const std::string shown = std::string(signs ? each->sign() : each->name()) + "###" + each->name();
        if (ui::choice_button(shown.c_str(), tool() == each.get(), each->hint(), each->usable(editor)))
          take_tool(each->name());
        ui::known_as(each->name());
        ImGui::SameLine(0, ui::px(2));
      }
    }
    ImGui::SameLine(0, ui::px(ui::kWide));
    draw_play_buttons();
  };
  if (!two_rows) {  // viewport tools, after the menus
    ImGui::SameLine(0, ui::px(ui::kWide));
    tools();
    ImGui::SameLine();
    used = ImGui::GetCursorPosX();
  }
  // The document's title in the centre of the remaining space; view modes at the right.
  const float buttons =
      ImGui::CalcTextSize("SolidRendered").x + 4 * ImGui::GetStyle().FramePadding.x + ui::px(2 + ui::kPad);
  const std::string title = printable(editor.document.title()) + (files_->read_only() ? " (read-only)" : "") +
                            (editor.document.dirty() ? "  \u2022" : "");
  const float room = all - buttons - ui::px(ui::kWide) - used;
  if (ImGui::CalcTextSize(title.c_str()).x < room) {
    ImGui::SameLine(all - buttons - ui::px(ui::kWide) - ImGui::CalcTextSize(title.c_str()).x);
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, editor.document.dirty() ? p.text : p.dim);
    ImGui::TextUnformatted(title.c_str());
    ImGui::PopStyleColor();
    ui::hint(editor.document.file().empty() ? "This level has no file yet."
                                            : printable(editor.document.file().string()).c_str());
  }
  ImGui::SameLine(all - buttons);
  draw_view_mode();
  if (two_rows) {
    ImGui::SetCursorPos({ui::px(ui::kPad), ui::px(kTopPad + kTopRow)});
    tools();
  }
  ImGui::End();
}

void App::draw_view_mode() {
  const ui::Scope scope("View mode");
  const bool rendered = editor.view.shading == Shading::kRendered;
  if (ui::choice_button("Solid", !rendered, "The level as it is edited, with painted values as colour")) {
    editor.view.shading = Shading::kSolid;
    dirty_picture_ = true;
  }
  ImGui::SameLine(0, ui::px(2));
  if (ui::choice_button("Rendered", rendered, "The level as it is played: materials, surroundings, shadows")) {
    editor.view.shading = Shading::kRendered;
    dirty_picture_ = true;
  }
}

void App::draw_side(Panel::Place place, ImVec2 low, ImVec2 high) {
  const char* const kNames[] = {"left", "right", "bottom"};
  begin_fixed(kNames[static_cast<std::size_t>(place)], low, high);
  if (place == Panel::Place::kLeft) {
    for (const auto& each : panels_) {
      if (each->place() != place || !each->shown(editor)) continue;
      const ui::Scope scope(each->name());
      each->draw(editor);
    }
    ImGui::End();
    return;
  }
  // Padding of the tabs such that all names are readable.
  float names = 0, tabs = 0;
  for (const auto& each : panels_) {
    if (each->place() != place || !each->shown(editor)) continue;
    const std::string badge = each->badge(editor);
    names += ImGui::CalcTextSize((each->name() + (badge.empty() ? "" : "  " + badge)).c_str()).x;
    ++tabs;
  }
  const float air = (ImGui::GetContentRegionAvail().x - names) / std::max(tabs, 1.0f) - ui::px(ui::kGap) - 1;
  const auto airy = [&] {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemInnerSpacing, ImVec2(ui::px(ui::kGap), ui::px(ui::kGap)));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(std::clamp(0.5f * air, ui::px(2), ui::px(ui::kSpace)), ui::px(ui::kGap)));
  };
  airy();
  const bool bar = ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyResizeDown);
  ImGui::PopStyleVar(2);
  if (bar) {
    for (const auto& each : panels_) {
      if (each->place() != place || !each->shown(editor)) continue;
      const std::string badge = each->badge(editor);
      const std::string tab = std::string(each->name()) + (badge.empty() ? "" : "  " + badge) + "###" + each->name();
      airy();
      const bool open = ImGui::BeginTabItem(tab.c_str(), nullptr,
                                            wanted_tabs_.contains(each->name()) ? ImGuiTabItemFlags_SetSelected : 0);
      ImGui::PopStyleVar(2);
      ui::known_as(std::string("Tab/") + each->name());
      if (!open) continue;
      ui::underline_item();  // distinguishes it from a hovered one
      ImGui::BeginChild(each->name());
      {
        const ui::Scope scope(each->name());
        each->draw(editor);
      }
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void App::splitter(const char* name, double& place, double shown, bool vertical, ImVec2 low, ImVec2 high, double sign) {
  begin_fixed(name, low, high, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
  ImGui::SetCursorScreenPos(low);
  ImGui::InvisibleButton("handle", {std::max(high.x - low.x, 1.0f), std::max(high.y - low.y, 1.0f)});
  ui::known_as(name);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  if (ImGui::IsItemActive()) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    const double by = sign * static_cast<double>((vertical ? moved.x : moved.y) / ui::scale());
    if (by != 0.0) place = shown + by;
  }
  const ImVec4& line = ImGui::IsItemActive() || ImGui::IsItemHovered() ? ui::palette().accent : ui::palette().line;
  ImGui::GetWindowDrawList()->AddRectFilled(low, high, ui::color(line));
  ImGui::End();
}

void App::draw_viewport(ImVec2 low, ImVec2 high, double dt) {
  viewport_low_ = low;
  viewport_high_ = high;
  if (editor.state().nodes.empty() && editor.document.file().empty()) {
    dragging_view_ = pressed_in_view_ = false;
    return draw_start(low, high);
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  begin_fixed("viewport", low, high,
              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoBackground |
                  ImGuiWindowFlags_NoNavInputs);
  ImGui::PopStyleVar();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (picture_.texture != 0)
    list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture_.texture)), low, high, {0, 1},
                  {1, 0});
  ImGui::SetCursorScreenPos(low);
  ImGui::InvisibleButton(
      "Viewport", {high.x - low.x, high.y - low.y},
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  ui::known_as("Viewport");
  const ImGuiIO& io = ImGui::GetIO();
  ViewportInput in;
  in.corner = low;
  in.x = static_cast<double>(io.MousePos.x - low.x);
  in.y = static_cast<double>(io.MousePos.y - low.y);
  in.dx = static_cast<double>(io.MouseDelta.x);
  in.dy = static_cast<double>(io.MouseDelta.y);
  in.width = std::max(1, static_cast<int>(high.x - low.x));
  in.height = std::max(1, static_cast<int>(high.y - low.y));
  in.over = ImGui::IsItemHovered();
  const bool active = ImGui::IsItemActive();
  in.pressed = in.over && ImGui::IsMouseClicked(0);
  if (in.pressed) pressed_in_view_ = true;
  in.held = pressed_in_view_ && ImGui::IsMouseDown(0);
  in.released = pressed_in_view_ && ImGui::IsMouseReleased(0);
  in.shift = io.KeyShift;
  in.control = io.KeyCtrl;
  in.alt = io.KeyAlt;
  // Input refers to the displayed picture, though the camera may be ahead of it.
  in.view = picture_.number > 0 ? picture_.view : editor.camera.viewpoint();
  in.orthographic = picture_.number > 0 ? picture_.orthographic : orthographic();
  if (!io.WantTextInput) {
    for (const ImWchar c : io.InputQueueCharacters)
      if (c >= 32 && c < 127) in.typed += static_cast<char>(c);
    const auto key = [](ImGuiKey_ k) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(k)); };
    in.enter = key(ImGuiKey_Enter) || key(ImGuiKey_KeyPadEnter);
    in.escape = key(ImGuiKey_Escape) && !popup_was_open_;
    in.erase = key(ImGuiKey_Backspace);
  }
  in.under = picture_.picked.node;
  in.under_at = picture_.picked.point;
  in.dt = dt;
  if (in.pressed) {
    pressed_at_ = io.MousePos;
    moved_since_press_ = false;
  }
  const ImVec2 away(io.MousePos.x - pressed_at_.x, io.MousePos.y - pressed_at_.y);
  if (std::hypot(away.x, away.y) > ui::px(kClick)) moved_since_press_ = true;

  // Input goes to the tool first, then to the camera, then to selection.
  bool taken = false;
  const bool playing = play_.on();
  if (!in.alt && playing) taken = touch(in);
  if (!in.alt && !taken)
    if (ViewTool* t = tool(); t && t->usable(editor)) taken = t->use(editor, in);
  const bool turns = active && (ImGui::IsMouseDragging(1, 1.0f) || (ImGui::IsMouseDragging(0, 1.0f) && !taken &&
                                                                    (in.alt || moved_since_press_) && !in.shift));
  const bool shifts =
      active && (ImGui::IsMouseDragging(2, 1.0f) || (ImGui::IsMouseDragging(0, 1.0f) && !taken && in.shift) ||
                 (ImGui::IsMouseDragging(1, 1.0f) && in.shift));
  dragging_view_ = turns || shifts;
  if (shifts)
    editor.camera.pan(in.dx, in.dy, in.height);
  else if (turns)
    editor.camera.orbit(in.dx, in.dy, in.height);
  if (in.over && io.MouseWheel != 0 && !taken) editor.camera.zoom(static_cast<double>(io.MouseWheel));
  if (in.released && !taken && !moved_since_press_) {
    asked_ = dvec2(in.x, in.y);
    selects_ = ++question_;
    select_adds_ = in.shift || in.control;
    dirty_picture_ = true;
  } else if (!playing && in.over && (wants_question_ || in.dx != 0 || in.dy != 0)) {
    wants_question_ = dragging_view_ || taken || stage_->busy();
    if (!wants_question_) {
      asked_ = dvec2(in.x, in.y);
      ++question_;
      dirty_picture_ = true;
    }
  }
  if (in.released) pressed_in_view_ = false;
  if (selects_ && picture_.question >= *selects_) {
    editor.select(picture_.picked.node, select_adds_);
    selects_.reset();
    dirty_picture_ = true;
  }
  if (in.over) editor.hovered = !dragging_view_ && !taken ? picture_.picked.node : kNoNode;
  if (taken && (in.dx != 0 || in.dy != 0 || in.pressed || in.released)) dirty_picture_ = true;

  list.PushClipRect(low, high, true);
  if (ViewTool* t = tool()) t->overlay(editor, in, list);
  ViewBar::draw_over(editor, in, list);
  draw_play_over(list, low, high);
  if (!picture_.trouble.empty())
    list.AddText({low.x + ui::px(ui::kPad), high.y - ui::px(28)}, ui::color(ui::palette().bad),
                 picture_.trouble.c_str());
  list.PopClipRect();
  ImGui::End();
  view_bar_.draw(editor, tool(), low, high);
}

void App::draw_start(ImVec2 low, ImVec2 high) {
  Panel* const page = panel("Start");
  if (!page) return;
  begin_fixed("start", low, high);
  {
    const ui::Scope scope("Start");
    page->draw(editor);
  }
  ImGui::End();
}

void App::order_picture() {
  const ui::Palette& p = ui::palette();
  SolidOrder solid;
  solid.view = editor.camera.viewpoint();
  solid.orthographic = orthographic();
  solid.settings = editor.view;
  solid.selected = editor.selected;
  solid.hovered = editor.hovered;
  solid.lines = extra_lines;
  if (ViewTool* t = tool()) t->lines(editor, solid.lines);
  if (editor.view.creases) {
    creases_.update(editor);
    solid.creases = creases_.known();
  }
  solid.above = as_vec(p.raised);
  solid.below = as_vec(p.window);
  solid.grid = as_vec(p.text, 0.16f);
  solid.selected_color = as_vec(p.accent);
  solid.hovered_color = as_vec(p.text, 0.55f);
  for (int i = 0; i < 3; ++i) solid.axis[i] = as_vec(p.axis[i]);
  solid.sign = as_vec(p.dim, 0.9f);
  const bool another =
      !same_scene(solid, ordered_) || solid.hovered != ordered_.hovered || ordered_size_ != viewport_size_now();
  if (!dirty_picture_ && !another && order_ > 0) return;
  dirty_picture_ = false;
  ordered_ = solid;
  lines_ = solid.lines;
  ordered_size_ = viewport_size_now();
  StageOrder order;
  order.width = ordered_size_.first;
  order.height = ordered_size_.second;
  order.solid = std::move(solid);
  order.solid.state = editor.state();
  if (asked_) {
    order.question = asked_;
    order.question_number = question_;
    asked_.reset();
  }
  order_ = stage_->order(std::move(order));
}

std::pair<int, int> App::viewport_size_now() const {
  return {std::max(1, static_cast<int>(viewport_high_.x - viewport_low_.x)),
          std::max(1, static_cast<int>(viewport_high_.y - viewport_low_.y))};
}

void App::draw_bottom_bar() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ui::Palette& p = ui::palette();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kPad), ui::px(4)));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, p.window);
  begin_fixed("bar", {0, size.y - ui::px(kBar)}, size, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  ImGui::PushFont(ui::font(ui::Type::kSmall));
  const std::vector<std::string> under_way = editor.jobs.under_way();
  std::string left = under_way.empty() ? (tool() ? tool()->hint() : "") : under_way.front() + " \u2026";
  if (!editor.said.empty() && editor.now - editor.said.back().time < kToastSeconds && under_way.empty())
    left = editor.said.back().text;
  ImGui::PushStyleColor(ImGuiCol_Text, p.dim);
  ImGui::TextUnformatted(printable(left).c_str());
  const std::string right =
      fmt::format("{} node{}   {:L} triangles   picture {:.0f} ms{}   interface {:.0f} ms", editor.state().nodes.size(),
                  editor.state().nodes.size() == 1 ? "" : "s", picture_.triangles, picture_.draw_ms,
                  picture_.share < 1.0 ? fmt::format(" at {:.0f} %", 100 * picture_.share) : "", frame_ms_);
  ImGui::SameLine(size.x - ImGui::CalcTextSize(right.c_str()).x - ui::px(ui::kPad));
  ImGui::TextUnformatted(right.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::End();
}

// An error stays visible until it has been read.
void App::draw_toasts() {
  if (editor.said.empty()) return;
  const Said& last = editor.said.back();
  if (last.severity == Severity::kNote || editor.now - last.time > 2 * kToastSeconds) return;
  const ui::Palette& p = ui::palette();
  const bool error = last.severity == Severity::kError;
  ImGui::SetNextWindowPos({0.5f * (viewport_low_.x + viewport_high_.x), viewport_high_.y - ui::px(ui::kPad)},
                          ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.8f * (viewport_high_.x - viewport_low_.x), ui::px(200)});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, p.raised);
  ImGui::Begin("said", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos(0.75f * (viewport_high_.x - viewport_low_.x));
  ImGui::PushStyleColor(ImGuiCol_Text, error ? p.bad : p.warning);
  ImGui::TextUnformatted(error ? "Error" : "Warning");
  ImGui::PopStyleColor();
  ImGui::SameLine();
  ImGui::TextUnformatted(printable(last.text).c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleColor();
}

void App::ask_to_leave() {
  if (!after_leaving_) return;
  const ui::Scope scope("Unsaved");
  ImGui::OpenPopup("Unsaved changes");
  ImGui::SetNextWindowPos({0.5f * ImGui::GetIO().DisplaySize.x, 0.4f * ImGui::GetIO().DisplaySize.y}, ImGuiCond_Always,
                          {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(
          "Unsaved changes", nullptr,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove))
    return;
  ui::title("Save the changes?");
  ui::gap();
  ImGui::TextUnformatted(
      fmt::format("{} has changes that are in no file.", printable(editor.document.title())).c_str());
  ui::gap(ui::kPad);
  const auto go = [&] {
    auto then = std::exchange(after_leaving_, nullptr);
    ImGui::CloseCurrentPopup();
    then();
  };
  const bool saves = ui::strong_button("Save", nullptr, true, 110);
  if (ImGui::IsWindowAppearing()) {
    ImGui::SetItemDefaultFocus();
    ui::lead_by_keyboard();
  }
  if (saves) {
    if (editor.document.file().empty()) {
      auto then = std::exchange(after_leaving_, nullptr);
      ImGui::CloseCurrentPopup();
      files_->save_as(std::move(then));
    } else if (save()) {
      go();
    }
  }
  ImGui::SameLine();
  if (ui::button("Discard", "Undo could not bring them back.", true, 110)) go();
  ImGui::SameLine();
  if (ui::button("Cancel", "Esc", true, 110) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
    after_leaving_ = nullptr;
    wants_out_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void App::take_screenshot(const fs::path& file) {
  std::error_code ignored;
  if (!file.parent_path().empty()) fs::create_directories(file.parent_path(), ignored);
  const Status written = write_file(file, window_png(window_.width(), window_.height()));
  editor.say(written ? "Screenshot in " + file.string() : written.error().message(),
             written ? Severity::kNote : Severity::kError);
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
