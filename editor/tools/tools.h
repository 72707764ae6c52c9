// All tools of the viewport, each in its own file.
#pragma once

#include "editor/core/panel.h"

namespace pliant {

struct Settings;

std::unique_ptr<ViewTool> make_select_tool();
std::unique_ptr<ViewTool> make_path_tool();
std::unique_ptr<ViewTool> make_move_tool(Settings& settings);
std::unique_ptr<ViewTool> make_turn_tool(Settings& settings);
std::unique_ptr<ViewTool> make_scale_tool(Settings& settings);
std::unique_ptr<ViewTool> make_paint_tool();

}  // namespace pliant
