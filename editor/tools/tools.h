// Every tool of the viewport, each in a file of its own.
#pragma once

#include "editor/app/panel.h"

namespace pliant {

std::unique_ptr<ViewTool> make_select_tool();
std::unique_ptr<ViewTool> make_path_tool();

}  // namespace pliant
