#include <algorithm>
#include <iterator>
#include <memory>

#include "components/haptic_device.h"
#include "components/world.h"
#include "content/keys/enum_words.h"
#include "engine/choice/model_choice.h"
#include "player/verbs/options.h"

namespace pliant {

CLI::App* add_run_options(CLI::App& app, RunOptions& run) {
  CLI::App* verb = app.add_subcommand("run", "run a level or touch a bare mesh; writes forces, plot, pictures, report");
  CLI::Option* level =
      verb->add_option("level", run.level, "level or mesh: a file, or the name of a shipped level (three_probes)")
          ->check(named());
  verb->add_flag("--list", run.list, "shipped levels, each with its content")->excludes(level);
  verb->add_option(
          "--probe", run.probes,
          "NAME=SOURCE moves that probe or tool, or adds a point probe: script:FILE.csv, orbit, hand[:WORDS], mouse, "
          "device:ID; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  verb->add_option(
          "--set", run.sets,
          "one key of the level for this run: NODE.EXT.KEY=VALUE, NODE a name, a glTF number or *; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  add_unit(verb, run.unit, "unit of a bare mesh (m; required of one over 5 m across)");
  verb->add_option("--seconds", run.seconds,
                   "duration [s], up to 86400; default: to the end of the longest script, else 4")
      ->check(within(1e-4, 86400.0));
  verb->add_option("--rate", run.rate, "touch clock [Hz]; default: the level's")
      ->check(within(kTouchRateRange.min, kTouchRateRange.max));
  CLI::Option* lockstep =
      verb->add_flag("--lockstep", run.lockstep, "virtual time, repeats to the bit (default without a window)");
  verb->add_flag("--realtime", run.realtime, "real time; overruns are counted")->excludes(lockstep);
  verb->add_option("--field", run.field,
                   "computes the drawn surface on: auto, cpu, gpu, which requires a graphics context (auto)")
      ->check(one_of({"auto", "cpu", "gpu"}));
  verb->add_option("--tool-force", run.tool_force,
                   "1 kHz force of every tool: " + joined(words_of<ToolForce>()) + "; default: each tool's key")
      ->check(one_of(words_of<ToolForce>()));
  verb->add_option("--max-force", run.max_force, "limit on the force that the level asks for [N] (10)")
      ->check(within(1e-3, DeviceRange::kMaxForce.max));
  verb->add_option("--error", run.error, "error budget of every surface and soft body: the cheapest models within it")
      ->check(within(kErrorBudget.min, kErrorBudget.max));
  add_limits(verb);
  verb->add_option("--out", run.out, "folder of the results (out/<level name>); FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", run.force, "replace the results of an earlier run in that folder, and its recording");
  CLI::Option* frames = verb->add_option("--frames", run.frames, "pictures spread over the run (12); 0: no graphics")
                            ->check(within(0, 9999));
  verb->add_option("--fps", run.fps, "pictures per simulated second instead")
      ->check(within(1e-3, 1000))
      ->excludes(frames);
  verb->add_option_function<std::string>(
      "--size",
      [&run](const std::string& text) {
        if (const std::string wrong = parse_size(text, run); !wrong.empty()) throw CLI::ValidationError(wrong);
      },
      "of pictures and window, WxH, 16 to 8192 (960x540, 1280x720)");
  const std::vector<std::string> qualities(std::begin(kPictureQualities), std::end(kPictureQualities));
  verb->add_option_function<std::string>(
          "--quality",
          [&run, qualities](const std::string& word) {
            const auto at = std::find(qualities.begin(), qualities.end(), word) - qualities.begin();
            run.quality = static_cast<PictureQuality>(at);
          },
          "of pictures and window: " + joined(qualities) + "; what each adds: docs/reference.md (high)")
      ->check(one_of(qualities));
  CLI::Option* headless = verb->add_flag("--headless", run.headless, "no window (default where there is no display)");
  verb->add_flag("--window", run.window, "in a window (default where there is a display)")
      ->excludes(headless)
      ->excludes(lockstep);
  verb->add_option("--input", run.input, "events for the window from a CSV file")
      ->group("")
      ->check(named());  // docs/cli.md
  verb->add_option("--record", run.record, "writes the pose of every probe and tick to FILE")->check(named());
  verb->add_option("--replay", run.replay, "moves the probes by FILE, in lockstep")->check(named());
  verb->add_option("--threads", run.threads,
                   "threads for loading, preparing and the soft step; results do not depend on it; 0: all (0)")
      ->check(within(0, 1024));
  verb->add_option("--soft-store", run.soft_store, "folder of soft bodies that the runs of a sweep share")
      ->group("")
      ->check(named());  // player/sweep
  verb->footer(
      "Examples:\n"
      "  pliant run\n"
      "  pliant run organ.glb --probe finger=orbit --set '*.deformable.stiffness=500' --frames 4\n"
      "  pliant run scan_in_millimetres.stl --unit mm\n"
      "  pliant run level.gltf --probe tip=script:press.csv --record press.pose --out out/press");
  return verb;
}

void add_run(CLI::App& app, int& status) {
  const auto options = std::make_shared<RunOptions>();
  add_run_options(app, *options)->callback([options, &status] {
    status = options->list ? list_levels() : run(*options);
  });
}

}  // namespace pliant
