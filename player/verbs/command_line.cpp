#include "player/verbs/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "components/haptic_device.h"
#include "components/world.h"
#include "content/author/instruments.h"
#include "content/author/presets.h"
#include "content/files/limits.h"
#include "content/keys/enum_words.h"
#include "content/keys/extension_table.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "editor/edit.h"
#include "player/exit.h"
#include "player/fit/fit.h"
#include "player/fit/press_model.h"
#include "player/plot/plot_runs.h"
#include "player/standard_streams.h"
#include "player/study/study.h"
#include "player/sweep/sweep.h"
#include "player/verbs/content_folder.h"
#include "player/verbs/device_test.h"
#include "player/verbs/verbs.h"
#include "pliant/content.h"
#include "pliant/drivers.h"

namespace pliant {
namespace {

// Finite, and within [low, high]; the sentence says the range.
CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value >= low && value <= high) return {};
        return "must be between " + CLI::detail::to_string(low) + " and " + CLI::detail::to_string(high) + "; got '" +
               text + "'";
      },
      "");
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

// One of these words; the sentence lists them.
CLI::Validator one_of(std::vector<std::string> words) {
  return CLI::Validator(
      [words](std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return {};
        return "must be one of " + joined(words) + "; got '" + text + "'";
      },
      "");
}

// A variable of the shell that was not set: the demo level is not meant.
CLI::Validator named() {
  return CLI::Validator([](std::string& text) { return std::string(text.empty() ? "its name is empty" : ""); }, "");
}

// "960x540" -> width, height.
std::string parse_size(const std::string& text, RunOptions& run) {
  int used = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%n", &run.width, &run.height, &used) != 2 ||
      static_cast<std::size_t>(used) != text.size() || run.width < 16 || run.height < 16 || run.width > 8192 ||
      run.height > 8192)
    return "--size: must be WxH with both between 16 and 8192, such as 960x540; got '" + text + "'";
  run.sized = true;
  return {};
}

// --unit of `run` and of `convert`.
void add_unit(CLI::App* verb, double& unit, const char* what) {
  verb->add_option_function<std::string>(
          "--unit",
          [&unit](const std::string& text) {
            const auto metres = parse_unit(text);
            if (!metres) throw CLI::ValidationError(metres.error().where + " " + metres.error().what);
            unit = *metres;
          },
          what)
      ->type_name("m|cm|mm|in|METRES");
}

// --limits of every verb that reads files.
void add_limits(CLI::App* verb) {
  verb->add_option_function<double>("--limits", set_limit_factor,
                                    "multiplies what a file may ask for: nodes, instances, pictures, tetrahedra (1)")
      ->check(within(kLimitFactor.min, kLimitFactor.max))
      ->type_name("N");
}

