// The model that an error budget chooses for the selected object, with all candidates, measured on that object.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "content/keys/extension_table.h"
#include "editor/budget/budget_fit.h"
#include "editor/panels/candidates.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kTrial = 0.3, kLeast = 1e-3;  // [1] budget at first, of an object that has none; and at least
constexpr float kPlotShare = 0.32f;            // [1] of the width
constexpr float kLeastPlot = 200, kMostPlot = 560, kLeastWords = 160, kLeastTable = 76;  // [point]

// "shape punch, distance chord"
std::string list_of(const std::vector<StatedKey>& keys) {
  std::string all;
  for (const StatedKey& each : keys) {
    const std::string unit = find_key(*find_extension(each.extension), each.key)->unit;
    const std::string value = each.value.is_number()   ? fmt::format("{:.4g}", each.value.get<double>())
                              : each.value.is_string() ? each.value.get<std::string>()
                                                       : each.value.dump();
    all += fmt::format("{}{} {}{}{}", all.empty() ? "" : ", ", each.key, value, unit.empty() || unit == "1" ? "" : " ",
                       unit == "1" ? "" : unit);
  }
  return all;
}

bool of_all_bodies(const std::vector<StatedKey>& keys) {
  return std::any_of(keys.begin(), keys.end(), [](const StatedKey& each) { return each.extension == "simulation"; });
}

class ErrorBudgetPanel : public Panel {
 public:
  const char* name() const override { return "Error budget"; }
  Place place() const override { return Place::kBottom; }
  std::string badge(const Editor& editor) const override { return fits_.progress(editor) ? "\u2026" : ""; }

  void draw(Editor& editor) override {
    fits_.update(editor);
    const DocumentNode* const found = editor.active_node();
    if (!found || budget_extension(found->node).empty()) {
      ui::gap();
      ui::dim(
          "Select an object with a deformable surface or a soft body. Its models are measured here, and an error "
          "budget "
          "takes the cheapest that is good enough.");
      return;
    }
    const DocumentNode node = *found;  // a copy, because edits in this frame replace the document's
    look(editor, node.id);
    draw_controls(editor, node);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const BudgetFit* const fit = fits_.of(node.id);
    const bool shows = fit && fit->choices;
    const float plot = std::clamp(kPlotShare * room.x, ui::px(kLeastPlot), ui::px(kMostPlot)),
                left = shows ? std::max(room.x - plot - ui::px(ui::kPad), ui::px(kLeastWords)) : room.x;
    ImGui::BeginChild("left", {left, room.y});
    draw_result(editor, node.id);
    ImGui::EndChild();
    if (!shows) return;
    ImGui::SameLine(0, ui::px(ui::kPad));
    view_.plot(with_budget(shown(*fit->choices), budget_), plot, room.y, stale_);
  }

 private:
  // Reads the object's current state from the document.
  void look(const Editor& editor, NodeId id) {
    const DocumentNode& node = *editor.state().find(id);
    const double own = budget_of(node.node);
    has_budget_ = own > 0.0;
    budget_ = has_budget_ ? own : trial_;
    stale_ = fits_.stale(editor.state(), id);
    in_use_ = fits_.in_use(editor.state(), id);
    const auto now = std::tuple(editor.documents, editor.document.revision(), id);
    if (now == looked_) return;
    looked_ = now;
    said_ = stated_keys(editor.state(), id);
  }

  void draw_controls(Editor& editor, const DocumentNode& node) {
    const NodeId ids[] = {node.id};
    const std::string extension = budget_extension(node.node);
    const Key& key = *find_key(*find_extension(extension), "error");
    ui::label("Error at most", (key.doc + "\n0.3 is 30 %").c_str());
    ImGui::SameLine();
    double next = budget_;
    if (ui::number(key.name.c_str(), next, kLeast, key.range.max, "", false, 64)) {
      if (has_budget_)
        editor.apply("Set error", with_value(editor.state(), ids, extension, key.name, next), extension + ".error");
      else
        trial_ = next;
      budget_ = next;
    }
    ui::hint(has_budget_ ? key.doc.c_str() : "Of no key: the level has no budget for this object. Try one here.");
    ImGui::SameLine();
    if (has_budget_) {
      if (ui::button("No budget", "Takes the key `error` out of the level: what is chosen by hand counts")) {
        trial_ = budget_;
        editor.apply("No error budget", without_stated(editor.state(), node.id, {{extension, key.name, {}}}));
      }
    } else if (ui::button("Give it this budget",
                          "Writes the key `error`: what the level does not say is chosen whenever it is opened")) {
      editor.apply("Set error", with_value(editor.state(), ids, extension, key.name, trial_));
    }
    // In a small window the row is wrapped.
    ui::rows_end_at(ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x);
    ui::beside(ui::kSpace, "Measure again");
    ui::rows_end_at(0);
    if (const auto progress = fits_.progress(editor)) {
      draw_progress(editor, *progress);
      return;
    }
    const bool again = fits_.of(node.id) != nullptr, may = !editor.playing;
    const char* const label = again ? "Measure again" : "Measure";
    const char* const hint =
        may ? "Presses the object with every model of it, in the background; the level stays as it is"
            : "Stop playing first: a run has the machine to itself";
    if (!again || stale_ ? ui::strong_button(label, hint, may) : ui::button(label, hint, may))
      fits_.measure(editor, node.id, budget_);
    draw_use(editor, node.id);
  }

