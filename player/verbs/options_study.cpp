#include <memory>

#include "content/author/object_frame.h"
#include "lab/fit/fit.h"
#include "lab/fit/press_model.h"
#include "lab/plot/plot_runs.h"
#include "lab/study/study.h"
#include "lab/sweep/sweep.h"
#include "player/verbs/command_line.h"
#include "player/verbs/options.h"

namespace pliant {

void add_study(CLI::App& app, int& status) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = app.add_subcommand("study", "speed against error: figures, data and a plot");
  CLI::Option* name = verb->add_option("name", options->name, "of a study, or all");
  CLI::Option* list = verb->add_flag("--list", options->list, "names of the studies");
  verb->add_option("--out", options->out, "folder of the results (out/study); FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", options->force, "replace the results of an earlier study in that folder");
  verb->add_flag("--quick", options->quick, "less than a minute");
  name->excludes(list);
  verb->footer("Example:\n  pliant study all --quick");
  verb->callback([options, &status] { status = study(*options); });
}

void add_sweep(CLI::App& app, int& status) {
  const auto options = std::make_shared<SweepOptions>();
  const auto merging = std::make_shared<MergeOptions>();
  options->check = check_run_arguments;
  CLI::App* verb = app.add_subcommand("sweep", "one level over many settings, on one machine or many");
  verb->add_option("plan", options->plan, "level, options and axes (docs/sweep.md)")
      ->check(named())
      ->type_name("PLAN.json");
  verb->add_option("--out", options->out, "folder of the lines (out/<plan's name>); a sweep there goes on")
      ->check(named());
  verb->add_option("--shard", options->shard,
                   "only the runs I, I + N, I + 2N, ... of the plan; default: by Slurm's array or MPI's rank, else all")
      ->check(named())
      ->type_name("I/N");
  verb->add_flag("--retry-failed", options->retry_failed, "failed runs are done again");
  verb->add_flag("--list", options->list,
                 "every run of the shard: id, `to do`, `done` or `failed`, values; writes nothing");
  verb->add_flag("--dry-run", options->dry_run, "the commands that would run, for a shell; writes nothing");
  verb->add_option("--jobs", options->jobs,
                   "runs at a time (1); above 1 each has one thread, unless the plan gives `threads`")
      ->check(within(1, 1024));
  verb->footer(
      "Examples:\n"
      "  pliant sweep plan.json --out out/sweep --jobs 4\n"
      "  pliant sweep merge out/sweep --out out/merged");
  CLI::App* merge = verb->add_subcommand("merge", "tables, a report and plots of finished runs");
  merge->add_option("folders", merging->folders, "--out of one sweep, or of its shards")->required()->check(named());
  merge->add_option("--out", merging->out, "folder of the tables; FOLDER-2 and on where one has results")
      ->required()
      ->check(named());
  merge->add_flag("--force", merging->force, "replace what an earlier merge wrote there");
  merge->footer("Example:\n  pliant sweep merge out/sweep --out out/merged");
  verb->callback([verb, options, merging, &status] {
    status = verb->got_subcommand("merge") ? merge_sweep(*merging) : sweep(*options);
  });
}

