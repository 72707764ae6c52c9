// The panel Tissue: kind and material of an object, its pins, and instruments to touch it.
#include <fmt/format.h>

#include <algorithm>

#include "content/author/instruments.h"
#include "content/author/organ.h"
#include "content/author/presets.h"
#include "content/author/staging.h"
#include "content/author/touchable.h"
#include "content/keys/stated.h"
#include "editor/panels/material_fields.h"
#include "editor/panels/panels.h"
#include "editor/panels/soft_panel.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr Side kSides[] = {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack};

}  // namespace

void SoftPanel::draw(Editor& editor) {
  const DocumentNode* const node = editor.active_node();
  if (node && node->node.mesh < 0 && !node->node.probe && !node->node.device && !node->node.light &&
      !node->node.camera) {
    ui::gap();
    ui::title(node->node.name.c_str());
    draw_organ(editor, *node);
  }
  if (!node || node->node.mesh < 0) {
    ui::gap();
    ui::dim("Select a mesh: an organ becomes tissue here, is pinned, and gets an instrument that touches it.");
    return;
  }
  draw_kind(editor, *node);
  draw_material(editor, *node);
  if (node->node.soft_body) {
    draw_lattice(editor, *node);
    draw_pins(editor, *node);
    draw_gravity(editor, *node);
  }
  draw_instruments(editor, *node);
}

void SoftPanel::draw_kind(Editor& editor, const DocumentNode& node) {
  const LevelNode& it = node.node;
  ui::title(it.name.c_str());
  const auto kind = [&](const char* label, bool down, const char* hint, const NodeEdit& edit) {
    if (ui::choice_button(label, down, hint) && !down) author_node(editor, label, node, edit);
    ImGui::SameLine(0, ui::px(2));
  };
  kind("Surface", it.deformable.has_value(), "Deforms locally, vertex by vertex, at 1 kHz (P1): skin, thick organs",
       [](Level& level, std::int32_t at) {
         DeformableParameters surface;
         surface.carries = Carries::kInside;
         return make_touchable_surface(level, at, surface);
       });
  kind("Soft body", it.soft_body.has_value(),
       "Tetrahedra with inertia (P2): bends, hangs, is pushed about; an instrument presses on all of it",
       [](Level& level, std::int32_t at) { return make_soft(level, at, as_modelled({})); });
  kind("Neither", !it.deformable && !it.soft_body && !it.rigid_body, "Only seen", [](Level& level, std::int32_t at) {
    LevelNode& of = level.nodes[static_cast<std::size_t>(at)];
    of.deformable.reset();
    of.soft_body.reset();
    of.rigid_body.reset();
    for (const char* gone : {"deformable", "soft_body", "rigid_body"}) forget_stated(of.stated, gone);
    return Status(Done{});
  });
  ImGui::NewLine();
  draw_organ(editor, node);
}

void SoftPanel::draw_organ(Editor& editor, const DocumentNode& node) {
  if (!ui::button("All parts of this organ",
                  "The outermost of its meshes becomes tissue, and takes along those that lie inside of it: vessels, "
                  "lumps, an inner sheet"))
    return;
  std::string body, parts;
  const bool done = author_node(editor, "All parts of this organ", node, [&](Level& level, std::int32_t at) -> Status {
    const Result<Organ> organ = organ_of(level, at);
    if (!organ) return organ.error();
    body = level.nodes[static_cast<std::size_t>(organ->body)].name;
    const Result<std::string> made = make_soft_organ(level, at);
    if (!made) return made.error();
    parts = *made;
    return Done{};
  });
  if (!done) return;
  if (const DocumentNode* const made = editor.state().find(body)) editor.selected = {made->id};
  editor.say(parts.empty() ? "`" + body + "` is tissue; nothing lies inside of it"
                           : "`" + body + "` is tissue and takes along " + parts);
}