void add_run(CLI::App& app, RunOptions& run) {
  CLI::App* verb = app.add_subcommand("run", "run a level or touch a bare mesh; writes forces, plot, pictures, report");
  CLI::Option* level =
      verb->add_option("level", run.level, "level or mesh: a file, or the name of a shipped level (three_probes)")
          ->check(named());
  verb->add_flag("--list", run.list, "which levels ship, and what they show")->excludes(level);
  verb->add_option("--probe", run.probes,
                   "NAME=SOURCE: script:FILE.csv, orbit, hand[:FILE.csv], mouse, device:ID; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  verb->add_option("--set", run.sets, "NODE.EXT.KEY=VALUE for this run; NODE may be *; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  add_unit(verb, run.unit, "what one unit of a bare mesh is (m)");
  verb->add_option("--seconds", run.seconds, "how long [s]; default: the longest script, at most 60, else 4")
      ->check(within(1e-4, 86400.0));
  verb->add_option("--rate", run.rate, "touch clock [Hz]; default: the level's")
      ->check(within(kTouchRateRange.min, kTouchRateRange.max));
  CLI::Option* lockstep =
      verb->add_flag("--lockstep", run.lockstep, "virtual time, the same bits every time (default without a window)");
  verb->add_flag("--realtime", run.realtime, "run the clocks; overruns are counted")->excludes(lockstep);
  verb->add_option("--field", run.field, "where the surface is computed: auto, cpu, gpu")
      ->check(one_of({"auto", "cpu", "gpu"}));
  verb->add_option("--tool-force", run.tool_force,
                   "how every tool's force is made: " + joined(words_of<ToolForce>()) + "; default: each tool's key")
      ->check(one_of(words_of<ToolForce>()));
  verb->add_option("--max-force", run.max_force, "the most that the level may ask of a device [N] (10)")
      ->check(within(1e-3, DeviceRange::kMaxForce.max));
  verb->add_option("--error", run.error, "error budget of every surface and soft body: the cheapest models within it")
      ->check(within(1e-6, 10.0));
  add_limits(verb);
  verb->add_option("--out", run.out,
                   "folder for what is written; default: out/<level name>; FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", run.force, "replace the results of an earlier run in that folder, and its recording");
  CLI::Option* frames =
      verb->add_option("--frames", run.frames, "pictures spread over the run (12); 0: none")->check(within(0, 9999));
  verb->add_option("--fps", run.fps, "pictures per simulated second instead")
      ->check(within(1e-3, 1000))
      ->excludes(frames);
  verb->add_option_function<std::string>(
      "--size",
      [&run](const std::string& text) {
        if (const std::string wrong = parse_size(text, run); !wrong.empty()) throw CLI::ValidationError(wrong);
      },
      "of the pictures and the window, WxH (960x540, 1280x720)");
  CLI::Option* headless = verb->add_flag("--headless", run.headless, "no window (default where there is no display)");
  verb->add_flag("--window", run.window, "in a window (default where there is a display)")
      ->excludes(headless)
      ->excludes(lockstep);
  verb->add_option("--input", run.input, "events for the window from a CSV file")
      ->group("")
      ->check(named());  // docs/cli.md
  verb->add_option("--record", run.record, "write every probe's pose per tick to FILE")->check(named());
  verb->add_option("--replay", run.replay, "move the probes as FILE says, in lockstep")->check(named());
  verb->add_option("--threads", run.threads, "threads for loading and preparing; 0: all")->check(within(0, 1024));
  verb->footer(
      "Examples:\n"
      "  pliant run\n"
      "  pliant run organ.glb --probe finger=orbit --set '*.deformable.stiffness=500' --frames 4\n"
      "  pliant run scan_in_millimetres.stl --unit mm\n"
      "  pliant run level.gltf --probe tip=script:press.csv --record press.pose --out out/press");
}

void add_files(CLI::App& app, InspectOptions& inspection, ConvertOptions& conversion, std::string& validated) {
  CLI::App* verb = app.add_subcommand("inspect", "what is in a file, whether it can be touched, what is wrong with it");
  verb->add_option("file", inspection.file, "level, mesh, tetrahedra or EXR panorama")->required()->check(named());
  verb->add_flag("--json", inspection.json, "as JSON");
  CLI::Option* fit = verb->add_flag("--fit", inspection.fit, "which models error budgets choose, and the evidence");
  verb->add_option("--error", inspection.error, "with --fit: error budget of every surface and soft body")
      ->check(within(1e-6, 10.0))
      ->needs(fit);
  add_limits(verb);
  verb->footer("Examples:\n  pliant inspect organ.glb\n  pliant inspect organ.glb --fit --error 0.3");

  verb = app.add_subcommand("convert", "any mesh format to glTF or GLB; an EXR panorama to a cube map preview (PNG)");
  verb->add_option("in", conversion.in, "what to read")->required()->check(named());
  verb->add_option("out", conversion.out, "what to write: .glb, .gltf, or .png for a panorama")
      ->required()
      ->check(named());
  CLI::Option* draco =
      verb->add_option("--draco", conversion.draco_bits, "compress (anew) with this many bits per position (8 to 24)")
          ->check(within(SaveOptions::kDracoBits.min, SaveOptions::kDracoBits.max));
  verb->add_flag("--no-draco", conversion.no_draco, "write plain what is compressed, for every viewer")
      ->excludes(draco);
  verb->add_flag("--reorder", conversion.reorder, "weld, clean and put vertices in spatial order");
  verb->add_flag("--force", conversion.force, "replace what is there");
  add_limits(verb);
  add_unit(verb, conversion.unit, "what one unit of the input is (m)");
  verb->footer(
      "Examples:\n  pliant convert organ.ply organ.glb --unit mm --draco 14\n  pliant convert sky.exr sky.png");

  verb = app.add_subcommand("validate", "every finding of a level with its JSON pointer");
  verb->add_option("level", validated, "level")->required()->check(named());
  add_limits(verb);
  verb->footer("Example:\n  pliant validate level.gltf");
}

void add_author(CLI::App& app, AuthorOptions& options) {
  std::vector<std::string> presets, tools, sides{"none"};
  for (const TissuePreset& preset : tissue_presets()) presets.emplace_back(preset.word);
  for (const Instrument& tool : instruments()) tools.emplace_back(tool.word);
  tools.emplace_back("none");
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack})
    sides.emplace_back(word_of(side));
  CLI::App* verb = app.add_subcommand("author", "a first level from an organ's mesh: soft, pinned, with an instrument");
  verb->add_option("in", options.in, "mesh or level")->required()->check(named());
  verb->add_option("-o,--out", options.out, "the level: .glb or .gltf")->required()->check(named())->type_name("FILE");
  for (const auto& [name, nodes, what] :
       {std::tuple("--soft", &options.soft, "becomes a soft body (default: the largest mesh); may be repeated"),
        std::tuple("--surface", &options.surface, "becomes a deformable surface instead; may be repeated")})
    verb->add_option(name, *nodes, what)->take_all()->allow_extra_args(false)->check(named())->type_name("NODE");
  verb->add_option("--preset", options.preset, "tissue: " + joined(presets) + " (liver)")->check(one_of(presets));
  verb->add_option("--pin", options.pin, "which side of what is soft is held: " + joined(sides) + " (bottom)")
      ->check(one_of(sides));
  verb->add_option("--tool", options.tool, joined(tools) + " (rod where something is soft)")->check(one_of(tools));
  verb->add_flag("--probe", options.probe, "a probe, too");
  verb->add_flag("--force", options.force, "replace what is there");
  add_limits(verb);
  add_unit(verb, options.unit, "what one unit of a bare mesh is (m)");
  verb->footer(
      "Examples:\n"
      "  pliant author organ.glb -o level.glb\n"
      "  pliant author organ.glb --soft capsule --preset liver --pin bottom --tool sphere_tip -o level.glb\n"
      "  pliant author scan.stl --unit mm --surface scan --preset skin -o level.glb");
}

