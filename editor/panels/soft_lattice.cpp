// The panel Tissue: the tetrahedra that fill a mesh, previewed while it is edited.
#include <fmt/format.h>

#include <algorithm>

#include "content/author/staging.h"
#include "content/keys/extensions.h"
#include "content/tets/tet_findings.h"
#include "editor/panels/soft_panel.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kPause = 0.3;                   // [s] after the last change, before a preview starts
constexpr std::size_t kMostEdgesShown = 60'000;  // beyond it only some of them

}  // namespace

void SoftPanel::draw_lattice(Editor& editor, const DocumentNode& node) {
  ui::gap(2);
  if (!ui::section("Tetrahedra")) return;
  const ui::Scope scope("Tetrahedra");
  const NodeId ids[] = {node.id};
  const SoftBody& body = *node.node.soft_body;
  double cell = body.cell * 1e3;
  ui::label("Cell", "Edge of a lattice cell; 0: sized so that there are about 2,000 tetrahedra");
  ImGui::SameLine(ui::px(100));
  if (ui::number("cell", cell, 0.0, 1e5, "mm"))
    editor.apply("Cell", with_value(editor.state(), ids, "soft_body", "cell", cell * 1e-3), "cell");
  const bool sized = preview_ && preview_->cell > 0.0;
  const auto by = [&](const char* label, double factor, const char* hint) {
    if (ui::button(label, sized ? hint : "Once it is filled", sized))
      editor.apply("Cell", with_value(editor.state(), ids, "soft_body", "cell", preview_->cell * factor));
    ImGui::SameLine();
  };
  by("Finer", 0.8, "About twice as many tetrahedra");
  by("Coarser", 1.25, "About half as many tetrahedra");
  if (ui::button("Automatic", "About 2,000 tetrahedra"))
    editor.apply("Cell", with_value(editor.state(), ids, "soft_body", "cell", 0.0));
  ask(editor, node);
  if (trouble_) {
    ImGui::TextColored(ui::palette().bad, "Cannot be tissue as it is");
    ui::dim(trouble_->message().c_str());
    offer(editor, node, trouble_->code);
  }
  draw_figures(editor, node);
  bool carries = body.carries == Carries::kInside;
  if (ui::checkbox("Takes its parts along", carries, "Meshes inside of it that are only drawn go with its tissue"))
    editor.apply("Takes its parts along",
                 with_value(editor.state(), ids, "soft_body", "carries", carries ? "inside" : "nothing"));
  ui::checkbox("Show tetrahedra", editor.view.tetrahedra, "Their edges, in the viewport");
  if (editor.view.tetrahedra && preview_)
    show_edges(editor, node, preview_->nodes, shown_as(ui::palette().depth, 0.35f));
}

// The rows are always shown, even without values, so that the widgets below do not move.
void SoftPanel::draw_figures(Editor& editor, const DocumentNode& node) {
  const bool filling = editor.jobs.running("preview");
  static const SoftPreview kNone;
  const SoftPreview& p = preview_ ? *preview_ : kNone;
  const auto known = [&](std::string value) { return preview_ ? value : std::string(filling ? "\u2026" : "\u2013"); };
  soft_figure("Cell", filling ? "filling \u2026" : known(fmt::format("{:.3g} mm", p.cell * 1e3)));
  soft_figure("Tetrahedra", known(fmt::format("{}", p.tetrahedra)));
  soft_figure("Worst quality",
              known(fmt::format("{:.2f} of 1, angles {:.0f} to {:.0f}\u00b0", p.quality.worst_ratio,
                                glm::degrees(p.quality.smallest_dihedral), glm::degrees(p.quality.largest_dihedral))));
  soft_figure("Volume", known(fmt::format("{:.4g} cm\u00b3", p.volume * 1e6)));
  soft_figure("Pinned, on handle", known(fmt::format("{}, {} nodes", p.pinned, p.on_handle)));
  if (p.wall > 0.0) soft_figure("Wall", fmt::format("{:.2g} mm", p.wall * 1e3));
  if (preview_ && (p.parts != 1 || p.parts_lost > 0))
    soft_figure("Parts", fmt::format("{} kept, {} lost", p.parts, p.parts_lost));
  const bool slow = p.step_ms > 1e3 * editor.state().simulation.soft_step;
  soft_figure("A step takes about",
              known(fmt::format("{:.1f} of {:.1f} ms", p.step_ms, 1e3 * editor.state().simulation.soft_step)), slow);
  if (slow) ui::dim("Slower than real time on this machine; a coarser cell is faster.");
  for (const Note& found : p.notes) {
    ImGui::TextColored(ui::palette().warning, "Note");
    ImGui::SameLine();
    ui::dim(found.message().c_str());
    offer(editor, node, found.code);
  }
}

