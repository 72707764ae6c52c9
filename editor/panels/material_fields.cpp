#include "editor/panels/material_fields.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/author/presets.h"
#include "editor/app/add.h"
#include "editor/panels/property_row.h"
#include "editor/viewport/frames.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

struct Factor {
  const char* label;
  const char* hint;
  float Material::*of;
  double most;
  const char* unit;  // "": a share
};
constexpr Factor kFactors[] = {
    {"Metallic", "0: tissue, plastic; 1: bare metal", &Material::metallic, 1, ""},
    {"Roughness", "0: mirrors; 1: chalk", &Material::roughness, 1, ""},
    {"Clear coat", "A clear film on top: wet tissue, lacquer (KHR_materials_clearcoat)", &Material::clearcoat, 1, ""},
    {"Coat roughness", "Of that film", &Material::clearcoat_roughness, 1, ""},
    {"Specular", "Share of the mirrored light, of all but metals (KHR_materials_specular)", &Material::specular, 1, ""},
    {"Scatter", "Share of the light that scatters below the surface (KHR_materials_diffuse_transmission)",
     &Material::diffuse_transmission, 1, ""},
    {"Transmission", "Share of the light that passes: glass (KHR_materials_transmission)", &Material::transmission, 1,
     ""},
    {"Thickness", "Of what light passes; 0: a thin shell (KHR_materials_volume)", &Material::thickness, 10, "m"},
    {"Reach of light", "Distance at which the inner colour tints; 0: none (KHR_materials_volume)",
     &Material::attenuation_distance, 10, "m"},
    {"Bump strength", "Factor of the normal map", &Material::normal_scale, 10, ""},
    {"Relief height", "White above black of the relief", &Material::height_scale, 1, "m"}};

struct Colour {
  const char* label;
  const char* hint;
  vec3 Material::*of;
};
constexpr Colour kColours[] = {
    {"Scatter colour", "Of the light that scatters below the surface", &Material::diffuse_transmission_color},
    {"Inner colour", "Of light that has passed the reach", &Material::attenuation_color},
    {"Glow", "Light that it gives off itself", &Material::emissive}};

struct TexturePlace {
  const char* label;
  std::int32_t Material::*of;
};
constexpr TexturePlace kPlaces[] = {
    {"Colour map", &Material::base_color_texture}, {"Metal, rough map", &Material::metallic_roughness_texture},
    {"Bump map", &Material::normal_texture},       {"Occlusion map", &Material::occlusion_texture},
    {"Glow map", &Material::emissive_texture},     {"Relief map", &Material::height_texture}};

std::string picture_name(const State& state, std::int32_t number) {
  if (number < 0 || static_cast<std::size_t>(number) >= state.rest->images.size()) return "none";
  const std::string& name = state.rest->images[static_cast<std::size_t>(number)].name;
  return fmt::format("{}: {}", number, name.empty() ? "picture" : printable(name));
}

bool found(const std::string& search, const char* label) {
  return matches(search, std::string("material ") + label);
}

bool any_found(const std::string& search) {
  const auto finds = [&](const auto& each) { return found(search, each.label); };
  return found(search, "Colour") || std::any_of(std::begin(kFactors), std::end(kFactors), finds) ||
         std::any_of(std::begin(kColours), std::end(kColours), finds) ||
         std::any_of(std::begin(kPlaces), std::end(kPlaces), finds);
}

bool draw_factors(Material& material, const std::string& search) {
  const Material standard;
  bool changed = false;
  vec3 base(material.base_color);
  if (found(search, "Colour")) {
    property_row("Colour", "Linear RGB; times the colour map", false);
    if (ui::color_field("colour", &base.x)) {
      material.base_color = vec4(base, material.base_color.a);
      changed = true;
    }
  }
  for (const Factor& each : kFactors) {
    if (!found(search, each.label)) continue;
    double value = static_cast<double>(material.*each.of);
    if (property_row(each.label, each.hint, material.*each.of != standard.*each.of)) {
      material.*each.of = standard.*each.of;
      changed = true;
      continue;
    }
    if (!ui::number(each.label, value, 0, each.most, each.unit)) continue;
    material.*each.of = static_cast<float>(value);
    changed = true;
  }
  for (const Colour& each : kColours) {
    if (!found(search, each.label)) continue;
    property_row(each.label, each.hint, false);
    changed |= ui::color_field(each.label, &(material.*each.of).x);
  }
  return changed;
}