void add_study(CLI::App& app, StudyOptions& options) {
  CLI::App* verb = app.add_subcommand("study", "speed against error: figures, data and a plot");
  CLI::Option* name = verb->add_option("name", options.name, "of a study, or all");
  CLI::Option* list = verb->add_flag("--list", options.list, "which studies there are");
  verb->add_option("--out", options.out,
                   "folder for what is written; default: out/study; FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", options.force, "replace the results of an earlier study in that folder");
  verb->add_flag("--quick", options.quick, "a shorter run, for a look");
  name->excludes(list);
  verb->footer("Example:\n  pliant study all --quick");
}

void add_sweep(CLI::App& app, SweepOptions& options, MergeOptions& merging) {
  CLI::App* verb = app.add_subcommand("sweep", "one level over many settings, on one machine or many");
  verb->add_option("plan", options.plan, "what is varied (docs/sweep.md)")->check(named())->type_name("PLAN.json");
  verb->add_option("--out", options.out, "folder of what was done; default: out/<plan's name>; a sweep there goes on")
      ->check(named());
  verb->add_option("--shard", options.shard,
                   "I/N: only each Nth run, from the Ith on; default: by Slurm's array or MPI's rank, else all")
      ->check(named())
      ->type_name("I/N");
  verb->add_flag("--retry-failed", options.retry_failed, "does runs that failed again");
  verb->add_flag("--list", options.list, "every run with its id, its state and its values; writes nothing");
  verb->add_flag("--dry-run", options.dry_run, "the commands that would run; writes nothing");
  verb->add_option("--jobs", options.jobs, "runs at a time (1)")->check(within(1, 1024));
  verb->footer(
      "Examples:\n"
      "  pliant sweep plan.json --out out/sweep --jobs 4\n"
      "  pliant sweep merge out/sweep --out out/merged");
  CLI::App* merge = verb->add_subcommand("merge", "tables, a report and plots of what sweeps did");
  merge->add_option("folders", merging.folders, "--out of one sweep, or of its shards")->required()->check(named());
  merge->add_option("--out", merging.out, "folder of the tables; FOLDER-2 and on where one has results")
      ->required()
      ->check(named());
  merge->add_flag("--force", merging.force, "replace what an earlier merge wrote there");
  merge->footer("Example:\n  pliant sweep merge out/sweep --out out/merged");
}

