// Files dropped on the window: a level or mesh is added or opened, a panorama becomes the environment, a picture a
// texture, a script moves a probe, tetrahedra fill a soft body, a folder is shown; others are rejected with a sentence.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <utility>

#include "content/files/exr.h"
#include "content/files/image.h"
#include "content/level/script.h"
#include "content/openable.h"
#include "content/tets/tet_file.h"
#include "editor/app/app.h"
#include "editor/app/files.h"
#include "editor/core/path_editing.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

enum class Dropped : std::uint8_t {
  kOpens,
  kTetrahedra,
  kPanorama,
  kScript,
  kTexture,
  kPicture,
  kFolder,
  kNothing,
  kGone
};

Dropped kind_of(const fs::path& file) {
  std::error_code failed;
  if (fs::is_directory(file, failed)) return Dropped::kFolder;
  if (!fs::is_regular_file(file, failed)) return Dropped::kGone;
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto any_of = [&](std::initializer_list<const char*> all) {
    return std::any_of(all.begin(), all.end(), [&](const char* each) { return ending == each; });
  };
  if (is_tet_file(file)) return Dropped::kTetrahedra;
  if (has_ending(file, openable_endings())) return Dropped::kOpens;
  if (ending == ".exr") return Dropped::kPanorama;
  if (ending == ".csv") return Dropped::kScript;
  if (any_of({".png", ".jpg", ".jpeg"})) return Dropped::kTexture;
  if (any_of({".webp", ".bmp", ".tga", ".tif", ".tiff", ".gif", ".hdr", ".ktx2"})) return Dropped::kPicture;
  return Dropped::kNothing;
}

std::string name_of(const fs::path& file) {
  return printable(file.filename().string());
}

// As a URI relative to the folder, for use in a level.
std::string uri_of(const fs::path& relative) {
  std::string uri;
  for (const char c : relative.generic_string()) uri += c == '%' ? std::string("%25") : std::string(1, c);
  return uri;
}

// Copies a file beside the level if needed, because a level can only refer to its own folder. `then` receives its name.
void beside_the_level(App& app, const fs::path& file, const std::string& use,
                      const std::function<void(const std::string&)>& then) {
  std::error_code failed;
  const fs::path named = app.editor.document.folder();
  const fs::path folder = fs::absolute(named.empty() ? fs::path(".") : named, failed).lexically_normal();
  const fs::path from = fs::absolute(file, failed).lexically_normal();
  const fs::path relative = from.lexically_relative(folder);
  if (!relative.empty() && *relative.begin() != "..") return then(uri_of(relative));
  const fs::path to = folder / from.filename();
  const bool there = fs::exists(to, failed);
  app.ask({fmt::format("Use {} as {}?", name_of(file), use),
           {"It lies outside of the level's folder, and a level names only files beside it.",
            there ? fmt::format("There is a {} beside the level already.", name_of(file))
                  : fmt::format("A copy is put into {}.", printable(folder.string()))},
           {{there ? "Use the one there" : "Copy and use it", "",
             [&app, from, to, there, then] {
               std::error_code wrong;
               if (!there && !fs::copy_file(from, to, wrong))
                 return app.editor.say(fmt::format("{} cannot be copied ({})", printable(to.string()), wrong.message()),
                                       Severity::kError);
               then(uri_of(to.filename()));
             }},
            {"Cancel", "", {}}}});
}

void surround(App& app, const fs::path& file) {
  app.editor.jobs.start("panorama", "Reading " + name_of(file), [&app, file](const Jobs::Stop&) {
    auto read = std::make_shared<Status>(Done{});
    if (auto panorama = load_named_panorama(file.parent_path(), uri_of(file.filename())); !panorama)
      *read = panorama.error();
    return [&app, file, read](Editor& editor) {
      if (!*read) return editor.say(read->error().message(), Severity::kError);
      beside_the_level(app, file, "the level's panorama", [&app](const std::string& name) {
        State next = app.editor.state();
        if (!next.environment) next.environment.emplace();
        next.environment->panorama = name;
        if (!app.editor.apply("Panorama", std::move(next))) return;
        app.editor.view.shading = Shading::kRendered;
        app.editor.say(printable(name) + " surrounds the level; Solid shows it as it is edited");
      });
    };
  });
}

