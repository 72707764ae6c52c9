// Keys of the program: which action a press belongs to, and whether it counts.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "editor/app/app.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"
#include "viewer/window/keys.h"

namespace pliant {

void App::keys(std::span<const InputEvent> events) {
  for (const InputEvent& event : events) {
    if (event.kind == InputKind::kClose) close();
    if (event.kind == InputKind::kDrop) drop(event.files);
    if (event.kind != InputKind::kKey) continue;
    const std::string pressed = keys_text(event.key, event.modifiers);
    const auto urgent = std::find_if(actions_.begin(), actions_.end(), [&](const Action& each) {
      return each.always && !pressed.empty() && keys_of(each) == pressed && each.enabled(editor);
    });
    if (urgent != actions_.end()) {
      urgent->run(editor);
      continue;
    }
    if (!rebinding.empty()) {
      if (!pressed.empty()) rebound = pressed;
      continue;
    }
    const ViewTool* const t = tool();
    if (event.key == GLFW_KEY_TAB && (event.modifiers & (kControl | kAlt)) == 0 && !(t && t->wants_keys())) {
      ui::focus_next(event.modifiers & kShift);
      continue;
    }
    if (!questions_.empty() || after_leaving_) continue;  // they come first
    for (const Action& action : actions_) {
      if (pressed.empty() || keys_of(action) != pressed || !shortcut_counts(action, event)) continue;
      if (action.enabled(editor)) action.run(editor);
      break;
    }
  }
}

// Keys go to the text field with focus, then to the menu, dialog or widget with keyboard focus, then to the program.
bool App::shortcut_counts(const Action& action, const InputEvent& event) const {
  const ViewTool* const t = const_cast<App*>(this)->tool();
  if ((ImGui::GetIO().WantTextInput || (t && t->wants_keys())) && !action.while_typing) return false;
  if (event.repeated && !action.repeats && action.id != "edit.undo" && action.id != "edit.redo") return false;
  const bool plain = (event.modifiers & (kControl | kAlt)) == 0 && event.key < GLFW_KEY_F1;
  if (plain && popup_was_open_) return false;
  const bool dialog = std::any_of(panels_.begin(), panels_.end(), [&](const auto& each) {
    return each->place() == Panel::Place::kOver && is_open(each->name());
  });
  if (plain && dialog) return false;
  constexpr int kOfWidgets[] = {GLFW_KEY_SPACE, GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER, GLFW_KEY_LEFT,
                                GLFW_KEY_RIGHT, GLFW_KEY_UP,    GLFW_KEY_DOWN};
  return !(plain && ui::keyboard_has_focus() &&
           std::find(std::begin(kOfWidgets), std::end(kOfWidgets), event.key) != std::end(kOfWidgets));
}

}  // namespace pliant
