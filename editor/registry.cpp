// Lists every panel, tool and action of the editor. To add one, add a line here.
#include <algorithm>
#include <cctype>
#include <numbers>

#include "editor/app/add.h"
#include "editor/app/app.h"
#include "editor/app/files.h"
#include "editor/core/painting.h"
#include "editor/panels/panels.h"
#include "editor/tools/tools.h"
#include "viewer/window/keys.h"

namespace pliant {

std::vector<std::unique_ptr<Panel>> make_panels(App& app) {
  std::vector<std::unique_ptr<Panel>> panels;
  panels.push_back(make_tree_panel());
  panels.push_back(make_inspector_panel(app));
  panels.push_back(make_play_panel(app));
  panels.push_back(make_device_panel(app));
  panels.push_back(make_soft_panel(app));
  panels.push_back(make_path_panel(app));
  panels.push_back(make_paint_panel(app));
  panels.push_back(make_history_panel());
  panels.push_back(make_findings_panel());
  panels.push_back(make_console_panel(app));
  panels.push_back(make_unit_banner());
  panels.push_back(make_file_browser(app));
  panels.push_back(make_keys_page(app));
  panels.push_back(make_settings_panel(app));
  panels.push_back(make_picture_panel(app));
  panels.push_back(make_start_page(app));
  panels.push_back(make_plots_panel(app));
  panels.push_back(make_error_budget_panel());
  return panels;
}

std::vector<std::unique_ptr<ViewTool>> make_tools(App& app) {
  std::vector<std::unique_ptr<ViewTool>> tools;
  tools.push_back(make_select_tool());
  tools.push_back(make_move_tool(app.settings));
  tools.push_back(make_turn_tool(app.settings));
  tools.push_back(make_scale_tool(app.settings));
  tools.push_back(make_path_tool());
  tools.push_back(make_paint_tool());
  return tools;
}

std::vector<Action> make_actions(App& app) {
  constexpr double kRight = std::numbers::pi / 2;
  const auto something = [](const Editor& e) { return !e.selected.empty(); };
  const auto look = [](double azimuth, double elevation) {
    return [=](Editor& e) { e.camera.look_from(azimuth, elevation); };
  };
  std::vector<Action> all;
  const auto add = [&](Action action) { all.push_back(std::move(action)); };
  // An action that the window of a run has too.
  const auto shared = [&](const char* id, const char* group, std::function<void(Editor&)> run,
                          std::function<bool(const Editor&)> enabled = {}) {
    if (!enabled) enabled = [](const Editor&) { return true; };
    all.push_back({id, group, key_row(id).label, key_row(id).editor, std::move(run), std::move(enabled)});
  };
  const auto toggle = [&](const char* id, const char* label, const char* keys, bool ViewSettings::*of) {
    all.push_back({id, "View", label, keys, [of](Editor& e) { e.view.*of = !(e.view.*of); },
                   [](const Editor&) { return true; }, [of](const Editor& e) { return e.view.*of; }});
  };
  add({"file.new", "File", "New", "Ctrl+N", [&app](Editor&) { app.new_document(); }});
  add({"file.open", "File", "Open\u2026", "Ctrl+O", [&app](Editor&) { app.files().ask_open(); }});
  add({"file.save", "File", "Save", "Ctrl+S", [&app](Editor&) { app.save(); }});
  all.back().while_typing = true;
  all.back().separator = true;
  add({"file.save_as", "File", "Save as\u2026", "Ctrl+Shift+S", [&app](Editor&) { app.files().save_as(); }});
  add({"file.save_copy", "File", "Save a copy\u2026", "", [&app](Editor&) { app.files().save_copy(); }});
  add({"file.revert", "File", "Revert", "", [&app](Editor&) { app.files().revert(); },
       [](const Editor& e) { return e.document.dirty() && !e.document.file().empty(); }});
  add({"file.picture", "File", "Save picture or film\u2026", "F12", [&app](Editor&) { app.show_panel("Picture"); },
       [](const Editor& e) { return !e.state().nodes.empty(); }});
  all.back().separator = true;
  add({"file.settings", "File", "Settings\u2026", "Ctrl+,", [&app](Editor&) { app.show_panel("Settings"); }});
  all.back().separator = true;
  add({"file.quit", "File", "Quit", "Ctrl+Q", [&app](Editor&) { app.close(); }});
  all.back().while_typing = true;
  all.back().separator = true;

  add({"edit.undo", "Edit", "Undo", "Ctrl+Z", [](Editor& e) { e.undo(); },
       [](const Editor& e) { return e.document.can_undo(); }});
  add({"edit.redo", "Edit", "Redo", "Ctrl+Shift+Z", [](Editor& e) { e.redo(); },
       [](const Editor& e) { return e.document.can_redo(); }});
  add({"edit.cut", "Edit", "Cut", "Ctrl+X", [](Editor& e) { e.cut(); }, something});
  all.back().separator = true;
  add({"edit.copy", "Edit", "Copy", "Ctrl+C", [](Editor& e) { e.copy(); }, something});
  add({"edit.paste", "Edit", "Paste", "Ctrl+V", [](Editor& e) { e.paste(); },
       [](const Editor& e) { return !e.copied.empty(); }});
  add({"edit.duplicate", "Edit", "Duplicate", "Ctrl+D",
       [](Editor& e) {
         std::vector<NodeId> ids;
         if (e.apply("Duplicate", duplicated(e.state(), e.selected, e.document.next_id(), &ids))) e.selected = ids;
       },
       something});
  add({"edit.delete", "Edit", "Delete", "Delete", [](Editor& e) { e.apply("Delete", without(e.state(), e.selected)); },
       something});
  add({"edit.rename", "Edit", "Rename", "F2", [](Editor& e) { e.renaming = e.active(); }, something});
  add({"edit.all", "Edit", "Select all", "Ctrl+A", [](Editor& e) {
         e.selected.clear();
         for (const auto& each : e.state().nodes) e.selected.push_back(each->id);
       }});
  all.back().separator = true;

  const auto take = [&](const char* id, const char* label, const char* keys, const char* tool) {
    add({id, "Edit", label, keys, [&app, tool](Editor&) { app.take_tool(tool); }, [](const Editor&) { return true; },
         [tool](const Editor& e) { return e.tool == tool; }});
  };
  take("tool.select", "Select with the mouse", "Q", "Select");
  all.back().separator = true;
  take("tool.move", "Move", "M", "Move");
  take("tool.turn", "Turn", "T", "Turn");
  take("tool.scale", "Scale", "S", "Scale");

  shared("view.frame", "View", [](Editor& e) { e.frame_selected(); });
  shared("view.home", "View", [](Editor& e) { e.camera.frame(e.scene_box()); });
  shared("view.front", "View", look(0, 0));
  all.back().separator = true;
  shared("view.right", "View", look(kRight, 0));
  add({"view.left", "View", "From the left", "Ctrl+3", look(-kRight, 0)});
  shared("view.top", "View", look(0, kRight));
  add({"view.bottom", "View", "From below", "Ctrl+7", look(0, -kRight)});
  add({"view.back", "View", "From behind", "9", look(2 * kRight, 0)});
  toggle("view.orthographic", "Orthographic", "5", &ViewSettings::orthographic);
  toggle("view.grid", "Grid", "G", &ViewSettings::grid);
  all.back().separator = true;
  toggle("view.wireframe", key_row("view.wireframe").label, key_row("view.wireframe").editor, &ViewSettings::wireframe);
  toggle("view.normals", "Normals", "N", &ViewSettings::normals);
  add({"view.isolate", "View", "Isolate selected", "I",
       [](Editor& e) { e.view.isolated = e.view.isolated.empty() ? e.selected : std::vector<NodeId>{}; },
       [](const Editor&) { return true; }, [](const Editor& e) { return !e.view.isolated.empty(); }});

  const auto meshed = [](const Editor& e) { return e.painting->node() != kNoNode; };
  add({"paint.tool", "Paint", "Paint", "P",
       [&app](Editor& e) {
         app.take_tool(e.tool == "Paint" ? "Select" : "Paint");
         app.show_panel(e.tool == "Paint" ? "Paint" : "Inspector");
       },
       meshed, [](const Editor& e) { return e.tool == "Paint"; }});
  const auto step = [&](const char* id, const char* label, const char* keys, void (*run)(Painting&)) {
    add({id, "Paint", label, keys, [run](Editor& e) { run(*e.painting); }, meshed});
    all.back().repeats = true;
  };
  step("paint.larger", "Larger brush", "]", [](Painting& p) { p.scale_radius(1.15); });
  all.back().separator = true;
  step("paint.smaller", "Smaller brush", "[", [](Painting& p) { p.scale_radius(1 / 1.15); });
  step("paint.stronger", "Stronger", "Shift+]", [](Painting& p) { p.add_strength(0.05); });
  step("paint.weaker", "Weaker", "Shift+[", [](Painting& p) { p.add_strength(-0.05); });
  add({"paint.refine", "Paint", "Refine under the brush", "Shift+R",
       [](Editor& e) {
         if (const auto& at = e.painting->hover) e.painting->refine(at->hit);
       },
       [](const Editor& e) {
         const auto& at = e.painting->hover;
         return at && at->node == e.painting->node() && at->surface == e.painting->surface();
       }});
  all.back().separator = true;
  add({"paint.fill", "Paint", "Fill all", "", [](Editor& e) { e.painting->fill_all(); }, meshed});
  add({"paint.clear", "Paint", "Clear", "", [](Editor& e) { e.painting->clear(); }, meshed});
  const auto plays = [&app](const Editor&) { return app.play().on(); };
  const auto stands = [&app](const Editor&) { return app.play().may_step(); };
  shared(
      "play.toggle", "Play", [&app](Editor&) { app.toggle_play(); },
      [](const Editor& e) { return !e.state().nodes.empty(); });
  add({"play.stop", "Play", "Stop", "Shift+Space", [&app](Editor&) { app.play().stop(); }, plays});
  shared(
      "play.restart", "Play", [&app](Editor&) { app.play().restart(); }, plays);
  add({"play.step", "Play", "Step 1/60 s", ".", [&app](Editor&) { app.step_play(1.0 / 60.0); }, stands});
  all.back().separator = true;
  add({"play.tick", "Play", "Step a tick", "Shift+.", [&app](Editor&) { app.step_play(0.0); }, stands});
  shared(
      kStopAction, "Play",
      [&app](Editor&) {
        DeviceOrders orders;
        orders.stop_all = true;
        app.play().order(orders);
        if (!app.play().status().devices.devices.empty()) app.show_panel("Devices");
      },
      plays);
  all.back().while_typing = all.back().always = true;
  toggle("play.forces", key_row("play.forces").label, key_row("play.forces").editor, &ViewSettings::forces);
  all.back().group = "Play";
  all.back().separator = true;
  toggle("play.contacts", key_row("play.contacts").label, key_row("play.contacts").editor, &ViewSettings::contacts);
  all.back().group = "Play";
  add({"add.file", "Add", "Mesh from file\u2026", "", [&app](Editor&) { app.files().ask_add(); }});
  const auto word = [](std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return name;
  };
  for (const SimpleShape& shape : shapes())
    add({std::string("add.") + shape.word, "Add", word(shape.word), "", [&shape](Editor& e) { add_shape(e, shape); }});
  for (const Instrument& instrument : instruments()) {
    add({std::string("add.") + instrument.word, "Add", word(instrument.word), "",
         [&instrument](Editor& e) { add_instrument(e, instrument); },
         [](const Editor& e) { return touched_object(e) != nullptr; }});
    all.back().separator = &instrument == instruments().data();
  }
  add({"add.empty", "Add", "Empty node", "", [](Editor& e) { add_empty(e); }});
  all.back().separator = true;
  add({"add.probe", "Add", "Probe with a device", "", [](Editor& e) { add_probe(e); }});
  add({"add.effect", "Add", "Effect on probes", "", [](Editor& e) { add_effect(e); }});
  add({"add.light", "Add", "Light", "", [](Editor& e) { add_light(e); }});
  add({"add.camera", "Add", "Camera, from here", "", [](Editor& e) { add_camera(e); }});
  shared("help.keys", "Help", [&app](Editor&) { app.show_panel("Keys"); });
  all.back().while_typing = true;
  return all;
}

}  // namespace pliant