void soft_figure(const char* what, const std::string& value, bool bad) {
  ImGui::TextColored(ui::palette().dim, "%s", what);
  ImGui::SameLine(ui::px(140));
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(bad ? ui::palette().warning : ui::palette().text, "%s", value.c_str());
  ImGui::PopTextWrapPos();
}

void SoftPanel::offer(Editor& editor, const DocumentNode& node, const std::string& code) {
  const NodeId ids[] = {node.id};
  if (code != kFillNote) return;
  const auto fill = [&](const char* label, const char* word, const char* hint) {
    if (ui::button(label, hint)) editor.apply(label, with_value(editor.state(), ids, "soft_body", "fill", word));
    ImGui::SameLine();
  };
  fill("Fill the inside", "solid", "All that the outer surface encloses becomes tissue");
  fill("Only the wall", "wall", "The layer behind the surface becomes tissue; its thickness is in the inspector");
  ImGui::NewLine();
}

void SoftPanel::show_edges(const Editor& editor, const DocumentNode& node, const std::vector<dvec3>& nodes,
                           vec4 color) {
  if (!preview_ || !shown_ || nodes.size() != preview_->nodes.size() || editor.playing) return;
  const dmat4 to_world = editor.state().to_world(node.id) * glm::inverse(to_object_);
  const std::size_t every = 1 + preview_->edges.size() / kMostEdgesShown;
  const auto at = [&](std::uint32_t n) { return vec3(dvec3(to_world * glm::dvec4(nodes[n], 1.0))); };
  for (std::size_t i = 0; i < preview_->edges.size(); i += every) {
    const auto& [a, b] = preview_->edges[i];
    app_.extra_lines.push_back({at(a), at(b), color, true});
  }
}

void SoftPanel::ask(Editor& editor, const DocumentNode& node) {
  PreviewInputs now;
  now.mesh = editor.state().meshes[static_cast<std::size_t>(node.node.mesh)];
  now.to_world = editor.state().to_world(node.id);
  const Json extensions = node_extensions(node.node, Json());
  now.soft = extensions.value("PLIANT_soft_body", Json());
  now.handle = extensions.value("PLIANT_handle", Json());
  now.gravity = editor.state().simulation.gravity;
  if (!(now == wanted_)) {
    wanted_ = now;
    wanted_at_ = editor.now;
  }
  if (asked_ == wanted_ || editor.now - wanted_at_ < kPause) return;
  asked_ = wanted_;
  // The level with this node alone, so that the object frame is the same as in a run.
  auto level = std::make_shared<Level>(level_of(editor.state()));
  const std::int32_t at = place_in(*level, node.node.name);
  editor.jobs.start("preview", "Filling " + node.node.name, [this, level, at](const Jobs::Stop& stop) {
    const LevelNode& of = level->nodes[static_cast<std::size_t>(at)];
    const ObjectFrame frame = object_frame(*level, at);
    Result<SoftPreview> preview = Error{"", ""};
    Result<BuiltMesh> built =
        build_mesh(of.name, level->meshes[static_cast<std::size_t>(of.mesh)].primitives, mat4(frame.to_object));
    if (built)
      preview = preview_soft_body(*built, *of.soft_body, of.handle ? &*of.handle : nullptr, stop.source.get_token());
    else
      preview = built.error();
    auto shared = std::make_shared<Result<SoftPreview>>(std::move(preview));
    std::optional<Equilibrium> sag;
    std::optional<Unloaded> unloaded;
    if (*shared && !of.handle) {
      const std::stop_token token = stop.source.get_token();
      const dvec3 gravity = glm::conjugate(frame.pose.rotation) * level->simulation.gravity;
      sag = find_equilibrium((*shared)->body, *of.soft_body, gravity, nullptr, token);
      if (of.soft_body->under_gravity == UnderGravity::kModelled && sag->held)
        unloaded = find_unloaded((*shared)->body, *of.soft_body, gravity, token);
    }
    const std::optional<Note> doubt =
        sag ? sag_doubt(*of.soft_body, *sag, unloaded ? &*unloaded : nullptr) : std::nullopt;
    return [this, shared, frame, sag, unloaded, doubt](Editor&) {
      trouble_.reset();
      preview_.reset();
      sag_ = sag;
      unloaded_ = unloaded;
      doubt_ = doubt ? doubt->message() : std::string();
      if (*shared)
        preview_ = std::move(**shared);
      else
        trouble_ = shared->error();
      to_object_ = frame.to_object;
      shown_ = true;
    };
  });
}

}  // namespace pliant
