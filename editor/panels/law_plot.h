// Force over depth of a played run, with the author's law.
#pragma once

#include <string>

#include "editor/play/play.h"
#include "viewer/ui/widgets.h"

namespace pliant {

// `before`: the same probe in the run before, or null. `object`: the last touched one; its law is drawn.
void draw_law_plot(const Play& play, const PlayTrace& trace, const PlayTrace* before, std::string& object, ImVec2 size);

}  // namespace pliant
