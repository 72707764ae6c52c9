#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <tuple>

#include "content/author/instruments.h"
#include "content/author/object_frame.h"
#include "content/author/presets.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "content/tets/tet_file.h"
#include "editor/edit.h"
#include "engine/choice/model_choice.h"
#include "lab/console/exit.h"
#include "lab/files/content_folder.h"
#include "player/verbs/options.h"
#include "pliant/drivers.h"

namespace pliant {

void add_inspect(CLI::App& app, int& status) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* verb = app.add_subcommand("inspect", "contents and defects of a file");
  verb->add_option("file", options->file,
                   fmt::format("level, mesh, tetrahedra ({}) or EXR panorama", fmt::join(tet_endings(), ", ")))
      ->required()
      ->check(named());
  verb->add_flag("--json", options->json, "as JSON");
  CLI::Option* fit = verb->add_flag("--fit", options->fit, "candidates of error budgets, measured");
  verb->add_option("--error", options->error,
                   "with --fit: error budget of every surface and soft body; of a bare mesh 0.1 by default")
      ->check(within(kErrorBudget.min, kErrorBudget.max))
      ->needs(fit);
  add_unit(verb, options->unit, "unit of a bare mesh (m; required of one over 5 m across)");
  add_limits(verb);
  verb->footer(
      "Examples:\n  pliant inspect organ.glb\n  pliant inspect scan.stl --unit mm\n  pliant inspect organ.glb --fit "
      "--error 0.3");
  verb->callback([options, &status] { status = inspect(*options); });
}

void add_convert(CLI::App& app, int& status) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb =
      app.add_subcommand("convert", "any mesh format to glTF or GLB; an EXR panorama to a cube map preview (PNG)");
  verb->add_option("in", options->in,
                   "glTF, tetrahedra, OBJ, OFF, PLY, STL, any mesh that Assimp reads, or an EXR panorama")
      ->required()
      ->check(named());
  verb->add_option("out", options->out, "the result: .glb, .gltf, or .png of a panorama")->required()->check(named());
  CLI::Option* draco =
      verb->add_option("--draco", options->draco_bits, "compresses with so many bits per position (8 to 24)")
          ->check(within(SaveOptions::kDracoBits.min, SaveOptions::kDracoBits.max));
  verb->add_flag("--no-draco", options->no_draco, "decompresses, for every viewer")->excludes(draco);
  verb->add_flag("--reorder", options->reorder, "welds, cleans, orders vertices in space, writes mended winding");
  verb->add_flag("--force", options->force, "replace what is there");
  add_limits(verb);
  add_unit(verb, options->unit, "unit of the input (m; required of one over 5 m across)");
  verb->footer(
      "Examples:\n  pliant convert organ.ply organ.glb --unit mm --draco 14\n  pliant convert sky.exr sky.png");
  verb->callback([options, &status] { status = convert(*options); });
}

void add_validate(CLI::App& app, int& status) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* verb = app.add_subcommand("validate", "every finding of a level with its JSON pointer");
  verb->add_option("level", options->level, "level or mesh")->required()->check(named());
  verb->add_flag("--json", options->json, "as JSON, with codes (docs/codes.md)");
  add_unit(verb, options->unit, "unit of a bare mesh (m; required of one over 5 m across)");
  add_limits(verb);
  verb->footer("Example:\n  pliant validate level.gltf");
  verb->callback([options, &status] { status = validate(*options); });
}

