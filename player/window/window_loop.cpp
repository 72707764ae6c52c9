#include "player/window/window_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "content/openable.h"
#include "lab/console/exit.h"
#include "lab/files/content_folder.h"
#include "player/run/touch_loop.h"
#include "runtime/printable.h"
#include "systems/device/mouse.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr vec3 kToolColor(0.85f, 0.55f, 0.42f);               // linear: of a tool's plot
constexpr double kMessageTime = 8.0;                          // [s]
constexpr float kTintShare = 0.2f;                            // [1] of the reach: height at full colour
constexpr double kSlowestTurn = 0.25;                         // [s] after a longer iteration, motion does not catch up
constexpr double kSmoothing = 0.1;                            // [1] weight of the newest picture in the shown rate
constexpr double kHearEvery = 0.004;                          // [s] longest interval between input polls
constexpr std::size_t kLongestTitle = 28, kLongestName = 16;  // [byte] in the panel
constexpr double kHungEnd = 10.0;                             // [s] for which the end waits for a picture
constexpr double kHungPicture = 2.0;  // [s] after a longer picture the hand moves unseen: the heartbeat stops

// Of the first probe of the mouse, else of the first tool that it may carry.
MouseHand hand_in(World& world, const Viewpoint& view) {
  MouseHand hand;
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const HapticDevice* device = world.registry.find<HapticDevice>(probe.device);
    if (!device || device->driver != DriverKind::kMouse) continue;
    hand.take(Pointer(world, probe.radius, view, probe.meets));
    return hand;
  }
  if (std::optional<Carrier> carrier = Carrier::of(world)) hand.take(*std::move(carrier));
  return hand;
}

// A file name cut to a panel's width, in whole characters.
std::string cut(const std::string& name, std::size_t longest) {
  std::string shown = printable(name);
  if (shown.size() <= longest) return shown;
  while (longest > 0 && (static_cast<unsigned char>(shown[longest]) & 0xc0) == 0x80) --longest;
  return shown.substr(0, longest) + "...";
}

// A dangling link counts as present.
bool is_there(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
}

float tint_of(const World& world) {
  double reach = 0.0;
  for (auto [entity, deformable] : world.registry.view<Deformable>()) reach = std::max(reach, deformable.reach);
  return reach > 0 ? kTintShare * static_cast<float>(reach) : 0.01f;
}

// The levels beside this one, then the shipped ones.
std::vector<std::string> levels_to_open(const std::string& level) {
  std::vector<std::string> all;
  const std::filesystem::path folder = std::filesystem::path(level).parent_path();
  std::error_code failed;
  for (std::filesystem::directory_iterator it(folder.empty() ? "." : folder, failed), end; !failed && it != end;
       it.increment(failed))
    if (has_ending(it->path(), level_endings()))
      all.push_back(folder.empty() ? it->path().filename().string() : it->path().string());
  std::sort(all.begin(), all.end());
  for (const std::filesystem::path& each : shipped_levels())
    if (std::find(all.begin(), all.end(), each.string()) == all.end()) all.push_back(each.string());
  return all;
}

}  // namespace

WindowLoop::WindowLoop(WindowSession& session, Renderer& renderer)
    : s_(session),
      camera_(default_viewpoint(session.world), drawn_box(session.world, false)),
      hand_(hand_in(session.world, camera_.viewpoint())),
      options_(renderer.options()),
      tint_(tint_of(session.world)),
      pictures_(session.window, session.world, renderer) {
  options_.quality = session.quality;
  state_.title = cut(session.world.name, kLongestTitle);
  state_.rate_wanted = session.rate;
  for (std::size_t i = 0; i < session.journal.probes().size(); ++i) {
    const ProbeSummary& summary = session.keeper.summaries()[i];
    const Probe* probe = session.world.registry.find<Probe>(session.journal.probes()[i]);
    state_.probes.push_back(
        {cut(summary.name, kLongestName), cut(summary.source, kLongestTitle), probe ? probe->color : kToolColor, {}});
    if (summary.source == "mouse") mouse_probe_ = i;
    if (session.journal.probes()[i] == hand_.tool()) carried_ = i;
  }
  state_.panel.level = session.level;
  state_.panel.levels = levels_to_open(session.level);
  state_.stop_keys = session.devices ? session.stop_keys : std::string();
  state_.show_devices = session.devices != nullptr;
  for (const std::string& line : session.question) state_.question.push_back(printable(line));
  mouse_.x = 0.5 * session.window.width();
  mouse_.y = 0.5 * session.window.height();
  if (const std::optional<dvec3> at = hand_.update(0.0)) {
    probe_at_ = *at;
    add_mouse(session.world, probe_at_);
  }
  list_hands();
  list_sliders();
  if (carried_ && hand_.taken_device() == kNoEntity)
    say("drag `" + session.keeper.summaries()[*carried_].name + "` with the left button to move it", false);
}