void add_fit(CLI::App& app, FitOptions& options) {
  std::vector<std::string> laws{"auto"}, sides;
  for (const std::string& law : press_laws()) laws.push_back(law);
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack})
    sides.emplace_back(word_of(side));
  CLI::App* verb = app.add_subcommand("fit", "a surface's keys from measured presses, finite elements or a sweep");
  verb->add_option("in", options.in, "a level, or measured presses (.csv with columns such as time_s,depth_mm,force_N)")
      ->check(named());
  verb->add_option("--object", options.object, "node of the level (its only one with a mesh)")->check(named());
  verb->add_option("-o,--out", options.out, "the level that is written, .glb or .gltf")
      ->check(named())
      ->type_name("FILE");
  verb->add_option("--report", options.report,
                   "folder of figures and plots (out/fit); FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", options.force, "replace what is there");
  verb->add_option("--radius", options.radius, "of the indenter [m]; 0: a point (finite elements: two cells)")
      ->check(within(0, 1));
  verb->add_option("--level", options.level, "measured: into which level the keys go")->check(named());
  verb->add_option("--law", options.law, "measured: " + joined(laws) + " (auto)")->check(one_of(laws));
  verb->add_option("--probe", options.probe, "measured: which probe of a run's forces.csv")->check(named());
  verb->add_option("--hold-out", options.hold_out, "measured: share of the rows that the fit does not see (0.25)")
      ->check(within(0, 0.5));
  verb->add_option("--confidence", options.confidence, "measured: of the intervals (0.95)")->check(within(0.5, 0.9999));
  verb->add_flag("--damping", options.damping, "measured: fit contact_damping, too");
  verb->add_flag("--contact", options.contact, "measured: fit the depth at which the indenter met the surface, too");
  verb->add_option("--young", options.young, "finite elements: Young's modulus [Pa] (the level's)")
      ->check(within(1e-3, 1e12));
  verb->add_option("--poisson", options.poisson, "Poisson's ratio (the level's; measured: 0.45)")
      ->check(within(0, 0.499));
  verb->add_option("--thickness", options.thickness, "finite elements: of a wall [m] (the level's)")
      ->check(within(0, 1e3));
  verb->add_option("--cell", options.cell, "finite elements: of the lattice [m] (some 16000 tetrahedra)")
      ->check(within(0, 1e3));
  verb->add_option("--pin", options.pin,
                   "finite elements: which side is held: " + joined(sides) + " (the level's, else bottom)")
      ->check(one_of(sides));
  verb->add_option("--reach", options.reach, "finite elements: reach of the dents [m] (what fits best)")
      ->check(within(0, 1e3));
  verb->add_flag("--linear", options.linear,
                 "finite elements: small strains instead of the co-rotational ones of a run");
  verb->add_option("--points", options.points, "finite elements: places that law and shape are fitted at (24)")
      ->check(within(4, 500));
  verb->add_option("--held", options.held, "finite elements: places that the fit does not see (12)")
      ->check(within(1, 500));
  verb->add_option("--sweep", options.sweep, "folder of a sweep: which of its runs comes nearest to --target")
      ->check(named());
  verb->add_option("--target", options.target, "measured presses that a sweep's runs are compared with")
      ->check(named());
  add_limits(verb);
  verb->footer(
      "Examples:\n"
      "  pliant fit hand --object organ -o organ_surface.glb\n"
      "  pliant fit indenter.csv --law hertz --radius 0.003 --level level.glb --object organ -o fitted.glb\n"
      "  pliant fit --sweep out/sweep --target indenter.csv");
}