  void draw_use(Editor& editor, NodeId id) {
    const BudgetFit* const fit = fits_.of(id);
    if (!fit || !fit->choices) return;
    const bool another = chooses_another(*fit->choices, budget_);
    const std::string keys = list_of(fit->keys);
    std::string hint = in_use_   ? "The level says it already"
                       : stale_  ? "Measure again first: the object is another one than was measured"
                       : another ? "Measure again first: this budget takes another model"
                       : fit->keys.empty()
                           ? "The level itself says all that could be chosen"
                           : "Writes " + keys +
                                 " into the level, as one step that can be undone. They are yours then: "
                                 "no budget chooses them any more.";
    const bool may = !in_use_ && !stale_ && !another && !fit->keys.empty();
    if (may && of_all_bodies(fit->keys)) hint += " The soft step is that of all soft bodies.";
    ui::rows_end_at(ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x);
    ui::beside(ui::kSpace, "Use it");
    ui::rows_end_at(0);
    if (may ? ui::strong_button("Use it", hint.c_str()) : ui::button("Use it", hint.c_str(), false)) {
      fits_.use(editor, id);
      look(editor, id);
    }
  }

  void draw_progress(Editor& editor, const BudgetFits::Progress& progress) {
    if (ui::button("Cancel", "Nothing of the level has changed")) {
      fits_.cancel(editor);
      return;
    }
    const DocumentNode* const of = editor.state().find(progress.node);
    ImGui::SameLine();
    ImGui::TextColored(ui::palette().dim, "%s",
                       fmt::format("measuring {}: {} measurement{}, {:.0f} s", of ? printable(of->node.name) : "",
                                   progress.parts, progress.parts == 1 ? "" : "s", std::floor(progress.seconds))
                           .c_str());
  }

  void draw_result(Editor& editor, NodeId id) {
    const BudgetFit* const fit = fits_.of(id);
    const auto warn = [](const char* what, const char* why) {
      ImGui::TextColored(ui::palette().warning, "%s", what);
      ImGui::SameLine();
      ui::dim(why);
    };
    if (!fit) {
      ui::dim(
          "Measuring presses this object with every model of it: about a second for a surface, several for a soft "
          "body. "
          "A budget in the level is measured like this whenever the level is opened.");
      draw_said(editor, id);
      return;
    }
    if (stale_) warn("Out of date", "The object has changed since it was measured.");
    if (!fit->choices) {
      ImGui::TextColored(ui::palette().bad, "%s", "Could not be measured");
      ui::dim(printable(fit->choices.error().message()).c_str());
      draw_said(editor, id);
      return;
    }
    draw_kinds(*fit->choices);
    const ModelChoice choice = with_budget(shown(*fit->choices), budget_);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(printable(choice.sentence()).c_str());
    ImGui::PopTextWrapPos();
    draw_said(editor, id);
    view_.table(choice, std::max(ImGui::GetContentRegionAvail().y, ui::px(kLeastTable)), stale_);
  }

  // Selects which choice the sentence, table and plot show: surface, body or tool.
  void draw_kinds(const std::vector<ModelChoice>& choices) {
    if (choices.size() < 2) return;
    for (const ModelChoice& each : choices) {
      const bool open = each.kind == shown(choices).kind;
      const std::string hint = "Shows what was measured for the " + each.kind;
      if (open ? ui::strong_button(each.kind.c_str(), hint.c_str()) : ui::button(each.kind.c_str(), hint.c_str()))
        kind_ = each.kind;
      ImGui::SameLine();
    }
    ImGui::NewLine();
  }
  const ModelChoice& shown(const std::vector<ModelChoice>& choices) const {
    const auto it = std::find_if(choices.begin(), choices.end(), [&](const ModelChoice& c) { return c.kind == kind_; });
    return it == choices.end() ? choices.front() : *it;
  }

  void draw_said(Editor& editor, NodeId id) {
    if (said_.empty()) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(ui::palette().dim, "%s", ("The level itself says " + list_of(said_)).c_str());
    ImGui::SameLine();
    if (ui::button(
            "Let the budget choose",
            of_all_bodies(said_)
                ? "Takes them out of the level, as one step that can be undone; the soft step for all soft bodies"
                : "Takes them out of the level, as one step that can be undone"))
      editor.apply("Let the budget choose", without_stated(editor.state(), id, said_));
  }

  BudgetFits fits_;
  CandidateView view_;
  std::string kind_;       // of the choice that is shown; another object's first where it has none
  double trial_ = kTrial;  // [1] budget that is not in a key
  // Of the selected object, as the document is:
  bool has_budget_ = false, stale_ = false, in_use_ = false;
  double budget_ = kTrial;  // [1] its own, else the trial
  std::tuple<std::uint64_t, std::uint64_t, NodeId> looked_{~std::uint64_t{0}, 0, kNoNode};
  std::vector<StatedKey> said_;
};

}  // namespace

std::unique_ptr<Panel> make_error_budget_panel() {
  return std::make_unique<ErrorBudgetPanel>();
}

}  // namespace pliant
