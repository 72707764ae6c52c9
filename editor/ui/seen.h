// Whether a hand can press what a widget's address names: what is covered, clipped, scrolled out, switched off or of no
// size cannot be pressed. Also: widgets that share one identity, of which Dear ImGui answers only the first.
#pragma once

#include <string>

#include "editor/ui/widgets.h"

namespace pliant::ui {

// Why the pixel x, y of `place` is not seen; "": it is. Of the frame drawn last.
std::string why_unseen(const Place& place, float x, float y);
// Why pressing there does not reach it: what is unseen, off, or behind an open menu or question; "": it does.
std::string why_unpressable(const Place& place, float x, float y);

// Of the frame drawn last: the addresses of two widgets with one identity; "": none.
std::string shared_identity();

// The first widget that overlaps another one, is covered, or is cut off where nothing scrolls; "": all are apart.
std::string not_apart();

// --- The keyboard's way through the widgets
// The next one in the order in which they are drawn, `back`: the one before. Fields begin to be typed into.
void focus_next(bool back);
bool keyboard_leads();        // a widget is marked as the one that Space and Enter press
bool keyboard_is_on_field();  // that it would type into
void lead_by_keyboard();      // the one that has the focus is marked, as if a key had led there
bool popup_is_open();         // a menu, a list or a question

}  // namespace pliant::ui