void add_author(CLI::App& app, int& status) {
  const auto options = std::make_shared<AuthorOptions>();
  std::vector<std::string> presets, tools, sides{"none"};
  for (const TissuePreset& preset : tissue_presets()) presets.emplace_back(preset.word);
  for (const Instrument& tool : instruments()) tools.emplace_back(tool.word);
  tools.emplace_back("none");
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack})
    sides.emplace_back(word_of(side));
  CLI::App* verb = app.add_subcommand("author", "a first level from an organ's mesh: soft, pinned, with an instrument");
  verb->add_option("in", options->in, "mesh or level")->required()->check(named());
  verb->add_option("-o,--out", options->out, "the level: .glb or .gltf")->required()->check(named())->type_name("FILE");
  CLI::Option* hand =
      verb->add_flag("--hand", options->hand, "the mesh with a skin becomes a hand: tissue on bones, closed by a grip");
  for (const auto& [name, nodes, what] :
       {std::tuple("--soft", &options->soft, "becomes a soft body (the largest mesh); may be repeated"),
        std::tuple("--surface", &options->surface, "becomes a deformable surface instead; may be repeated")})
    verb->add_option(name, *nodes, what)
        ->take_all()
        ->allow_extra_args(false)
        ->check(named())
        ->type_name("NODE")
        ->excludes(hand);
  verb->add_option("--preset", options->preset, "material: " + joined(presets) + " (liver; of a hand skin)")
      ->check(one_of(presets));
  verb->add_option("--pin", options->pin,
                   "pins 15 % of a soft body on that side; top and bottom along gravity, front +Z, right +X: " +
                       joined(sides) + " (bottom)")
      ->check(one_of(sides))
      ->excludes(hand);
  verb->add_option(
          "--tool", options->tool,
          joined(tools) + " over the first object, with a script; meets soft bodies only (rod over a soft body)")
      ->check(one_of(tools))
      ->excludes(hand);
  verb->add_flag("--probe", options->probe, "adds a probe with a script (default without a tool)")->excludes(hand);
  verb->add_flag("--force", options->force, "replace what is there");
  add_limits(verb);
  add_unit(verb, options->unit, "unit of a bare mesh (m; required of one over 5 m across)");
  verb->footer(
      "Examples:\n"
      "  pliant author organ.glb -o level.glb\n"
      "  pliant author organ.glb --soft capsule --preset liver --pin bottom --tool sphere_tip -o level.glb\n"
      "  pliant author scan.stl --unit mm --surface scan --preset skin -o level.glb\n"
      "  pliant author hand.glb --hand -o level.glb");
  verb->callback([options, &status] { status = author(*options); });
}

void add_edit(CLI::App& app, int& status) {
  const auto options = std::make_shared<EditOptions>();
  const auto unit = std::make_shared<std::string>("m");
  CLI::App* verb = app.add_subcommand("edit", "the editor: from a mesh to a level that can be touched");
  verb->add_option("file", options->file, "a level, by path or by name, or any mesh; none: the start page");
  verb->add_option("--unit", *unit, "of a bare mesh: m, cm, mm, in, or metres for one unit")->capture_default_str();
  verb->add_option_function<std::string>(
      "--size",
      [options](const std::string& text) {
        RunOptions size;
        if (const std::string wrong = parse_size(text, size); !wrong.empty()) throw CLI::ValidationError(wrong);
        options->width = size.width;
        options->height = size.height;
      },
      "of the window, WxH [1600x900]");
  verb->add_option("--input", options->input, "script of mouse and keys (docs/editor.md)");
  verb->add_option("--out", options->out, "folder of the script's screenshots")->capture_default_str();
  verb->add_option("--config", options->config, "folder of settings; else ~/.config/pliant");
  verb->footer("Examples:\n  pliant edit\n  pliant edit organ.glb --unit mm");
  verb->callback([options, unit, &status] {
    const Result<double> metres = parse_unit(*unit);
    if (!metres) {
      status = fail(kUsage, metres.error());
      return;
    }
    if (!options->file.empty()) {
      const auto file = find_level(options->file);
      if (!file) {
        status = fail(kFailed, file.error());
        return;
      }
      options->file = file->string();
    }
    options->unit = *metres;
    options->levels = shipped_levels();
    register_all_drivers();
    const Status edited = edit(*options);
    status = edited ? kDone : fail(kFailed, edited.error());
  });
}

}  // namespace pliant
