#include "editor/app/navigation.h"

namespace pliant {
namespace {

constexpr NavigationRow kNavigation[] = {
    {"Pliant", "Left on nothing or right turns, Shift or middle shifts"},
    {"Blender", "Middle turns, Shift + middle shifts, Ctrl + middle zooms"},
    {"Maya", "Alt + left turns, Alt + middle shifts, Alt + right zooms"},
    {"CAD", "Middle turns, Ctrl + middle shifts, Shift + middle zooms"},
};

ViewMotion own_motion(const ViewDrag& d) {
  if (d.middle || ((d.left || d.right) && d.shift)) return ViewMotion::kShift;
  return d.left || d.right ? ViewMotion::kTurn : ViewMotion::kNone;
}

}  // namespace

std::span<const NavigationRow> navigation_rows() {
  return kNavigation;
}

ViewMotion view_motion(const std::string& navigation, const ViewDrag& d) {
  if (navigation == "Maya") {
    if (!d.alt) return ViewMotion::kNone;
    return d.middle ? ViewMotion::kShift : d.right ? ViewMotion::kZoom : d.left ? ViewMotion::kTurn : ViewMotion::kNone;
  }
  const bool blender = navigation == "Blender";
  if (!blender && navigation != "CAD") return own_motion(d);
  if (!d.middle) return ViewMotion::kNone;
  const bool shifts = blender ? d.shift : d.control, zooms = blender ? d.control : d.shift;
  return shifts ? ViewMotion::kShift : zooms ? ViewMotion::kZoom : ViewMotion::kTurn;
}

}  // namespace pliant