ViewRay WindowLoop::ray() const {
  return ray_through(camera_.viewpoint(), cursor_.x(), cursor_.y(), s_.window.width(), s_.window.height());
}

// Sends the probe's target to the touch clock in every iteration, moved or not: it serves as a heartbeat, and its
// absence is a time-out. A hung picture stops the heartbeat too.
void WindowLoop::point(double dt) {
  const double force = mouse_probe_ ? state_.probes[*mouse_probe_].history.newest().force : 0.0;
  cursor_.update(hand_.grip() == MouseHand::Grip::kPress, force, dt);  // a pull stretches towards the hand
  if (!hand_.has_probe() && !hand_.has_tool()) return;
  if (hand_.has_tool() || (pointed_ && !looks_around())) {
    if (drag_ == Drag::kHand) hand_.follow(ray(), camera_.viewpoint());
    probe_at_ = *hand_.update(dt);
  }
  if (pictures_.seconds() < kHungPicture) {
    s_.world.mouse->samples.write() = {probe_at_, hand_.free(), hand_.has_tool() ? hand_.taken_device() : taken_,
                                       hand_.probe_hold()};
    s_.world.mouse->samples.publish();
  }
  state_.cursor = hand_.has_probe() && pointed_ && !looks_around();
  state_.cursor_x = cursor_.x();
  state_.cursor_y = cursor_.y();
  state_.cursor_force = force;
  state_.pressing = hand_.pressing();
  s_.window.hide_cursor(state_.cursor && !wants_mouse_);
}

void WindowLoop::keep() {
  s_.keeper.keep(s_.journal);
  for (const TickRow& row : s_.keeper.latest()) {
    state_.probes[row.probe].history.add(row);
    if (row.probe == carried_) tool_at_ = row.device_position;
    for (Holdable& each : holdable_)
      if (row.probe == each.journal) each.at = row.device_position;
    record_.add(row);
  }
  if (record_.full()) record();
  state_.panel.recording = record_.on() ? std::optional(record_.seconds()) : std::nullopt;
}

// Returns the next requested picture; a slow GPU skips some.
std::filesystem::path WindowLoop::next_frame() {
  const std::uint64_t reached = touch_ ? touch_->now() : 0;
  if (!touch_ || next_frame_ >= s_.frame_ticks.size() || s_.frame_ticks[next_frame_] > reached) return {};
  while (next_frame_ < s_.frame_ticks.size() && s_.frame_ticks[next_frame_] <= reached) ++next_frame_;
  return s_.out.stage(fmt::format("frame-{:04d}.png", figures_.pictures));
}

// Named at once, without replacing existing files: the user requested it.
std::filesystem::path WindowLoop::next_screenshot() const {
  std::filesystem::path file;
  for (int i = 1; file.empty() || is_there(file); ++i) file = s_.out.path() / fmt::format("screenshot-{:03d}.png", i);
  return file;
}

PictureOrder WindowLoop::order(bool shown) {
  if (touch_) {
    state_.touch = touch_->figures();
    state_.paused = touch_->paused();
    if (s_.runner.soft().any()) state_.soft = s_.runner.soft().latest();
  }
  if (s_.devices) {
    s_.devices->view(state_.devices);
    state_.devices.late_ticks = state_.touch.overruns;
  }
  if (seconds_ - said_at_ > kMessageTime) state_.message.clear();
  PictureOrder next;
  next.view = camera_.viewpoint();
  next.width = s_.window.width();
  next.height = s_.window.height();
  next.dt = seconds_ - ordered_at_;
  next.options = options_;
  next.overlay = state_;
  next.mouse = mouse_;
  next.tint = tint_;
  const bool asked = drag_ == Drag::kAsked;
  const double x = asked ? pressed_x_ : cursor_.x(), y = asked ? pressed_y_ : cursor_.y();
  next.question = {x, y, next.width, next.height, ++questions_, hand_.holds()};
  asked_ray_ = ray_through(next.view, x, y, next.width, next.height);
  next.frame = next_frame();
  next.frame_width = s_.frame_width;
  next.frame_height = s_.frame_height;
  if (screenshots_ > 0) {  // one per picture, so that each has its own number
    --screenshots_;
    shooting_ = next_screenshot();
  }
  next.screenshot = shooting_;
  next.shown = shown;
  ordered_options_ = options_;
  ordered_at_ = seconds_;
  mouse_.wheel = 0;
  mouse_.down = down_;
  return next;
}

