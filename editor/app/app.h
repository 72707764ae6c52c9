// The program `pliant edit`: a window, the panels around the viewport, and one iteration of its loop.
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "editor/app/crease_lines.h"
#include "editor/app/film.h"
#include "editor/app/findings.h"
#include "editor/app/guide_lines.h"
#include "editor/app/layout.h"
#include "editor/app/question.h"
#include "editor/app/view_bar.h"
#include "editor/core/panel.h"
#include "editor/core/settings.h"
#include "editor/edit.h"
#include "editor/play/play.h"
#include "editor/play/rendered.h"
#include "editor/ui/host.h"
#include "editor/ui/script.h"
#include "editor/viewport/stage.h"

namespace pliant {

class Files;

class App {
 public:
  App(const EditOptions& options, Window& window);
  ~App();
  Status run();

  Editor editor;
  Settings settings;
  Stage& stage() { return *stage_; }
  Play& play() { return play_; }
  void toggle_play();              // play, pause, resume
  void step_play(double seconds);  // 0: one tick
  Window& window() { return window_; }
  const std::vector<Action>& actions() const { return actions_; }
  const std::vector<std::unique_ptr<ViewTool>>& tools() const { return tools_; }
  ViewTool* tool();
  void take_tool(const std::string& name);
  Panel* panel(const std::string& name);
  void show_panel(const std::string& name);  // brings its tab to the front; opens a dialog
  bool is_open(const std::string& name) const { return open_.contains(name) && open_.at(name); }  // for dialogs
  void close_panel(const std::string& name) { open_[name] = false; }
  std::string keys_of(const Action& action) const;  // with current bindings
  std::string keys_of(const std::string& id) const;
  void do_action(const std::string& id);

  Files& files() { return *files_; }
  const std::vector<std::filesystem::path>& shipped() const { return options_.levels; }
  void ask(Question question);                   // questions are asked one at a time
  void look_changed() { look_changed_ = true; }  // for settings; applied at the next frame
  // While the keys page waits for a new binding of this action, it is returned as text in `rebound`.
  std::string rebinding, rebound;

  // Handles drops on the window: files, folders, several at once (app/drop.cpp).
  void drop(const std::vector<std::string>& files);
  // Opens a file; asks first if there are unsaved changes.
  void open(const std::filesystem::path& file);
  void new_document();
  bool save();  // false: it asks for a name, or saving failed
  // Runs `then` at once, or after asking what to do with unsaved changes.
  void leave_document(std::function<void()> then);
  void close();  // closes the window; asks first
  ImVec2 viewport_corner() const { return viewport_low_; }
  ImVec2 viewport_size() const { return {viewport_high_.x - viewport_low_.x, viewport_high_.y - viewport_low_.y}; }
  const StagePicture& picture() const { return picture_; }
  void screenshot(const std::filesystem::path& file);  // of the next frame
  Film film{*this};                                    // pictures and films of the viewport
  // An order for a picture of the level alone, without grid, symbols and selection.
  StageOrder plain_order(const Viewpoint& view, int width, int height);
  void play_stepwise();               // begins to play, paused
  std::vector<ViewLine> extra_lines;  // from panels, for the next picture; cleared every frame