void add_plot(CLI::App& app, PlotOptions& options) {
  CLI::App* verb = app.add_subcommand("plot", "runs over each other: force over depth and time, spectra, a table");
  verb->add_option("runs", options.runs, "folders of runs, or their forces.csv")->required()->check(named());
  verb->add_option("--probe", options.probes, "only these probes and tools; may be repeated")
      ->take_all()
      ->allow_extra_args(false)
      ->check(named());
  verb->add_option("--out", options.out, "folder (out/plot); FOLDER-2 and on where one has results")->check(named());
  verb->add_flag("--force", options.force, "replace what an earlier plot wrote there");
  verb->footer("Example:\n  pliant plot out/soft out/stiff --out out/compared");
}

void add_edit(CLI::App& app, EditOptions& options, std::string& unit) {
  CLI::App* verb = app.add_subcommand("edit", "the editor: from a mesh to a level that can be touched");
  verb->add_option("file", options.file, "a level, or any mesh; none: the start page");
  verb->add_option("--unit", unit, "of a bare mesh: m, cm, mm, in, or metres for one unit")->capture_default_str();
  verb->add_option_function<std::string>(
      "--size",
      [&options](const std::string& text) {
        RunOptions size;
        if (const std::string wrong = parse_size(text, size); !wrong.empty()) throw CLI::ValidationError(wrong);
        options.width = size.width;
        options.height = size.height;
      },
      "of the window, WxH [1600x900]");
  verb->add_option("--input", options.input, "a script of what a hand does (docs/editor.md)");
  verb->add_option("--out", options.out, "folder of the script's screenshots")->capture_default_str();
  verb->add_option("--config", options.config, "folder of settings; else ~/.config/pliant");
  verb->footer("Examples:\n  pliant edit\n  pliant edit organ.glb --unit mm");
}

// The option that is not known and the one that was probably meant; "" where none is near.
std::string nearest_option(const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::App* verb : app.get_subcommands())
    for (const CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (const std::string& argument : app.remaining(true)) {
    if (!argument.starts_with("--")) continue;
    const std::string option = argument.substr(0, argument.find('='));
    if (const std::string near = suggestion(option, known); !near.empty())
      return "unknown option '" + option + "'" + near;
  }
  return {};
}

// CLI11 says some things over several lines; ours are one sentence that says where to read more.
Error usage_error(const CLI::App& app, const CLI::ParseError& error) {
  std::string where = "arguments", help = "pliant --help";
  for (const CLI::App* verb : app.get_subcommands()) {
    where = verb->get_name();
    help = "pliant " + where + " --help";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const std::string near = nearest_option(app);
    if (!near.empty()) return {where, near};
  }
  std::string what = error.what();
  what = what.substr(0, what.find('\n'));
  while (!what.empty() && (what.back() == '.' || what.back() == ' ')) what.pop_back();
  return {where, what + "; see `" + help + "`"};
}

