#include "editor/panels/tree_rows.h"

#include <algorithm>

#include "viewer/ui/widgets.h"

namespace pliant {

void TreeRows::take_keys(Editor& editor, bool folds) {
  const auto pressed = [](ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  if (before.empty()) return;
  const auto here = std::find(before.begin(), before.end(), editor.active());
  const bool any = here != before.end();
  const auto at = static_cast<std::ptrdiff_t>(here - before.begin()),
             last = static_cast<std::ptrdiff_t>(before.size()) - 1;
  const auto go = [&](std::ptrdiff_t to) {
    const NodeId id = before[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(to, 0, last))];
    if (ImGui::GetIO().KeyShift && any)
      select_range(editor, id);
    else
      editor.select(id);
    reveal = id;
  };
  const auto rows = static_cast<std::ptrdiff_t>(ImGui::GetWindowHeight() / ImGui::GetFrameHeightWithSpacing());
  if (pressed(ImGuiKey_DownArrow)) go(any ? at + 1 : 0);
  if (pressed(ImGuiKey_UpArrow)) go(any ? at - 1 : last);
  if (pressed(ImGuiKey_PageDown)) go(any ? at + rows : last);
  if (pressed(ImGuiKey_PageUp)) go(any ? at - rows : 0);
  if (!any || !folds) return;
  const DocumentNode* const node = editor.state().find(*here);
  const bool parent = parents.contains(*here), unfolded = open.contains(*here);
  if (pressed(ImGuiKey_RightArrow) && parent) {
    if (unfolded)
      go(at + 1);
    else
      fold[*here] = true;
  }
  if (!pressed(ImGuiKey_LeftArrow)) return;
  if (parent && unfolded)
    fold[*here] = false;
  else if (node && node->parent != kNoNode)
    editor.select(reveal = node->parent);
}

void TreeRows::select_range(Editor& editor, NodeId to) const {
  const auto from = std::find(before.begin(), before.end(), editor.active()),
             here = std::find(before.begin(), before.end(), to);
  if (from == before.end() || here == before.end()) return editor.select(to);
  editor.selected.assign(std::min(from, here), std::max(from, here) + 1);
  if (here < from) std::reverse(editor.selected.begin(), editor.selected.end());
}

}  // namespace pliant
