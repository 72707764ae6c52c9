#include "player/window/overlay.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "systems/safety/safety.h"
#include "viewer/ui/device_list.h"
#include "viewer/ui/imgui_pen.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

constexpr ImU32 kPlotColor = IM_COL32(0, 0, 0, 90);
const ImVec4 kForceColor(1.0f, 0.62f, 0.34f, 1.0f), kDepthColor(0.41f, 0.745f, 1.0f, 1.0f);
const ImVec4 kDim(0.62f, 0.66f, 0.71f, 1.0f), kGood(0.55f, 0.86f, 0.62f, 1.0f), kBad(1.0f, 0.52f, 0.45f, 1.0f);

// The editor's fonts and spacing, on transparent panels.
void style(float scale) {
  static_cast<void>(ui::set_theme(ui::Theme::kDark, scale));
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowRounding = 8 * scale;
  s.WindowPadding = {14 * scale, 12 * scale};
  s.ItemSpacing = {8 * scale, 5 * scale};
  s.Colors[ImGuiCol_WindowBg] = {0.055f, 0.065f, 0.08f, 0.82f};
  s.Colors[ImGuiCol_FrameBg] = {1, 1, 1, 0.09f};
  s.Colors[ImGuiCol_FrameBgHovered] = {1, 1, 1, 0.18f};
  s.Colors[ImGuiCol_Separator] = {1, 1, 1, 0.10f};
}

// A row: label at the left, value at the right.
void figure(const char* what, const std::string& value, const ImVec4& color = ImGui::GetStyle().Colors[ImGuiCol_Text]) {
  ImGui::TextColored(kDim, "%s", what);
  const float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine(right);
  ImGui::TextColored(color, "%s", value.c_str());
}

std::string bytes(std::uint64_t count) {
  return count < 10000 ? fmt::format("{} B", count) : fmt::format("{:.1f} KiB", static_cast<double>(count) / 1024);
}

// A pause interrupts the curve, a late tick does not.
void curve(Pen& pen, const PlotPanel& panel, const ProbeHistory& history, float ProbeHistory::Bin::*value,
           const LineStyle& style) {
  std::vector<PlotPoint> points;
  for (std::size_t age = 0; age < ProbeHistory::kBins; ++age) {
    const ProbeHistory::Bin* bin = history.bin(age);
    if (!bin && age <= 3) continue;
    points.push_back({-static_cast<double>(age), bin ? static_cast<double>(bin->*value) : std::nan("")});
  }
  draw_line(pen, panel, points, style);
}

void probe_line(const ProbeLine& probe, float scale) {
  // The probe's colour, its name and its force.
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 dot = ImGui::GetCursorScreenPos();
  const auto shown = [](float linear) { return std::pow(std::clamp(linear, 0.0f, 1.0f), 1 / 2.2f); };
  list->AddCircleFilled(
      {dot.x + 5 * scale, dot.y + 0.5f * ImGui::GetTextLineHeight()}, 5 * scale,
      ImGui::ColorConvertFloat4ToU32({shown(probe.color.x), shown(probe.color.y), shown(probe.color.z), 1.0f}));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 17 * scale);
  ImGui::Text("%s", probe.name.c_str());
  const ProbeHistory::Bin& now = probe.history.newest();
  const std::string force = fmt::format("{:.2f} N", now.force), depth = fmt::format("{:.1f} mm", now.depth * 1e3f);
  const float wide = ImGui::CalcTextSize("00.0 mm").x, right = ImGui::GetWindowContentRegionMax().x;
  ImGui::SameLine(right - 2 * wide - 6 * scale);
  ImGui::TextColored(kForceColor, "%s", force.c_str());
  ImGui::SameLine(right - wide);
  ImGui::TextColored(kDepthColor, "%s", depth.c_str());
}

// The limits that currently change the force.
void limit_line(const ProbeLine& probe, float scale) {
  const std::uint8_t limited = probe.history.limited();
  const auto say = [&](SafetyLimit limit, const char* words) {
    if (!(limited & bit(limit))) return;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 17 * scale);
    ImGui::TextColored(kBad, "%s", words);
  };
  say(SafetyLimit::kClipped, "clipped at max_force");
  say(SafetyLimit::kWithheld, "passivity: damped");
  say(SafetyLimit::kGated, "gate closed: lift off to feel force again");
}

