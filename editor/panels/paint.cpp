// The paint panel: attribute, brush, and operations on the whole mesh.
#include <fmt/format.h>

#include <algorithm>

#include "editor/app/app.h"
#include "editor/core/painting.h"
#include "editor/panels/brush_fields.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

void warn(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().warning);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

class PaintPanel : public Panel {
 public:
  explicit PaintPanel(App& app) : app_(app) {}
  const char* name() const override { return "Paint"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    Painting& painting = *editor.painting;
    const NodeId id = painting.node();
    if (id == kNoNode) {
      ui::gap(2);
      ui::dim("Select a node with a mesh to paint on it: how stiff it is, how it rubs, where it is held.");
      return;
    }
    painting.fit_radius();
    draw_head(editor, painting, id);
    draw_channel(editor, painting, id);
    draw_brush_fields(painting);
    draw_whole(painting);
    draw_colours(editor, painting);
  }

 private:
  void draw_head(Editor& editor, Painting& painting, NodeId id) {
    ui::gap(2);
    const bool on = editor.tool == "Paint";
    if (on ? ui::button("Stop painting", "The mouse selects again (P)")
           : ui::strong_button("Start painting", "The mouse paints in the viewport (P)"))
      app_.take_tool(on ? "Select" : "Paint");
    ImGui::SameLine();
    ui::label(printable(editor.state().find(id)->node.name).c_str());
    const std::vector<NodeId> sharing = painting.sharing();
    if (sharing.size() > 1) {
      std::string names;
      for (const NodeId each : sharing)
        names += (names.empty() ? "" : ", ") + printable(editor.state().find(each)->node.name);
      warn(fmt::format("Painted on {} nodes, which share the mesh.", sharing.size()));
      ui::hint(names.c_str());
      if (ui::button("Make single", "This node gets a copy of the mesh for itself, with all that is painted"))
        painting.make_single();
    }
    if (painting.pressed && painting.pressed->node == id && painting.pressed->coarse) {
      const std::string& sentence = painting.pressed->coarse->sentence;
      warn("Too coarse here: " + sentence + ".");
      if (ui::button("Refine here", "Smaller triangles under the brush, where it was pressed last; one step of undo",
                     !painting.busy() && painting.pressed->surface == painting.surface()))
        painting.refine(painting.pressed->hit);
    }
  }

  void draw_channel(Editor& editor, Painting& painting, NodeId id) {
    ui::gap(2);
    if (!ui::section("What")) return;
    for (const Channel each : kChannels) {
      const auto i = static_cast<int>(each);
      if (i % 3) ImGui::SameLine(0, ui::px(2));
      if (ui::choice_button(text_of(each).title, painting.channel == each, text_of(each).does))
        painting.take_channel(each);
    }
    ui::dim(text_of(painting.channel).does);
    const std::string lacks = painting.lacks();
    if (lacks.empty()) return;
    warn(lacks);
    const std::string extension = text_of(painting.channel).extension;
    if (painting.channel == Channel::kHandle) return;  // a handle also needs a device: see the inspector
    std::string words = extension;
    std::replace(words.begin(), words.end(), '_', ' ');
    if (ui::button(("Add " + words).c_str(), "With its defaults; the inspector shows it"))
      editor.apply("Add " + words, with_component(editor.state(), std::vector<NodeId>{id}, extension));
  }

  void draw_whole(Painting& painting) {
    ui::gap(2);
    if (!ui::section("Whole mesh")) return;
    const bool ready = painting.surface() != nullptr && !painting.busy() && !painting.stroking();
    const char* const wait = ready ? nullptr : "Wait until the surface is ready";
    if (ui::button("Fill all", wait ? wait : "The value above, everywhere", ready)) painting.fill_all();
    ImGui::SameLine(0, ui::px(ui::kGap));
    if (ui::button("Fill part\u2026", wait ? wait : "Then click a part; it stops at creases where the brush does",
                   ready))
      take(Painting::Hand::kFillPart, painting);
    ImGui::SameLine(0, ui::px(ui::kGap));
    if (ui::button("Gradient\u2026", wait ? wait : "Then click where it begins and where it ends", ready))
      take(Painting::Hand::kGradientFrom, painting);
    ImGui::SameLine(0, ui::px(ui::kGap));
    if (ui::button("Clear", "Nothing is painted of this any more")) painting.clear();
    const Range range = paint_range(attribute_of(painting.channel));
    const bool share = is_share(painting.channel);
    const float wide = ImGui::GetContentRegionAvail().x * (1 - kPaintLabelShare) / ui::scale();
    paint_row("Gradient", "From the first to the second click along a straight line, and level beyond both");
    ui::number("gradient from", painting.gradient_from, range.min, range.max, share ? "" : "\u00d7", !share,
               0.5f * wide - 16);
    ImGui::SameLine(0, ui::px(4));
    ui::label("to");
    ImGui::SameLine(0, ui::px(4));
    ui::number("gradient to", painting.gradient_to, range.min, range.max, share ? "" : "\u00d7", !share);
  }

  void take(Painting::Hand hand, Painting& painting) {
    app_.take_tool("Paint");
    painting.hand = hand;
    painting.gradient_start.reset();
  }

  void draw_colours(Editor& editor, Painting& painting) {
    ui::gap(2);
    if (is_share(painting.channel) || !ui::section("Colours", false)) return;
    paint_row("From", "The factor of the darkest colour");
    ui::number("low", editor.view.value_low, 1e-3, 0.9 * editor.view.value_high, "\u00d7", true);
    paint_row("To", "The factor of the lightest colour");
    ui::number("high", editor.view.value_high, 1.1 * editor.view.value_low, 1e3, "\u00d7", true);
    paint_row("", nullptr);
    if (ui::button("Fit", "To what is painted")) {
      const auto range = painting.painted_range().value_or(std::pair{0.25, 4.0});
      editor.view.value_low = std::clamp(range.first, 1e-3, 500.0);
      editor.view.value_high = std::max(range.second, 1.25 * editor.view.value_low);
    }
    ImGui::SameLine(0, ui::px(ui::kGap));
    if (ui::button("Reset##colours", "A quarter to four times")) {
      editor.view.value_low = 0.25;
      editor.view.value_high = 4.0;
    }
  }

  App& app_;
};

}  // namespace

std::unique_ptr<Panel> make_paint_panel(App& app) {
  return std::make_unique<PaintPanel>(app);
}

}  // namespace pliant