void add_fit(CLI::App& app, int& status) {
  const auto options = std::make_shared<FitOptions>();
  std::vector<std::string> laws{"auto"}, sides;
  for (const std::string& law : press_laws()) laws.push_back(law);
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack})
    sides.emplace_back(word_of(side));
  const char *measured = "Of measured presses", *elements = "Of finite elements", *sweep = "Of a sweep";
  CLI::App* verb = app.add_subcommand("fit", "a surface's keys from measured presses, finite elements or a sweep");
  verb->add_option("in", options->in,
                   "a level, or measured presses (.csv with columns such as time_s,depth_mm,force_N)")
      ->check(named());
  verb->add_option("--object", options->object, "node of the level (its only one with a mesh)")->check(named());
  verb->add_option("-o,--out", options->out, "the level that is written, .glb or .gltf")
      ->check(named())
      ->type_name("FILE");
  verb->add_option("--report", options->report,
                   "folder of figures and plots (out/fit); FOLDER-2 and on where one has results")
      ->check(named());
  verb->add_flag("--force", options->force, "replace what is there");
  verb->add_option(
          "--radius", options->radius,
          "of a spherical indenter (measured: a point) or of the punch [m] (the level's contact radius, else a fifth "
          "of the reach, or the probe's)")
      ->check(within(0, 1));
  verb->add_option("--level", options->level, "level that gets the keys")->check(named())->group(measured);
  verb->add_option("--law", options->law, joined(laws) + " (auto)")->check(one_of(laws))->group(measured);
  verb->add_option("--probe", options->probe, "probe of a run's forces.csv, or of a sweep's runs")->check(named());
  verb->add_option("--hold-out", options->hold_out, "share of the rows that the fit does not use, up to 0.5 (0.25)")
      ->check(within(0, 0.5))
      ->group(measured);
  verb->add_option("--confidence", options->confidence, "of the intervals, 0.5 to 0.9999 (0.95)")
      ->check(within(0.5, 0.9999))
      ->group(measured);
  verb->add_flag("--damping", options->damping, "fits contact_damping, too")->group(measured);
  verb->add_flag("--contact", options->contact, "fits the depth of first contact, too")->group(measured);
  verb->add_option("--young", options->young, "Young's modulus [Pa] (the level's)")
      ->check(within(1e-3, 1e12))
      ->group(elements);
  verb->add_option("--poisson", options->poisson, "Poisson's ratio (the level's; measured: 0.45)")
      ->check(within(0, 0.499));
  verb->add_option("--thickness", options->thickness,
                   "of a wall [m] (the level's); measured: of the layer, for the law hertz (deep)")
      ->check(within(0, 1e3));
  verb->add_option("--cell", options->cell, "of the lattice under the indenter [m] (half its radius)")
      ->check(within(0, 1e3))
      ->group(elements);
  verb->add_option("--pin", options->pin, "side that is pinned: " + joined(sides) + " (the level's, else bottom)")
      ->check(one_of(sides))
      ->group(elements);
  verb->add_option("--reach", options->reach,
                   "reach of the dents [m] (the best: 1.5 to 3.5 punch radii, up to 10 for wider dents)")
      ->check(within(0, 1e3))
      ->group(elements);
  verb->add_flag("--linear", options->linear, "small strains instead of co-rotational ones")->group(elements);
  verb->add_option("--points", options->points, "places that law and shape are fitted at (24)")
      ->check(within(4, 500))
      ->group(elements);
  verb->add_option("--held", options->held, "places for the errors (12)")->check(within(1, 500))->group(elements);
  verb->add_option("--sweep", options->sweep, "folder of a sweep: its runs nearest to --target")
      ->check(named())
      ->group(sweep);
  verb->add_option("--target", options->target, "measured presses that a sweep's runs are compared with")
      ->check(named())
      ->group(sweep);
  add_unit(verb, options->unit, "unit of a bare mesh (m; required of one over 5 m across)");
  add_limits(verb);
  verb->parse_complete_callback([=] {
    for (const auto& [group, said] : {std::pair{measured, &options->of_measured}, {elements, &options->of_elements}})
      for (const CLI::Option* option : verb->get_options())
        if (option->get_group() == group && option->count() > 0) said->push_back(option->get_name());
  });
  verb->footer(
      "Examples:\n"
      "  pliant fit hand --object organ -o organ_surface.glb\n"
      "  pliant fit indenter.csv --law hertz --radius 0.003 --level level.glb --object organ -o fitted.glb\n"
      "  pliant fit --sweep out/sweep --target indenter.csv");
  verb->callback([options, &status] { status = fit(*options); });
}

void add_plot(CLI::App& app, int& status) {
  const auto options = std::make_shared<PlotOptions>();
  CLI::App* verb = app.add_subcommand("plot", "runs over each other: force over depth and time, spectra, a table");
  verb->add_option("runs", options->runs, "folders of runs, or their forces.csv")->required()->check(named());
  verb->add_option("--probe", options->probes, "only these probes and tools; may be repeated")
      ->take_all()
      ->allow_extra_args(false)
      ->check(named());
  verb->add_option("--out", options->out, "folder (out/plot); FOLDER-2 and on where one has results")->check(named());
  verb->add_flag("--force", options->force, "replace what an earlier plot wrote there");
  verb->footer("Example:\n  pliant plot out/soft out/stiff --out out/compared");
  verb->callback([options, &status] { status = plot_runs(*options); });
}

}  // namespace pliant