void move_by(App& app, const fs::path& file, NodeId device) {
  if (const auto path = load_script(file); !path) return app.editor.say(path.error().message(), Severity::kError);
  const std::string node = app.editor.state().find(device)->node.name;
  beside_the_level(app, file, "the script of " + printable(node), [&app, device, node](const std::string& name) {
    const std::vector<NodeId> ids{device};
    if (!app.editor.state().find(device)) return;
    Result<State> next = with_value(app.editor.state(), ids, "haptic_device", "file", name);
    if (next) next = with_value(*next, ids, "haptic_device", "driver", "script");
    if (app.editor.apply("Script", std::move(next)))
      app.editor.say(fmt::format("{} follows {}; Play shows it", printable(node), printable(name)));
  });
}

void script(App& app, const fs::path& file) {
  const State& state = app.editor.state();
  if (const NodeId selected = path_node(app.editor); selected != kNoNode) return move_by(app, file, selected);
  std::vector<NodeId> devices;
  for (const auto& each : state.nodes)
    if (each->node.device) devices.push_back(each->id);
  if (devices.empty())
    return app.editor.say(
        fmt::format("{} may be a script, and nothing here can follow it; add a probe with a device first",
                    name_of(file)),
        Severity::kWarning);
  if (devices.size() == 1) return move_by(app, file, devices.front());
  constexpr std::size_t kMostAnswers = 4;
  Question which{fmt::format("What follows {}?", name_of(file)), {}, {}};
  if (devices.size() > kMostAnswers)
    which.lines.push_back(fmt::format("Or cancel, select one of the {} that can, and drop it again.", devices.size()));
  for (std::size_t i = 0; i < std::min(devices.size(), kMostAnswers); ++i)
    which.answers.push_back(
        {state.find(devices[i])->node.name, "", [&app, file, id = devices[i]] { move_by(app, file, id); }});
  which.answers.push_back({"Cancel", "", {}});
  app.ask(std::move(which));
}

void tetrahedra(App& app, const fs::path& file) {
  const DocumentNode* const node = app.editor.active_node();
  if (!node || !node->node.soft_body) return app.open(file);
  app.ask({fmt::format("{} has tetrahedra", name_of(file)),
           {"They can be the inside of what is selected, or a level of their own."},
           {{"Fill " + printable(node->node.name), "The soft body that is selected takes them",
             [&app, file, id = node->id] {
               beside_the_level(app, file, "its tetrahedra", [&app, id](const std::string& name) {
                 app.editor.apply("Tetrahedra",
                                  with_value(app.editor.state(), std::vector<NodeId>{id}, "soft_body", "mesh", name));
               });
             }},
            {"Open them", "", [&app, file] { app.open(file); }},
            {"Cancel", "", {}}}});
}

// The object that wears a dropped picture: the selected one, or the only one.
const DocumentNode* wearer(const Editor& editor) {
  if (const DocumentNode* const active = editor.active_node(); active && active->node.mesh >= 0) return active;
  const DocumentNode* only = nullptr;
  for (const auto& each : editor.state().nodes)
    if (each->node.mesh >= 0 && std::exchange(only, each.get())) return nullptr;
  return only;
}

void put_on(App& app, NodeId id, std::shared_ptr<const Image> image, std::int32_t Material::*place) {
  const DocumentNode* const node = app.editor.state().find(id);
  if (!node || node->node.mesh < 0) return;
  const Primitive& part = app.editor.state().meshes[static_cast<std::size_t>(node->node.mesh)]->primitives[0];
  std::int32_t number = -1;
  const State next = with_image(app.editor.state(), *image, number);
  Material material;
  material.name = node->node.name;
  if (part.material >= 0) material = next.materials()[static_cast<std::size_t>(part.material)];
  material.*place = number;
  if (place == &Material::base_color_texture) material.base_color = vec4(1.0f, 1.0f, 1.0f, material.base_color.a);
  constexpr float kUsualRelief = 1e-3f;  // [m]
  if (place == &Material::height_texture && material.height_scale == 0.0f) material.height_scale = kUsualRelief;
  if (!app.editor.apply("Texture", with_material(next, id, 0, material))) return;
  app.editor.view.shading = Shading::kRendered;
  app.editor.say(
      fmt::format("{} wears {}; Solid shows it as it is edited", printable(node->node.name), printable(image->name)));
}

