// Whether the widget at an address can be pressed: not if it is covered, clipped, scrolled out, disabled or of zero
// size. Also detects widgets with the same identity, of which Dear ImGui answers only the first.
#pragma once

#include <string>

#include "viewer/ui/widgets.h"

namespace pliant::ui {

// Why the pixel x, y of `place` is not visible; "": it is. In the last frame.
std::string why_unseen(const Place& place, float x, float y);
// Why a press there does not reach it: invisible, disabled, or behind an open menu or question; "": it does.
std::string why_unpressable(const Place& place, float x, float y);

// Of the frame drawn last: the addresses of two widgets with one identity; "": none.
std::string shared_identity();

// The first widget that overlaps another one, is covered, or is cut off without scrolling; "": none.
std::string not_apart();

// --- Keyboard navigation
// Focuses the next widget in drawing order, or with `back` the previous one. Text fields start editing.
void focus_next(bool back);
bool keyboard_has_focus();    // a widget is marked as the target of Space and Enter
bool keyboard_is_on_field();  // the marked widget is a text field
void lead_by_keyboard();      // marks the focused widget, as after keyboard navigation
bool popup_is_open();         // a menu, a list or a question

}  // namespace pliant::ui
