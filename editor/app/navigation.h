// Which drags move the view: the editor's own, or those of other programs (Settings::navigation).
#pragma once

#include <array>
#include <span>
#include <string>

namespace pliant {

struct NavigationRow {
  const char *name, *hint;
};
// In the order of Settings: the editor's own first.
std::span<const NavigationRow> navigation_rows();

// Buttons that drag over the viewport, and modifiers.
struct ViewDrag {
  bool left = false, right = false, middle = false;
  bool shift = false, control = false, alt = false;
};
enum class ViewMotion { kNone, kTurn, kShift, kZoom };
// `left` only where no tool uses it. An unknown name: the editor's own.
ViewMotion view_motion(const std::string& navigation, const ViewDrag& drag);

}  // namespace pliant
