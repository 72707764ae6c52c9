#include "editor/panels/slider_offer.h"

#include <algorithm>

#include "content/keys/live_keys.h"
#include "content/keys/sliders.h"
#include "viewer/ui/widgets.h"

namespace pliant {

void offer_slider(Editor& editor, const Extension& extension, const Key& key, NodeId id) {
  const DocumentNode* const node = editor.state().find(id);
  if (!node || key.type != KeyType::kNumber || !why_not_live(extension, key).empty()) return;
  if (!ImGui::BeginPopupContextItem(("offer " + extension.name + "." + key.name).c_str())) return;
  const std::string path = node->node.name + "." + extension.name + "." + key.name;
  const std::vector<ExposedKey>& offered = editor.state().simulation.expose;
  const bool is_offered =
      std::any_of(offered.begin(), offered.end(), [&](const ExposedKey& each) { return each.key == path; });
  if (ui::menu_item("Slider in the run's window", nullptr, is_offered)) {
    State next = editor.state();
    if (is_offered)
      std::erase_if(next.simulation.expose, [&](const ExposedKey& each) { return each.key == path; });
    else
      next.simulation.expose.push_back({path, {}, {0, 0}, 0.0});
    if (const auto sliders = sliders_of(outline_of(next)); !sliders)
      editor.say(sliders.error().message(), Severity::kWarning);
    else
      editor.apply(is_offered ? "Remove slider" : "Offer slider", next);
  }
  ImGui::EndPopup();
}

}  // namespace pliant