bool draw_textures(const State& state, Material& material, const std::string& search) {
  const std::size_t count = state.rest->images.size();
  if (count == 0) {
    if (search.empty()) ui::dim("Drop a PNG or JPEG on the window to put it on this object.");
    return false;
  }
  std::vector<std::string> all{"none"};
  for (std::size_t i = 0; i < count; ++i) all.push_back(picture_name(state, static_cast<std::int32_t>(i)));
  bool changed = false;
  for (const TexturePlace& each : kPlaces) {
    if (!found(search, each.label)) continue;
    std::string now = picture_name(state, material.*each.of);
    property_row(each.label, "A picture of the level; drop a PNG or JPEG to add one", false);
    if (!ui::combo(each.label, now, all)) continue;
    material.*each.of = static_cast<std::int32_t>(std::find(all.begin(), all.end(), now) - all.begin()) - 1;
    changed = true;
  }
  return changed;
}

void draw_presets(Editor& editor, const DocumentNode& node, std::size_t part, const std::string& name) {
  std::vector<std::string> words;
  std::string now = "none";
  for (const TissuePreset& preset : tissue_presets()) {
    words.emplace_back(preset.name);
    if (name == preset.name) now = preset.name;
  }
  const bool soft = node.node.soft_body || node.node.deformable;
  property_row("Tissue",
               soft ? "Look, stiffness, damping and friction of a tissue"
                    : "Look of a tissue; in the tab Tissue the object becomes one that is felt",
               false);
  if (!ui::combo("tissue", now, words)) return;
  const auto preset = std::find_if(tissue_presets().begin(), tissue_presets().end(),
                                   [&](const TissuePreset& each) { return now == each.name; });
  if (preset == tissue_presets().end()) return;
  Result<State> next =
      soft ? by_level(editor.state(), editor.document.next_id(),
                      [&](Level& level) { return take_preset(level, place_in(level, node.node.name), *preset); })
           : Result<State>(editor.state());
  if (next) {
    const NodeId id = node.id;
    const vec3 extent = bounds_of(editor.state(), std::span(&id, 1)).size();
    next = with_material(*next, id, part, look_of(*preset, std::min({extent.x, extent.y, extent.z})));
  }
  editor.apply(std::string("Material ") + preset->name, std::move(next));
}

}  // namespace

Status take_preset(Level& level, std::int32_t node, const TissuePreset& preset) {
  if (node < 0) return Error{"material", "the object is not there any more"};
  LevelNode& of = level.nodes[static_cast<std::size_t>(node)];
  if (of.soft_body) {
    const SoftBodyParameters from = soft_body_of(preset);
    SoftBodyParameters& to = *of.soft_body;
    to.young = from.young;
    to.poisson = from.poisson;
    to.density = from.density;
    to.rayleigh = from.rayleigh;
    to.friction_static = from.friction_static;
    to.friction_sliding = from.friction_sliding;
  } else if (of.deformable) {
    const DeformableParameters from = surface_of(preset);
    DeformableParameters& to = *of.deformable;
    to.young = 0.0;
    to.stiffness = surface_stiffness(preset);
    to.settling_time = from.settling_time;
    to.friction_static = from.friction_static;
    to.friction_sliding = from.friction_sliding;
  }
  add_look(level, node, preset);
  return Done{};
}

void draw_material_fields(Editor& editor, const DocumentNode& node, const std::string& search, std::size_t& part) {
  if (node.node.mesh < 0 || (!search.empty() && !any_found(search))) return;
  ui::gap(2);
  if (!ui::section("Material")) return;
  const ui::Scope scope("material");
  const State& state = editor.state();
  const std::vector<Primitive>& parts = state.meshes[static_cast<std::size_t>(node.node.mesh)]->primitives;
  if (parts.empty()) return;
  if (part >= parts.size()) part = 0;
  const auto material_at = [&](std::size_t p) {
    const std::int32_t number = parts[p].material;
    if (number >= 0 && static_cast<std::size_t>(number) < state.materials().size())
      return state.materials()[static_cast<std::size_t>(number)];
    Material none;
    none.name = node.node.name;
    return none;
  };
  if (parts.size() > 1) {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < parts.size(); ++p)
      names.push_back(fmt::format("{}: {}", p + 1, printable(material_at(p).name)));
    std::string now = names[part];
    property_row("Part", "Of the object's mesh", false);
    if (ui::combo("part", now, names))
      part = static_cast<std::size_t>(std::find(names.begin(), names.end(), now) - names.begin());
  }
  Material material = material_at(part);
  if (const std::size_t others = sharing_material(state, node.id, part); others > 0) {
    ui::dim(fmt::format("{} other object{} this material.", others, others > 1 ? "s share" : " shares").c_str());
    if (ui::button("Make its own", "A copy of it, for this object alone"))
      return void(editor.apply("Own material", with_own_material(state, node.id, part)));
  }
  if (search.empty()) draw_presets(editor, node, part, material.name);
  const bool factors = draw_factors(material, search), textures = draw_textures(state, material, search);
  if (factors || textures)
    editor.apply("Material", with_material(state, node.id, part, material),
                 fmt::format("material {} {}", node.id, part));
}

}  // namespace pliant
