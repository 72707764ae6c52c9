// The panel Tissue: how it sags under gravity on its pins, and pins that would hold it.
#include <fmt/format.h>

#include <algorithm>

#include "content/author/organ.h"
#include "content/author/staging.h"
#include "content/author/touchable.h"
#include "editor/panels/soft_panel.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr std::size_t kMostAdvice = 4;

}  // namespace

void SoftPanel::draw_gravity(Editor& editor, const DocumentNode& node) {
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
    soft_figure("Sag", editor.jobs.running("preview") ? "\u2026" : "\u2013");
  } else if (!sag_->held) {
    soft_figure("Sag", "falls: nothing is pinned", true);
  } else {
    const bool kept = body.under_gravity == UnderGravity::kModelled && unloaded_ && unloaded_->found;
    const bool much = !doubt_.empty();
    soft_figure("Sag",
                kept ? fmt::format("none; {:.2g} mm without its tension", 1e3 * sag_->most)
                     : fmt::format("{:.2g} mm, {:.1f} % of its size", 1e3 * sag_->most,
                                   100.0 * sag_->most / std::max(sag_->size, 1e-12)),
                much);
    if (sag_->turned > kMuchTurn)
      soft_figure("Turns over", fmt::format("by {:.0f}\u00b0", glm::degrees(sag_->turned)), true);
    if (much) {
      ImGui::TextColored(ui::palette().warning, "Warning");
      ImGui::SameLine();
      ui::dim(doubt_.c_str());
    }
  }
  ui::checkbox("Show the sag", show_sag_, "Where it would rest on its pins without tension, in the viewport");
  if (show_sag_ && sag_) show_edges(editor, node, sag_->nodes, shown_as(ui::palette().warning, 0.5f));
  draw_advice(editor, node);
}

void SoftPanel::draw_advice(Editor& editor, const DocumentNode& node) {
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
      author_node(editor, "Pin the " + std::string(word_of(each.side)), node, [each](Level& level, std::int32_t at) {
        unpin(level, at);
        return pin(level, at, each.side, each.share);
      });
  }
}

}  // namespace pliant
