// The interface's fonts, and fallback fonts of this machine for other letters (names of files and nodes may be in any
// script). A missing letter is looked up when a text with it is drawn, and appears a frame later.
#pragma once

#include <string>
#include <string_view>

namespace pliant::ui {

// Rebuilds the atlas, between two frames. Returns a sentence if there is no font at all; else null.
const char* load_fonts(float scale);

// Requests the letters of this text from the next frame on, if a font of this machine has them.
void draws(std::string_view text);
void draws(unsigned code_point);
bool fonts_lack_letters();  // load_fonts() would add some
// Once per script: the letters without a font, and what to install; "": nothing new.
std::string take_undrawable();

}  // namespace pliant::ui