Error unknown_verb(const std::string& word, const std::vector<CLI::App*>& verbs) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  const std::string near = suggestion(word, names);
  return {"arguments", "unknown verb '" + word + "'" + (near.empty() ? "; see `pliant --help`" : near)};
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{"Pliant: touch soft things, feel the force at 1 kHz", "pliant"};
  app.set_version_flag("--version", "pliant " PLIANT_VERSION);
  app.require_subcommand(1);
  app.footer("Examples:\n  pliant run\n  pliant inspect organ.glb\n  pliant run --help");

  RunOptions run_options;
  ConvertOptions conversion;
  std::string validated;
  InspectOptions inspection;
  bool devices_json = false;
  AuthorOptions authoring;
  add_run(app, run_options);
  add_author(app, authoring);
  add_files(app, inspection, conversion, validated);
  CLI::App* verb = app.add_subcommand("devices", "haptic and pointing devices found, and how to use each");
  verb->add_flag("--json", devices_json, "as JSON");
  DeviceTestOptions device_test;
  CLI::Option* test =
      verb->add_option("--test", device_test.id, "what this one senses, live")->type_name("ID")->check(named());
  verb->add_option("--seconds", device_test.seconds, "how long it is looked at [s] (10)")
      ->check(within(0.1, 86400.0))
      ->needs(test);
  verb->add_flag("--push", device_test.push, "pushes gently along each axis, once that was confirmed")->needs(test);
  verb->footer(
      "Examples:\n  pliant devices --json\n  pliant devices --test spacemouse\n  pliant devices --test falcon --push");
  StudyOptions study_options;
  add_study(app, study_options);
  SweepOptions sweep_options;
  MergeOptions merging;
  add_sweep(app, sweep_options, merging);
  FitOptions fit_options;
  add_fit(app, fit_options);
  PlotOptions plot_options;
  add_plot(app, plot_options);
  EditOptions edit_options;
  std::string edit_unit = "m";
  add_edit(app, edit_options, edit_unit);

  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  const auto is_asked = [&](const CLI::App* known) { return known->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(verbs.begin(), verbs.end(), is_asked))
    return fail(kUsage, unknown_verb(argv[1], verbs));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kUsage, usage_error(app, error));
  }
  const std::string name = app.get_subcommands().front()->get_name();
  if (name == "run") return run_options.list ? list_levels() : run(run_options);
  if (name == "inspect") return inspect(inspection);
  if (name == "convert") return convert(conversion);
  if (name == "author") return author(authoring);
  if (name == "validate") return validate(validated);
  if (name == "devices") return device_test.id.empty() ? devices(devices_json) : test_device(device_test);
  if (name == "study") return study(study_options);
  if (name == "fit") return fit(fit_options);
  if (name == "plot") return plot_runs(plot_options);
  if (name == "sweep")
    return app.get_subcommand("sweep")->got_subcommand("merge") ? merge_sweep(merging) : sweep(sweep_options);
  const Result<double> unit = parse_unit(edit_unit);
  if (!unit) return fail(kUsage, unit.error());
  edit_options.unit = *unit;
  edit_options.levels = shipped_levels();
  register_all_drivers();
  const Status edited = edit(edit_options);
  return edited ? kDone : fail(kFailed, edited.error());
}

}  // namespace

Status check_run_arguments(const std::vector<std::string>& arguments) {
  CLI::App app;
  RunOptions run;
  const double factor = limit_factor();  // --limits would hold at once
  add_run(app, run);
  std::vector<std::string> words(arguments.rbegin(), arguments.rend());  // CLI11 takes them from behind
  words.emplace_back("run");
  std::optional<Error> wrong;
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    wrong = usage_error(app, error);
  }
  set_limit_factor(factor);
  return wrong ? Status(*wrong) : Status(Done{});
}

int command_line(int argc, const char* const* argv) {
  int status = kDone;
  try {
    status = parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    if (std::ferror(stdout) == 0) return fail(kFailed, explain(error));  // else said below
  }
  const std::optional<Error> lost = close_stdout();
  return lost && status == kDone ? fail(kFailed, *lost) : status;
}

}  // namespace pliant