void plot(const ProbeLine& probe, float scale) {
  float force = 0.1f, depth = 1e-4f;
  for (std::size_t age = 0; age < ProbeHistory::kBins; ++age)
    if (const ProbeHistory::Bin* bin = probe.history.bin(age)) {
      force = std::max(force, bin->force);
      depth = std::max(depth, bin->depth);
    }
  force = static_cast<float>(round_above(static_cast<double>(force)));
  depth = static_cast<float>(round_above(static_cast<double>(depth)));

  probe_line(probe, scale);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 52 * scale);
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, kPlotColor, 4 * scale);
  ui::ImGuiPen pen(*list, {});
  PlotPanel panel{at.x, at.y, size.x, size.y, {1.0 - ProbeHistory::kBins, 0.0}, {}};
  const LineStyle grid{kPaper, 1, false, 0.09};
  for (int second = 1; second < 5; ++second) draw_upright(pen, panel, panel.across.low * second / 5, grid);
  draw_level(pen, panel, 0.5, grid);
  for (const bool force_now : {false, true}) {
    panel.up.high = static_cast<double>(force_now ? force : depth);
    curve(pen, panel, probe.history, force_now ? &ProbeHistory::Bin::force : &ProbeHistory::Bin::depth,
          {ui::plot_color(force_now ? kForceColor : kDepthColor), 1.5 * static_cast<double>(scale)});
  }
  const std::string top = fmt::format("{:g} N  {:g} mm", force, depth * 1e3f);
  ImGui::SetWindowFontScale(0.8f);
  list->AddText(ImGui::GetFont(), ImGui::GetFontSize(), {at.x + 5 * scale, at.y + 2 * scale},
                IM_COL32(160, 170, 180, 190), top.c_str());
  ImGui::SetWindowFontScale(1.0f);
  ImGui::Dummy(size);
}

void draw_figures(const OverlayState& state) {
  const TouchFigures& touch = state.touch;
  figure("tick p50, p99, max", fmt::format("{:.0f}  {:.0f}  {:.0f} us", touch.p50, touch.p99, touch.max));
  figure("overruns", std::to_string(touch.overruns), touch.overruns ? kBad : kGood);
  if (state.soft) {
    const SoftFigures& soft = *state.soft;
    figure("soft step, contacts", fmt::format("{:.1f} ms  {}", soft.step_ms, soft.contacts));
    figure("soft overruns", std::to_string(soft.overruns), soft.overruns ? kBad : kGood);
  }
  std::string pictures = fmt::format("{:.0f} Hz  {:.1f} ms", state.frames_per_second, state.draw_ms);
  if (state.resolution < 1) pictures += fmt::format("  at {:.0f} %", 100 * state.resolution);
  figure("pictures", pictures);
  figure("awake vertices", std::to_string(state.awake_vertices));
  figure("upload per picture", bytes(state.upload_bytes));
}

void draw_switches(RenderOptions& options, float tint, float scale) {
  ImGui::Separator();
  bool height = options.tint_height > 0, second = false;
  for (const Switch& each : switches()) {
    if (std::exchange(second, !second)) ImGui::SameLine(150 * scale);
    ImGui::Checkbox(each.name, each.of ? &(options.*each.of) : &height);
  }
  options.tint_height = height ? (options.tint_height > 0 ? options.tint_height : tint) : 0.0f;
}

void draw_help(const OverlayState& state, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.93f);
  ImGui::Begin("keys", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::Text("Mouse and keys");
  ImGui::Separator();
  const auto row = [&](const char* key, const char* what, const ImVec4& color) {
    ImGui::TextColored(color, "%s", key);
    ImGui::SameLine(250 * scale);
    ImGui::Text("%s", what);
  };
  if (!state.stop_keys.empty()) row(state.stop_keys.c_str(), key_row(kStopAction).words, kBad);
  for (const MouseRow& each : mouse_rows()) row(each.how, each.words, kForceColor);
  std::string keys, words;
  const auto flush = [&] {
    if (!keys.empty()) row(keys.c_str(), words.c_str(), kForceColor);
    keys = words = "";
  };
  for (const KeyRow& each : key_rows()) {
    if (each.id == std::string(kStopAction)) continue;
    const bool continues = each.words[0] == ',' || each.words[0] == ';';
    if (!continues) flush();
    keys += (continues ? ", " : "") + std::string(each.window);
    words += each.words;
  }
  flush();
  ImGui::End();
}