void texture(App& app, const fs::path& file) {
  const DocumentNode* const node = wearer(app.editor);
  if (!node)
    return app.editor.say(
        fmt::format("{} is a picture: select the object that wears it, then drop it again", name_of(file)),
        Severity::kWarning);
  for (const Primitive& part : app.editor.state().meshes[static_cast<std::size_t>(node->node.mesh)]->primitives)
    if (part.uv.size() != part.position.size())
      return app.editor.say(fmt::format("{} has no texture coordinates for {}: unwrap its mesh in a modelling program",
                                        printable(node->node.name), name_of(file)),
                            Severity::kWarning);
  Result<Image> image = load_image(file);
  if (!image) return app.editor.say(image.error().message(), Severity::kError);
  image->name = file.stem().string();
  const auto kept = std::make_shared<const Image>(*std::move(image));
  const auto as = [&](const char* label, const char* hint, std::int32_t Material::*place) {
    return Answer{label, hint, [&app, id = node->id, kept, place] { put_on(app, id, kept, place); }};
  };
  app.ask({fmt::format("What is {} on {}?", name_of(file), printable(node->node.name)),
           {},
           {as("Colour", "", &Material::base_color_texture),
            as("Bumps", "A tangent-space normal map: seen", &Material::normal_texture),
            as("Relief", "Heights, white above black: seen, and felt on a surface", &Material::height_texture),
            {"Cancel", "", {}}}});
}

void add_or_open(App& app, const fs::path& file) {
  app.ask({fmt::format("Add {} to this level, or open it?", name_of(file)),
           {},
           {{"Add", "Beside what is there; undo takes it back", [&app, file] { app.files().add(file); }},
            {"Open", "Instead of this level", [&app, file] { app.open(file); }},
            {"Cancel", "", {}}}});
}

// Several files that could be opened: a window has one level.
void choose_one(App& app, const std::vector<fs::path>& files, bool empty) {
  constexpr std::size_t kMostAnswers = 4;
  Question which{fmt::format("{} files were dropped; which one is opened?", files.size()), {}, {}};
  if (!empty)
    which.answers.push_back({"Add all", "Beside what is there; undo takes them back", [&app, files] {
                               for (const fs::path& each : files) app.files().add(each);
                             }});
  for (std::size_t i = 0; i < std::min(files.size(), kMostAnswers); ++i)
    which.answers.push_back(
        {name_of(files[i]), printable(files[i].string()), [&app, file = files[i]] { app.open(file); }});
  if (files.size() > kMostAnswers)
    which.lines.push_back(fmt::format("The first {} of them; open the others with Ctrl+O.", kMostAnswers));
  which.answers.push_back({"Cancel", "", {}});
  app.ask(std::move(which));
}

}  // namespace

void App::drop(const std::vector<std::string>& names) {
  std::vector<fs::path> opened, rest;
  for (const std::string& name : names) (kind_of(name) == Dropped::kOpens ? opened : rest).emplace_back(name);
  const bool empty = editor.state().nodes.empty() && editor.document.file().empty();
  // In an empty window, tetrahedra alone are opened as a level.
  if (opened.empty() && empty)
    for (auto it = rest.begin(); it != rest.end();) {
      const bool takes = kind_of(*it) == Dropped::kTetrahedra;
      if (takes) opened.push_back(*it);
      it = takes ? rest.erase(it) : it + 1;
    }
  const auto warn = [&](const std::string& text) { editor.say(text, Severity::kWarning); };
  for (const fs::path& file : rest) {
    const Dropped kind = kind_of(file);
    const bool part = kind == Dropped::kPanorama || kind == Dropped::kScript || kind == Dropped::kTetrahedra ||
                      kind == Dropped::kTexture;
    if (part && !opened.empty())
      warn(fmt::format("{} is a part of a level: drop it again when {} is open", name_of(file), name_of(opened[0])));
    else if (part && empty)
      warn(fmt::format("{} is a part of a level: open an organ or a level first, then drop it again", name_of(file)));
    else if (kind == Dropped::kPanorama)
      surround(*this, file);
    else if (kind == Dropped::kScript)
      script(*this, file);
    else if (kind == Dropped::kTetrahedra)
      tetrahedra(*this, file);
    else if (kind == Dropped::kTexture)
      texture(*this, file);
    else if (kind == Dropped::kPicture)
      warn(fmt::format("{} is a picture: textures are PNG or JPEG, and what surrounds a level is an OpenEXR panorama",
                       name_of(file)));
    else if (kind == Dropped::kFolder)
      files_->ask_open(file);
    else if (kind == Dropped::kGone)
      warn(name_of(file) + " is not there, or is no file that can be read");
    else
      warn(
          fmt::format("{} is nothing that the editor reads: drop a level or a mesh (glTF, OBJ, STL, PLY, OFF, "
                      "tetrahedra), a picture (.png, .jpg), a panorama (.exr) or a script (.csv)",
                      name_of(file)));
  }
  if (opened.size() == 1) empty ? open(opened.front()) : add_or_open(*this, opened.front());
  if (opened.size() > 1) choose_one(*this, opened, empty);
}

}  // namespace pliant