 private:
  void frame(std::span<const InputEvent> arrived, double dt);
  void notice_changes();  // of the document and the view: another picture
  Status follow_script(std::vector<InputEvent>& events);
  Layout layout() const;
  void draw_all(const Layout& at, double dt);
  bool shortcut_counts(const Action& action, const InputEvent& event) const;
  void keys(std::span<const InputEvent> events);
  void draw_top(float high);
  void draw_menus();
  void draw_menu(const std::string& group);
  void draw_view_mode();
  float tools_width(bool signs) const;  // [pixel] of the toolbar, and of the play buttons
  bool top_has_two_rows() const;
  void draw_bottom_bar();
  void draw_side(Panel::Place place, ImVec2 low, ImVec2 high);
  void draw_tabs(Panel::Place place);
  void draw_viewport(ImVec2 low, ImVec2 high, double dt);
  ViewportInput viewport_input(ImVec2 low, ImVec2 high, double dt);
  bool offer_to_tool(const ViewportInput& in);
  void move_camera(const ViewportInput& in, bool active, bool taken);
  void pick(const ViewportInput& in, bool taken);
  void draw_start(ImVec2 low, ImVec2 high);
  bool ask_for_devices();
  void begin_play();
  void draw_play_buttons();
  Status write_felt(const std::filesystem::path& file) const;  // of the last run, a row a tick
  void draw_play_over(ImDrawList& list, ImVec2 low, ImVec2 high);
  bool touch(const ViewportInput& in);  // mouse input in a played level; true: handled
  bool as_played() const;               // the picture comes from the renderer
  double orthographic() const;          // [m]; the renderer has only perspective
  void draw_toasts();
  // `shown` [point]: the drawn size, possibly smaller than the requested one; a drag starts from it.
  void splitter(const char* name, double& place, double shown, bool vertical, ImVec2 low, ImVec2 high, double sign);
  SolidOrder look_of_document() const;
  void order_picture();
  void draw_opening();  // what takes long to open can be given up
  void ask_to_leave();
  void draw_question();
  void draw_banners();
  void set_look();
  bool settled() const { return under_way().empty(); }
  std::string under_way() const;  // what the editor is still doing; "": nothing
  void say_figures(const std::string& name);
  void take_screenshot(const std::filesystem::path& file);

  EditOptions options_;
  Window& window_;
  std::optional<ui::Host> host_;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Files> files_;
  FindingsWatch findings_;
  std::vector<std::unique_ptr<Panel>> panels_;
  std::vector<std::unique_ptr<ViewTool>> tools_;
  std::vector<Action> actions_;
  std::optional<ui::Script> script_;
  int frames_after_script_ = 0;
  std::map<std::string, bool> open_;   // dialogs
  std::set<std::string> wanted_tabs_;  // brought to the front in the next frame
  std::string wanted_menu_;            // opens in the next frame
  bool menu_by_hover_ = false;         // the open menu was opened by hovering
  bool popup_was_open_ = false;        // at the start of this frame: Esc belongs to it
  StagePicture picture_;
  std::string said_trouble_;  // of pictures
  std::uint64_t order_ = 0, question_ = 0;
  std::optional<dvec2> asked_;
  ViewBar view_bar_;
  CreaseLines creases_;
  GuideLines guides_;
  std::pair<int, int> viewport_size_now() const;  // [pixel] of a picture
  std::pair<int, int> ordered_size_{0, 0};
  SolidOrder ordered_;           // of the last ordered picture; its state is not kept
  bool wants_question_ = false;  // the mouse has moved since the last pick request
  ImVec2 viewport_low_{0, 0}, viewport_high_{1, 1};
  bool dragging_view_ = false, pressed_in_view_ = false, moved_since_press_ = false;
  ImVec2 pressed_at_{0, 0};
  Play play_{editor};
  Rendered rendered_;
  enum class Hand : std::uint8_t { kNone, kAsked, kHolds, kView };
  Hand hand_ = Hand::kNone;               // what a press in a played level has become
  std::uint64_t hand_asked_ = 0;          // the pick request that decides it
  bool hand_pulls_ = false;               // pressed with Ctrl
  std::vector<ViewLine> lines_;           // of the picture ordered last
  std::optional<std::uint64_t> selects_;  // the pick request whose result will be selected
  bool select_adds_ = false;
  bool closing_ = false, dirty_picture_ = true;
  bool wants_out_ = false;               // it was asked to close, and may still have a question
  bool opening_shown_ = false;           // its dialog was there in the frame before
  std::optional<Error> not_opened_;      // why the file that it was started with is not there
  std::function<void()> after_leaving_;  // what waits for an answer about unsaved changes
  std::deque<Question> questions_;
  bool look_changed_ = false;
  std::filesystem::path shot_;
  std::uint64_t shown_revision_ = ~std::uint64_t{0};
  ViewSettings shown_view_;
  double frame_ms_ = 0.0;  // of the user interface
  double most_computed_ms_ = 0.0;
  std::vector<double> frames_ms_;  // while a script runs
  double slow_ = 0.0;              // [s] minimal frame time, set by a script
};

}  // namespace pliant