void draw_message(const OverlayState& state, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, size.y - 16 * scale}, ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.8f * size.x, 0.5f * size.y});
  ImGui::Begin("message", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(0.75f * size.x);
  ImGui::TextColored(state.message_is_error ? kBad : ImGui::GetStyle().Colors[ImGuiCol_Text], "%s",
                     state.message.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

// A ring that shrinks and turns warmer with the force: a visual substitute for haptic feedback.
void draw_cursor(const OverlayState& state, float scale) {
  ImDrawList* list = ImGui::GetForegroundDrawList();
  const ImVec2 at(static_cast<float>(state.cursor_x), static_cast<float>(state.cursor_y));
  const float share = static_cast<float>(state.cursor_force / (1.0 + state.cursor_force));
  const float radius = (state.pressing ? 13.0f - 7.0f * share : 13.0f) * scale;
  const int warm = static_cast<int>(255 - 150 * share);
  list->AddCircle(at, radius, IM_COL32(0, 0, 0, 120), 32, 3.5f * scale);
  list->AddCircle(at, radius, IM_COL32(255, warm, state.pressing ? warm - 60 : warm, 235), 32, 1.8f * scale);
  list->AddCircleFilled(at, 1.8f * scale, IM_COL32(255, 255, 255, 235));
  if (!state.pressing) return;
  const std::string text = fmt::format("{:.2f} N", state.cursor_force);
  list->AddText({at.x + 19 * scale, at.y - 8 * scale}, IM_COL32(0, 0, 0, 200), text.c_str());
  list->AddText({at.x + 18 * scale, at.y - 9 * scale}, IM_COL32(255, 240, 230, 255), text.c_str());
}

}  // namespace

std::span<const Switch> switches() {
  using O = RenderOptions;
  static constexpr Switch kSwitches[] = {
      {"wireframe", &O::wireframe, "view.wireframe"},
      {"zones", &O::zones, "view.zones"},
      {"height as colour", nullptr, "view.height"},
      {"shadows", &O::shadows, "view.shadows"},
      {"contact frames", &O::contact_frames, "view.contact_frames"},
      {"force arrows", &O::forces, "play.forces"},
      {"probes", &O::markers, ""},
      {"bump", &O::bump, ""},
      {"reflection", &O::reflection, ""},
      {"refraction", &O::refraction, ""},
      {"tetrahedra", &O::tetrahedra, "view.tetrahedra"},
      {"contacts", &O::contacts, "play.contacts"},
      {"handles", &O::handles, "view.handles"},
      {"surroundings", &O::background, ""},
  };
  return kSwitches;
}

void ProbeHistory::add(const TickRow& row) {
  const auto number = static_cast<std::int64_t>(row.time / kSeconds * static_cast<double>(kBins));
  Bin& bin = bins_[static_cast<std::size_t>(number) % kBins];
  if (bin.number != number) bin = {number, 0, 0, 0, 0, 0};
  bin.limited = static_cast<std::uint8_t>(bin.limited | row.limited);
  newest_ = number;
  bin.force = std::max(bin.force, static_cast<float>(length(row.reading.force)));
  if (row.reading.in_contact) bin.depth = std::max(bin.depth, static_cast<float>(row.reading.depth));
  bin.pair_force = static_cast<float>(row.reading.normal_force);
  bin.pair_depth = row.reading.in_contact ? static_cast<float>(row.reading.depth) : 0.0f;
}

std::uint8_t ProbeHistory::limited() const {
  std::uint8_t bits = 0;
  for (std::size_t age = 0; static_cast<double>(age) * kSeconds < kLimitSeconds * static_cast<double>(kBins); ++age)
    if (const Bin* each = bin(age)) bits = static_cast<std::uint8_t>(bits | each->limited);
  return bits;
}

const ProbeHistory::Bin* ProbeHistory::bin(std::size_t age) const {
  const std::int64_t number = newest_ - static_cast<std::int64_t>(age);
  if (number < 0) return nullptr;
  const Bin& bin = bins_[static_cast<std::size_t>(number) % kBins];
  return bin.number == number ? &bin : nullptr;
}

Overlay::Overlay(float scale) : scale_(scale) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no settings file
  io.LogFilename = nullptr;
  style(scale);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Overlay::~Overlay() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

bool Overlay::wants_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

void Overlay::draw_panel(const OverlayState& state, RenderOptions& options, float tint) {
  ImGui::SetNextWindowPos({12 * scale_, 12 * scale_}, ImGuiCond_Always);
  ImGui::SetNextWindowSize({(large_ ? 300.0f : 232.0f) * scale_, 0}, ImGuiCond_Always);
  ImGui::Begin("figures", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::Text("%s", state.title.c_str());
  const std::string right = state.paused ? "paused" : fmt::format("{:.1f} s", state.touch.time);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(right.c_str()).x);
  ImGui::TextColored(state.paused ? kBad : kDim, "%s", right.c_str());
  ImGui::Separator();
  const TouchFigures& touch = state.touch;
  figure("touch", fmt::format("{:.0f} of {:.0f} Hz", touch.rate, state.rate_wanted),
         touch.rate > 0.98 * state.rate_wanted || state.paused ? kGood : kBad);
  if (large_) {
    draw_figures(state);
  } else {
    figure("pictures", fmt::format("{:.0f} Hz", state.frames_per_second));
  }
  for (const ProbeLine& probe : state.probes) {
    if (large_) ImGui::Separator();
    (large_ ? plot : probe_line)(probe, scale_);
    limit_line(probe, scale_);
  }
  if (large_) draw_switches(options, tint, scale_);
  // Small at first, so that it does not cover the objects.
  if (ImGui::SmallButton(large_ ? "less" : "more")) large_ = !large_;
  ImGui::SameLine();
  ImGui::TextColored(kDim, "F1 keys   Tab hides this");
  ImGui::End();
}

void Overlay::draw_devices(const OverlayState& state) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float wide = 304 * scale_, edge = 12 * scale_;
  ImGui::SetNextWindowPos({size.x - edge, edge}, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSizeConstraints({wide, 0}, {wide, std::max(size.y - 2 * edge, 1.0f)});
  ImGui::Begin("devices", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  {
    const ui::Scope scope("Devices");
    ui::device_list(state.devices, state.stop_keys, orders_);
  }
  ImGui::End();
}

void Overlay::draw_question(const OverlayState& state) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(560 * scale_, 0.8f * size.x), 0}, ImGuiCond_Always);
  ImGui::Begin("question", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushTextWrapPos(0);
  for (const std::string& line : state.question) ImGui::TextUnformatted(line.c_str());
  ImGui::PopTextWrapPos();
  ImGui::Separator();
  {
    const ui::Scope scope("Question");
    if (ui::button("Allow for this file", "It is remembered for this file and these words")) orders_.allow = true;
    ImGui::SameLine();
    if (ui::button("Not now", "Go on without that device")) orders_.decline = true;
  }
  ImGui::End();
}

void Overlay::draw(const OverlayState& state, RenderOptions& options, float tint, const OverlayMouse& mouse, int width,
                   int height, double dt) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(dt, 1e-4, 1.0));
  io.MousePos = {static_cast<float>(mouse.x), static_cast<float>(mouse.y)};
  for (std::size_t i = 0; i < mouse.down.size(); ++i) io.MouseDown[i] = mouse.down[i];
  io.MouseWheel = static_cast<float>(mouse.wheel);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  if (state.figures) draw_panel(state, options, tint);
  if (state.figures && state.show_devices) draw_devices(state);
  if (state.figures && state.panel.shown) draw_side_panel(state);
  if (!state.question.empty()) draw_question(state);
  if (state.help) draw_help(state, scale_);
  if (!state.message.empty()) draw_message(state, scale_);
  if (state.cursor && !io.WantCaptureMouse) draw_cursor(state, scale_);
  ui::end_widgets();
  ImGui::Render();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_FRAMEBUFFER_SRGB);  // the overlay's colours are already encoded
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace pliant
