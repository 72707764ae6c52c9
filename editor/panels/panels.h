// All panels, each in its own file.
#pragma once

#include "editor/core/panel.h"

namespace pliant {

std::unique_ptr<Panel> make_tree_panel();
std::unique_ptr<Panel> make_inspector_panel(App& app);
std::unique_ptr<Panel> make_soft_panel(App& app);
std::unique_ptr<Panel> make_path_panel(App& app);
std::unique_ptr<Panel> make_paint_panel(App& app);
std::unique_ptr<Panel> make_history_panel();
std::unique_ptr<Panel> make_findings_panel();
std::unique_ptr<Panel> make_console_panel(App& app);
std::unique_ptr<Panel> make_file_browser(App& app);
std::unique_ptr<Panel> make_keys_page(App& app);
std::unique_ptr<Panel> make_settings_panel(App& app);
std::unique_ptr<Panel> make_picture_panel(App& app);
std::unique_ptr<Panel> make_unit_banner();
std::unique_ptr<Panel> make_start_page(App& app);
std::unique_ptr<Panel> make_play_panel(App& app);
std::unique_ptr<Panel> make_plots_panel(App& app);
std::unique_ptr<Panel> make_device_panel(App& app);
std::unique_ptr<Panel> make_error_budget_panel();

}  // namespace pliant
