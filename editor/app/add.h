// What the menu Add adds to the level; each is selected afterwards.
#pragma once

#include "editor/app/editor.h"

namespace pliant {

void add_empty(Editor& editor);
void add_probe(Editor& editor);  // above what is selected, or above all; the mouse moves it
void add_light(Editor& editor);
void add_camera(Editor& editor);  // sees what the viewport shows

}  // namespace pliant