// Takes the result of a picture: figures, the overlay's switches, and the object under the cursor.
Status WindowLoop::learn(const PictureDone& done) {
  figures_.pictures += done.framed;
  if (!done.failed) return done.failed;
  if (!done.frame) return done.frame;
  figures_.frames.add(done.stats);
  state_.upload_bytes = done.stats.upload_bytes;
  state_.draw_ms = done.stats.draw_ms;
  state_.awake_vertices = done.awake_vertices;
  state_.resolution = done.resolution;
  const double dt = seconds_ - ordered_at_;
  frame_time_ = frame_time_ > 0 ? frame_time_ + kSmoothing * (dt - frame_time_) : dt;
  state_.frames_per_second = frame_time_ > 0 ? 1 / frame_time_ : 0;
  if (done.options != ordered_options_) options_ = done.options;
  wants_mouse_ = done.wants_mouse;
  widgets_ = done.widgets;
  press_widgets();
  if (s_.devices && done.orders.any()) s_.devices->order(done.orders);
  take(done.panel_orders);
  if (done.orders.allow || done.orders.decline) answer_question(done.orders.allow);
  if (!shooting_.empty() && !done.screenshot && is_there(shooting_))
    ++screenshots_;  // another window has taken the name meanwhile
  else if (!shooting_.empty())
    say(done.screenshot ? shooting_.string() : done.screenshot.error().message(), !done.screenshot);
  shooting_.clear();
  if (!done.answer) return Done{};
  answer_ = done.answer;
  hand_.see(done.answer->seen, asked_ray_);
  if (drag_ == Drag::kAsked && done.answer->question.number >= decides_) decide();
  return Done{};
}

// Pictures before the clock starts: one-time driver work is done here, and the drawing speed becomes known.
Status WindowLoop::warm_up() {
  for (int i = 0; i < 3; ++i) {
    pictures_.begin(order(false));
    if (const Status& failed = pictures_.done().failed; !failed) return failed;
  }
  s_.window.show(s_.world.name + " - Pliant");
  if (Window::lost()) return Window::loss();
  return Done{};
}

// Polls input and orders pictures beside the touch clock.
Status WindowLoop::turn_until_the_end() {
  std::vector<InputEvent> events;
  const std::uint64_t start = now_ns();
  while (!close_ && !figures_.opened && !touch_->done() && !s_.interrupt.requested()) {
    events.clear();
    s_.window.poll(events, kHearEvery);
    if (Window::lost()) return Window::loss();
    s_.script.take(static_cast<double>(now_ns()) * 1e-9, events);
    const double now = static_cast<double>(now_ns() - start) * 1e-9, dt = std::min(now - seconds_, kSlowestTurn);
    seconds_ = now;
    for (const InputEvent& event : events) handle(event);
    camera_.update(dt);
    keep();
    point(dt);
    look_for_opened();
    if (pictures_.busy()) continue;
    if (begun_)
      if (const Status seen = learn(pictures_.done()); !seen) return seen;
    pictures_.begin(order(true));
    begun_ = true;
  }
  return Done{};
}

WindowFigures WindowLoop::run() {
  if (const Status ready = warm_up(); !ready) {
    figures_.ended = ready;
    return std::move(figures_);
  }
  Status status = Done{};
  try {
    status = s_.runner.start(s_.ticks);
    touch_ = s_.runner.clock();
    if (status) status = turn_until_the_end();
  } catch (const std::exception& error) {  // the clock's rows and figures are kept
    status = explain(error);
  }
  touch_ = nullptr;
  s_.runner.stop();
  try {
    keep();
    figures_.hung = !pictures_.wait(kHungEnd);
    if (figures_.hung && status)
      status = Error{"picture", "the graphics driver does not answer", "update it, or use --headless"};
    if (begun_ && status) status = learn(pictures_.done());
  } catch (const std::exception& error) {
    if (status) status = explain(error);
  }
  figures_.opening = std::move(opening_);
  if (!Window::lost() && !figures_.hung) s_.window.hide_cursor(false);
  if (!s_.runner.has_priority()) note(kNoPriority);
  figures_.overruns = s_.runner.overruns();
  figures_.ended = status;
  if (s_.runner.error()) figures_.ended = *s_.runner.error();
  return std::move(figures_);
}

WindowFigures run_window(WindowSession& session) {
  auto renderer = Renderer::create(session.world);
  if (!renderer) {
    WindowFigures none;
    none.ended = renderer.error();
    return none;
  }
  auto loop = std::make_unique<WindowLoop>(session, **renderer);
  WindowFigures figures = loop->run();
  if (figures.hung) static_cast<void>(loop.release());  // its thread still uses it
  loop.reset();
  // GPU objects are freed with their context. A lost display or a hung driver cannot free them, so the renderer is not
  // destroyed then.
  if (Window::lost() || figures.hung) static_cast<void>(std::move(renderer).value().release());
  return figures;
}

}  // namespace pliant
