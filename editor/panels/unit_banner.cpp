// Asks for the unit of a bare mesh that is probably not in metres.
#include <fmt/format.h>

#include "content/level/unit.h"
#include "editor/panels/panels.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

class UnitBanner : public Panel {
 public:
  const char* name() const override { return "Unit"; }
  Place place() const override { return Place::kBanner; }
  bool shown(const Editor& editor) const override {
    if (answered_ == editor.documents || !editor.document.file().empty() || editor.playing) return false;
    if (asked_ != editor.document.revision() || of_ != editor.documents) {
      asked_ = editor.document.revision();
      of_ = editor.documents;
      doubtful_ = !outline_of(editor.state()).has_pliant() && !unit_hint(editor.scene_box()).empty();
    }
    return doubtful_;
  }

  void draw(Editor& editor) override {
    const bool narrow = ImGui::GetIO().DisplaySize.x < ui::px(1000);  // then its buttons are in a second row
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(narrow ? ui::px(190) : 0.0f);
    ImGui::TextUnformatted(
        fmt::format("This mesh is {:.3g} m across. What is one unit of it?", editor.scene_box().diagonal()).c_str());
    ImGui::PopTextWrapPos();
    for (const auto& [name, metres] : {std::pair{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}}) {
      if (!narrow || metres != 1e-3) ImGui::SameLine();
      if (!ui::button(name, metres == 1.0 ? "It is as large as it says" : "Scales everything; undo takes it back"))
        continue;
      answered_ = editor.documents;
      if (metres == 1.0) continue;
      editor.apply(fmt::format("Unit {}", name),
                   by_level(editor.state(), editor.document.next_id(), [metres = metres](Level& level) -> Status {
                     scale_roots(level, metres);
                     return Done{};
                   }));
      editor.camera = CameraControl::before(editor.scene_box());
    }
  }

 private:
  mutable std::uint64_t asked_ = ~std::uint64_t{0}, of_ = ~std::uint64_t{0};
  mutable bool doubtful_ = false;
  std::uint64_t answered_ = ~std::uint64_t{0};  // Editor::documents
};

}  // namespace

std::unique_ptr<Panel> make_unit_banner() {
  return std::make_unique<UnitBanner>();
}

}  // namespace pliant
