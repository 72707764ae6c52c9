// Make it soft: a preview of the selected mesh as tissue, its pins, its material, and instruments to touch it.
#include <fmt/format.h>

#include <algorithm>

#include "content/author/instruments.h"
#include "content/author/organ.h"
#include "content/author/presets.h"
#include "content/author/staging.h"
#include "content/author/touchable.h"
#include "content/keys/extensions.h"
#include "content/keys/stated.h"
#include "content/level/soft_preview.h"
#include "content/tets/tet_findings.h"
#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "editor/viewport/solid_view.h"
#include "engine/choice/pin_advice.h"
#include "systems/soft/body/equilibrium.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr Side kSides[] = {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack};
constexpr std::size_t kMostAdvice = 4;
constexpr double kPause = 0.3;                   // [s] after the last change, before a preview starts
constexpr std::size_t kMostEdgesShown = 60'000;  // beyond it only some of them

// The inputs of a preview.
struct Asked {
  std::shared_ptr<const DocumentMesh> mesh;
  dmat4 to_world{1};
  Json soft, handle;
  dvec3 gravity{0};
  bool operator==(const Asked&) const = default;
};

std::int32_t place_in(const Level& level, const std::string& name) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].name == name) return static_cast<std::int32_t>(i);
  return -1;
}

