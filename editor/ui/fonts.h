// Fonts of this machine: the interface's own, and others for the letters that it lacks (names of files and nodes may be
// in any script). A letter is looked for when a text with it is about to be drawn, and is there a frame later.
#pragma once

#include <string>
#include <string_view>

namespace pliant::ui {

// Makes the atlas anew, between two frames. A sentence where there is no font at all; else null.
const char* load_fonts(float scale);

// Letters of this text are drawn from the next frame on, where a font of this machine has them.
void draws(std::string_view text);
void draws(unsigned code_point);
bool fonts_lack_letters();  // load_fonts() would bring some
// Once for each script: which letters no font here has, and what to install; "": nothing new.
std::string take_undrawable();

}  // namespace pliant::ui
