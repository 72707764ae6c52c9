// Actions of the menu Add; the added node becomes selected.
#pragma once

#include "editor/core/editor.h"

namespace pliant {

void add_empty(Editor& editor);
void add_probe(Editor& editor);   // above the selected object, or above all; moved by the mouse
void add_effect(Editor& editor);  // around the middle of the selected object, or of all
void add_light(Editor& editor);
void add_camera(Editor& editor);  // with the viewport's current view

}  // namespace pliant