class SoftPanel : public Panel {
 public:
  explicit SoftPanel(App& app) : app_(app) {}
  const char* name() const override { return "Tissue"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
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

 private:
  using Edit = std::function<Status(Level&, std::int32_t node)>;
  // Runs an edit of content/author on a node; selects what it added.
  bool author(Editor& editor, const std::string& what, const DocumentNode& node, const Edit& edit,
              bool select_new = false) {
    const NodeId before = editor.document.next_id();
    const std::string name = node.node.name;
    const bool done = editor.apply(what, by_level(editor.state(), editor.document.next_id(), [&](Level& level) {
                                     const std::int32_t at = place_in(level, name);
                                     return at < 0 ? Status(Error{name, "is not there any more"}) : edit(level, at);
                                   }));
    if (done && select_new)
      for (const auto& each : editor.state().nodes)
        if (each->id >= before) {
          editor.selected = {each->id};
          break;
        }
    return done;
  }

  void draw_kind(Editor& editor, const DocumentNode& node) {
    const LevelNode& it = node.node;
    ui::title(it.name.c_str());
    const auto kind = [&](const char* label, bool down, const char* hint, const Edit& edit) {
      if (ui::choice_button(label, down, hint) && !down) author(editor, label, node, edit);
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

  // Makes an organ of several nested meshes soft, in one click.
  void draw_organ(Editor& editor, const DocumentNode& node) {
    if (!ui::button("All parts of this organ",
                    "The outermost of its meshes becomes tissue, and takes along those that lie inside of it: vessels, "
                    "lumps, an inner sheet"))
      return;
    std::string body, parts;
    const bool done = author(editor, "All parts of this organ", node, [&](Level& level, std::int32_t at) -> Status {
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

  void draw_material(Editor& editor, const DocumentNode& node) {
    if (!node.node.deformable && !node.node.soft_body) return;
    ui::gap(2);
    if (!ui::section("Material")) return;
    const ui::Scope scope("Material");
    for (const TissuePreset& preset : tissue_presets()) {
      const bool soft = node.node.soft_body.has_value();
      const bool now =
          soft ? node.node.soft_body->young == preset.young && node.node.soft_body->density == preset.density
               : node.node.deformable->stiffness == surface_stiffness(preset);
      const std::string label = fmt::format("{} {}  ({:.3g} kPa)###{}", now ? "\u2713" : "   ", preset.name,
                                            preset.young * 1e-3, preset.word);
      const bool pressed = ImGui::Selectable(label.c_str(), now);
      ui::known_as(preset.word);
      ui::hint(fmt::format("Young's modulus {:.3g} kPa ({:.3g} to {:.3g}); a fingertip feels {:.3g} N/m.\n{}",
                           preset.young * 1e-3, preset.low * 1e-3, preset.high * 1e-3, surface_stiffness(preset),
                           preset.source)
                   .c_str());
      if (!pressed) continue;
      author(editor, std::string("Material ") + preset.name, node, [&](Level& level, std::int32_t at) {
        LevelNode& of = level.nodes[static_cast<std::size_t>(at)];
        if (of.soft_body) {
          const SoftBodyParameters from = soft_body_of(preset);
          SoftBodyParameters& to = *of.soft_body;
          to.young = from.young;
          to.poisson = from.poisson;
          to.density = from.density;
          to.rayleigh = from.rayleigh;
          to.friction_static = from.friction_static;
          to.friction_sliding = from.friction_sliding;
        } else {
          const DeformableParameters from = surface_of(preset);
          DeformableParameters& to = *of.deformable;
          to.young = 0.0;
          to.stiffness = surface_stiffness(preset);
          to.settling_time = from.settling_time;
          to.friction_static = from.friction_static;
          to.friction_sliding = from.friction_sliding;
        }
        return Status(Done{});
      });
    }
  }

  void draw_lattice(Editor& editor, const DocumentNode& node) {
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
    // The rows are always shown, even without values, so that the widgets below do not move.
    const bool filling = editor.jobs.running("preview");
    static const SoftPreview kNone;
    const SoftPreview& p = preview_ ? *preview_ : kNone;
    const auto known = [&](std::string value) { return preview_ ? value : std::string(filling ? "\u2026" : "\u2013"); };
    figure("Cell", filling ? "filling \u2026" : known(fmt::format("{:.3g} mm", p.cell * 1e3)));
    figure("Tetrahedra", known(fmt::format("{}", p.tetrahedra)));
    figure("Worst quality",
           known(fmt::format("{:.2f} of 1, angles {:.0f} to {:.0f}\u00b0", p.quality.worst_ratio,
                             glm::degrees(p.quality.smallest_dihedral), glm::degrees(p.quality.largest_dihedral))));
    figure("Volume", known(fmt::format("{:.4g} cm\u00b3", p.volume * 1e6)));
    figure("Pinned, on handle", known(fmt::format("{}, {} nodes", p.pinned, p.on_handle)));
    if (p.wall > 0.0) figure("Wall", fmt::format("{:.2g} mm", p.wall * 1e3));
    if (preview_ && (p.parts != 1 || p.parts_lost > 0))
      figure("Parts", fmt::format("{} kept, {} lost", p.parts, p.parts_lost));
    const bool slow = p.step_ms > 1e3 * editor.state().simulation.soft_step;
    figure("A step takes about",
           known(fmt::format("{:.1f} of {:.1f} ms", p.step_ms, 1e3 * editor.state().simulation.soft_step)), slow);
    if (slow) ui::dim("Slower than real time on this machine; a coarser cell is faster.");
    for (const Note& found : p.notes) {
      ImGui::TextColored(ui::palette().warning, "Note");
      ImGui::SameLine();
      ui::dim(found.message().c_str());
      offer(editor, node, found.code);
    }
    bool carries = body.carries == Carries::kInside;
    if (ui::checkbox("Takes its parts along", carries, "Meshes inside of it that are only drawn go with its tissue"))
      editor.apply("Takes its parts along",
                   with_value(editor.state(), ids, "soft_body", "carries", carries ? "inside" : "nothing"));
    ui::checkbox("Show tetrahedra", editor.view.tetrahedra, "Their edges, in the viewport");
    if (editor.view.tetrahedra) show_edges(editor, node);
  }

  void figure(const char* what, const std::string& value, bool bad = false) {
    ImGui::TextColored(ui::palette().dim, "%s", what);
    ImGui::SameLine(ui::px(140));
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(bad ? ui::palette().warning : ui::palette().text, "%s", value.c_str());
    ImGui::PopTextWrapPos();
  }

  // Shows a button for a finding's remedy, if there is one.
  void offer(Editor& editor, const DocumentNode& node, const std::string& code) {
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

  void show_edges(const Editor& editor, const DocumentNode& node) {
    if (!preview_ || !shown_ || editor.playing) return;
    const dmat4 to_world = editor.state().to_world(node.id) * glm::inverse(to_object_);
    const std::size_t every = 1 + preview_->edges.size() / kMostEdgesShown;
    const ImVec4& c = ui::palette().depth;
    for (std::size_t i = 0; i < preview_->edges.size(); i += every) {
      const auto& [a, b] = preview_->edges[i];
      app_.extra_lines.push_back({vec3(dvec3(to_world * glm::dvec4(preview_->nodes[a], 1.0))),
                                  vec3(dvec3(to_world * glm::dvec4(preview_->nodes[b], 1.0))),
                                  vec4(c.x, c.y, c.z, 0.35f), true});
    }
  }

  // The equilibrium on its pins, before playing.
  void draw_gravity(Editor& editor, const DocumentNode& node) {
    ui::gap(2);
    if (!ui::section("Under gravity")) return;
    const ui::Scope scope("Gravity");
    const NodeId ids[] = {node.id};
    const SoftBody& body = *node.node.soft_body;
    const auto choice = [&](const char* label, UnderGravity value, const char* word, const char* hint) {
      if (ui::choice_button(label, body.under_gravity == value, hint) && body.under_gravity != value)
        editor.apply(label, with_value(editor.state(), ids, "soft_body", "under_gravity", word));
      ImGui::SameLine(0, ui::px(2));
    };
    choice("As modelled", UnderGravity::kModelled, "modelled",
           "The mesh is its shape under gravity, which it keeps until it is touched");
    choice("Settled", UnderGravity::kSettled, "settled",
           "The mesh is its shape without weight, and it begins where it rests on its pins");
    choice("Falls", UnderGravity::kFalls, "falls", "The mesh is its shape without weight, from which it falls");
    ImGui::NewLine();
    if (!sag_ || !preview_) {
      figure("Sag", editor.jobs.running("preview") ? "\u2026" : "\u2013");
    } else if (!sag_->held) {
      figure("Sag", "falls: nothing is pinned", true);
    } else {
      const bool kept = body.under_gravity == UnderGravity::kModelled && unloaded_ && unloaded_->found;
      const bool much = !doubt_.empty();
      figure("Sag",
             kept ? fmt::format("none; {:.2g} mm without its tension", 1e3 * sag_->most)
                  : fmt::format("{:.2g} mm, {:.1f} % of its size", 1e3 * sag_->most,
                                100.0 * sag_->most / std::max(sag_->size, 1e-12)),
             much);
      if (sag_->turned > kMuchTurn)
        figure("Turns over", fmt::format("by {:.0f}\u00b0", glm::degrees(sag_->turned)), true);
      if (much) {
        ImGui::TextColored(ui::palette().warning, "Warning");
        ImGui::SameLine();
        ui::dim(doubt_.c_str());
      }
    }
    ui::checkbox("Show the sag", show_sag_, "Where it would rest on its pins without tension, in the viewport");
    if (show_sag_) show_sag(editor, node);
    draw_advice(editor, node);
  }

  // Suggests sides to pin, the smallest sufficient one first.
  void draw_advice(Editor& editor, const DocumentNode& node) {
    if (ui::button("Suggest pins", "Looks which side, pinned, holds it: some seconds", !editor.jobs.running("pins"))) {
      advice_.reset();
      advice_of_ = node.id;
      auto level = std::make_shared<Level>(level_of(editor.state()));
      const std::int32_t at = place_in(*level, node.node.name);
      editor.jobs.start(
          "pins", "Looking for pins that hold " + node.node.name, [this, level, at](const Jobs::Stop& stop) {
            auto found = std::make_shared<std::vector<PinAdvice>>(advise_pins(*level, at, stop.source.get_token()));
            return [this, found](Editor&) { advice_ = std::move(*found); };
          });
    }
    if (!advice_ || advice_of_ != node.id) return;
    if (advice_->empty())
      ui::dim(
          "No side of 30 % holds it; give it a higher Young's modulus, or paint the channel `pinned` where it is "
          "grown to something.");
    for (std::size_t i = 0; i < advice_->size() && i < kMostAdvice; ++i) {
      const PinAdvice& each = (*advice_)[i];
      const std::string label = fmt::format("Pin {} {:.0f} %: sags {:.2g} mm###Pin {}", word_of(each.side),
                                            100.0 * each.share, 1e3 * each.sag, i + 1);
      if (ui::button(label.c_str(), "Pins this side instead of what is pinned now"))
        author(editor, "Pin the " + std::string(word_of(each.side)), node, [each](Level& level, std::int32_t at) {
          unpin(level, at);
          return pin(level, at, each.side, each.share);
        });
    }
  }

  void show_sag(const Editor& editor, const DocumentNode& node) {
    if (!preview_ || !shown_ || !sag_ || sag_->nodes.size() != preview_->nodes.size() || editor.playing) return;
    const dmat4 to_world = editor.state().to_world(node.id) * glm::inverse(to_object_);
    const std::size_t every = 1 + preview_->edges.size() / kMostEdgesShown;
    const ImVec4& c = ui::palette().warning;
    const auto at = [&](std::uint32_t n) { return vec3(dvec3(to_world * glm::dvec4(sag_->nodes[n], 1.0))); };
    for (std::size_t i = 0; i < preview_->edges.size(); i += every) {
      const auto& [a, b] = preview_->edges[i];
      app_.extra_lines.push_back({at(a), at(b), vec4(c.x, c.y, c.z, 0.5f), true});
    }
  }

  // Starts a preview if the inputs have changed.
  void ask(Editor& editor, const DocumentNode& node) {
    Asked now;
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

  void draw_pins(Editor& editor, const DocumentNode& node) {
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
        author(editor, "Pin the " + std::string(word_of(side)), node,
               [&](Level& level, std::int32_t at) { return pin(level, at, side, share_); });
    }
    if (ui::button("Nothing pinned", "Removes the box and the paint"))
      author(editor, "Unpin", node, [](Level& level, std::int32_t at) {
        unpin(level, at);
        return Status(Done{});
      });
  }

  void draw_instruments(Editor& editor, const DocumentNode& node) {
    ui::gap(2);
    if (!ui::section("Touch it with")) return;
    const ui::Scope scope("Instruments");
    const auto add = [&](const char* label, const char* hint, const Edit& edit) {
      if (ui::button(label, hint, true, 140)) author(editor, std::string("Add ") + label, node, edit, true);
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

  App& app_;
  double share_ = 0.15;  // [1]
  Asked wanted_, asked_;
  double wanted_at_ = 0.0;  // [s]
  std::optional<SoftPreview> preview_;
  dmat4 to_object_{1};
  bool shown_ = false;
  std::optional<Equilibrium> sag_;  // of the preview
  std::optional<Unloaded> unloaded_;
  std::string doubt_;
  bool show_sag_ = false;
  std::optional<std::vector<PinAdvice>> advice_;
  NodeId advice_of_ = kNoNode;
  std::optional<Error> trouble_;
};

}  // namespace

std::unique_ptr<Panel> make_soft_panel(App& app) {
  return std::make_unique<SoftPanel>(app);
}

}  // namespace pliant
