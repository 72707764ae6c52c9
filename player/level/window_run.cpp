#include "player/level/window_run.h"

#include <fmt/format.h>

#include <filesystem>

#include "content/device_answers.h"
#include "content/files/file_io.h"
#include "editor/core/settings.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

constexpr int kWindowWidth = 1280, kWindowHeight = 720;  // [pixel]

// Options for a dropped file: options that refer to the first level's nodes and files are removed and listed in `left`.
RunOptions another_level(const RunOptions& asked, const std::string& file, std::string& left) {
  RunOptions other = asked;
  other.level = file;
  for (const auto& [given, name] : {std::pair(!asked.probes.empty(), "--probe"),
                                    {!asked.sets.empty(), "--set"},
                                    {!asked.record.empty(), "--record"},
                                    {!asked.tool_force.empty(), "--tool-force"},
                                    {asked.unit.has_value(), "--unit"},
                                    {asked.force, "--force"}})
    if (given) left += std::string(left.empty() ? "" : ", ") + name;
  other.probes.clear();
  other.sets.clear();
  other.record.clear();
  other.force = false;
  other.tool_force.clear();
  other.unit.reset();
  if (!asked.out.empty()) other.out = asked.out + "/" + std::filesystem::path(file).stem().string();
  return other;
}

// Options to open the same level again, with results beside those already written.
RunOptions same_level(const RunOptions& options, const RunOptions& asked) {
  RunOptions other = options;
  other.force = false;
  std::error_code ignored;
  // The current recording will be moved to its name soon.
  for (int n = 2; !options.record.empty() &&
                  (n == 2 || other.record == options.record || std::filesystem::exists(other.record, ignored));
       ++n)
    other.record = numbered(asked.record, n).string();
  return other;
}

// The window's question about device requests that are not permitted.
std::vector<std::string> question_of(const Prepared& run) {
  if (run.refused.empty()) return {};
  std::vector<std::string> lines{
      "This level asks for devices, addresses or files of this machine. Allow it only if you "
      "know who made it."};
  for (const LevelRequest& asked : run.refused) {
    lines.push_back("`" + asked.moves + "` by " + asked.id);
    for (const std::string& sentence : asked.request.refused) lines.push_back("    " + sentence);
  }
  return lines;
}

Status allow_all(const Prepared& run) {
  DeviceAnswers answers = DeviceAnswers::load();
  for (const LevelRequest& asked : run.refused)
    if (Status kept = answers.allow(run.file, asked.id); !kept) return kept;
  return Done{};
}

}  // namespace

Outcome open_window(const RunOptions& options, std::optional<Shown>& shown) {
  const bool possible = !options.headless && !options.lockstep && options.replay.empty();
  if (!options.window && (!possible || !Window::display_is_there())) {
    if (!options.input.empty())
      return wrong_arguments(
          {"--input", "needs a window; leave out --headless, --lockstep and --replay, and set DISPLAY"});
    return {};
  }
  InputScript script;
  if (!options.input.empty()) {
    auto loaded = InputScript::load(options.input);
    if (!loaded) return failed(loaded.error());
    script = std::move(loaded).value();
  }
  auto window = Window::create(options.sized ? options.width : kWindowWidth,
                               options.sized ? options.height : kWindowHeight, ", or use --headless");
  if (!window) {
    if (options.window) return failed(window.error());
    note("running without a window: " + window.error().sentence());
    return {};
  }
  if (options.frames > 0 && options.seconds <= 0.0)
    return wrong_arguments({"--frames", "spreads pictures over a duration; give --seconds, or use --fps"});
  shown.emplace(Shown{std::move(window).value(), std::move(script)});
  return {};
}

Ran run_shown(const RunOptions& options, const Prepared& run, Shown& shown, TouchLoop& loop, DeviceLinks& devices,
              Prepared& next) {
  const RunOptions& asked = run.asked;
  WindowSession session{*shown.window, shown.script, loop.runner.world(), loop.runner, loop.journal,
                        loop.keeper,   loop.out,     loop.interrupt};
  if (devices.any()) session.devices = &devices;
  session.live = loop.live;
  session.sliders = run.sliders;
  session.level = options.level;
  session.question = question_of(run);
  session.allow = [&run] { return allow_all(run); };
  std::string unread;
  const Settings settings = Settings::load({}, unread);
  if (!unread.empty()) note(unread);
  const auto keys = settings.keys.find(kStopAction);
  session.stop_keys = keys == settings.keys.end() || keys->second.empty() ? kStopKeys : keys->second;
  session.rate = loop.runner.world().simulation.touch_rate;
  session.ticks = loop.ticks;
  session.quality = options.quality;
  session.frame_width = options.width;
  session.frame_height = options.height;
  session.frame_ticks = loop.frame_ticks;
  // Measuring needs the context, which belongs to this thread: the choice for the first level is reused.
  const std::string field = loop.runner.world().field_place == FieldPlace::kGpu ? "gpu" : "cpu";
  session.open = [&options, &asked, &next, field](const std::string& file) -> std::optional<Error> {
    next = Prepared();
    std::string left;
    RunOptions other = file == options.level ? same_level(options, asked) : another_level(asked, file, left);
    other.field = field;
    if (Outcome wrong = prepare(other, true, next)) return wrong->error;
    if (!left.empty())
      say(next, fmt::format("the options {} are for the first level and do not hold for `{}`", left, next.world.name));
    next.options = other;
    next.asked = asked;
    return {};
  };
  try {
    WindowFigures figures = run_window(session);
    return {"window",       figures.overruns, figures.frames, figures.pictures,
            figures.opened, figures.ended,    figures.hung,   std::move(figures.opening)};
  } catch (const std::exception& error) {
    Ran ran;
    ran.mode = "window";
    ran.ended = explain(error);
    return ran;
  }
}

}  // namespace pliant