void SoftPanel::draw_material(Editor& editor, const DocumentNode& node) {
  if (!node.node.deformable && !node.node.soft_body) return;
  ui::gap(2);
  if (!ui::section("Material")) return;
  const ui::Scope scope("Material");
  for (const TissuePreset& preset : tissue_presets()) {
    const bool soft = node.node.soft_body.has_value();
    const bool now = soft ? node.node.soft_body->young == preset.young && node.node.soft_body->density == preset.density
                          : node.node.deformable->stiffness == surface_stiffness(preset);
    const std::string label =
        fmt::format("{} {}  ({:.3g} kPa)###{}", now ? "\u2713" : "   ", preset.name, preset.young * 1e-3, preset.word);
    const bool pressed = ImGui::Selectable(label.c_str(), now);
    ui::known_as(preset.word);
    ui::hint(fmt::format("Young's modulus {:.3g} kPa ({:.3g} to {:.3g}); a fingertip feels {:.3g} N/m.\n{}",
                         preset.young * 1e-3, preset.low * 1e-3, preset.high * 1e-3, surface_stiffness(preset),
                         preset.source)
                 .c_str());
    if (!pressed) continue;
    author_node(editor, std::string("Material ") + preset.name, node,
                [&](Level& level, std::int32_t at) { return take_preset(level, at, preset); });
  }
}

void SoftPanel::draw_pins(Editor& editor, const DocumentNode& node) {
  ui::gap(2);
  if (!ui::section("Pinned")) return;
  const ui::Scope scope("Pinned");
  ui::dim("What stands still. Sides add up; paint the channel `pinned` for anything else.");
  ui::label("Share", "Of the object's extent from that side");
  ImGui::SameLine(ui::px(100));
  double percent = 100 * share_;
  if (ui::number("share", percent, 1, 100, "%")) share_ = percent / 100;
  for (std::size_t i = 0; i < std::size(kSides); ++i) {
    const Side side = kSides[i];
    std::string label = word_of(side);
    label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    if (i % 3) ImGui::SameLine(0, ui::px(4));
    if (ui::button(label.c_str(), "Pin this side", true, 88))
      author_node(editor, "Pin the " + std::string(word_of(side)), node,
                  [&](Level& level, std::int32_t at) { return pin(level, at, side, share_); });
  }
  if (ui::button("Nothing pinned", "Removes the box and the paint"))
    author_node(editor, "Unpin", node, [](Level& level, std::int32_t at) {
      unpin(level, at);
      return Status(Done{});
    });
}

void SoftPanel::draw_instruments(Editor& editor, const DocumentNode& node) {
  ui::gap(2);
  if (!ui::section("Touch it with")) return;
  const ui::Scope scope("Instruments");
  const auto add = [&](const char* label, const char* hint, const NodeEdit& edit) {
    if (ui::button(label, hint, true, 140)) author_node(editor, std::string("Add ") + label, node, edit, true);
  };
  add("Probe", "A fingertip: a sphere of a few millimetres; feels surfaces and bodies",
      [](Level& level, std::int32_t at) {
        const Result<std::int32_t> added = add_probe(level, at);
        return added ? Status(Done{}) : Status(added.error());
      });
  std::size_t column = 1;
  for (const Instrument& instrument : instruments()) {
    if (column++ % 2) ImGui::SameLine(0, ui::px(4));
    std::string label = instrument.word;
    std::replace_if(
        label.begin(), label.end(), [](char c) { return c == '-' || c == '_'; }, ' ');
    label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    add(label.c_str(), instrument.about, [&](Level& level, std::int32_t at) {
      const Result<std::int32_t> added = add_instrument(level, instrument.kind, at);
      return added ? Status(Done{}) : Status(added.error());
    });
  }
  ui::gap(2);
  add("Light", "From the upper right, on this object", [](Level& level, std::int32_t at) {
    add_light(level, at);
    return Status(Done{});
  });
  ImGui::SameLine(0, ui::px(4));
  add("Camera", "Sees all of this object", [](Level& level, std::int32_t at) {
    add_camera(level, at);
    return Status(Done{});
  });
}

std::unique_ptr<Panel> make_soft_panel(App& app) {
  return std::make_unique<SoftPanel>(app);
}

}  // namespace pliant
