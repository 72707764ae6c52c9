// Interfaces of panels, viewport tools and actions. Each is one file and one line in registry.cpp.
#pragma once

#include <imgui.h>

#include <memory>
#include <string>
#include <vector>

#include "editor/core/editor.h"

namespace pliant {

class Panel {
 public:
  enum class Place : std::uint8_t {
    kLeft,    // stacked at the left
    kRight,   // a tab at the right
    kBottom,  // a tab below the viewport
    kOver,    // draws its own window when opened (a dialog)
    kBanner,  // a line at the upper edge of the viewport, while it is shown()
  };
  virtual ~Panel() = default;
  virtual const char* name() const = 0;  // on its tab, and first part of its widgets' addresses
  virtual Place place() const = 0;
  virtual bool shown(const Editor&) const { return true; }
  virtual std::string badge(const Editor&) const { return {}; }  // after the name: a count, for instance
  virtual void draw(Editor& editor) = 0;                         // within its child window; kOver: anything
};

// Mouse input of the viewport in a frame.
struct ViewportInput {
  double x = 0, y = 0;                                   // [pixel] of the viewport, from its upper left corner
  double dx = 0, dy = 0;                                 // since the last frame
  int width = 1, height = 1;                             // [pixel]
  ImVec2 corner{0, 0};                                   // [pixel] of the window
  bool over = false;                                     // the mouse is over it, and no other widget uses it
  bool pressed = false, held = false, released = false;  // the left button, of a press that began over the viewport
  bool shift = false, control = false, alt = false;
  double pressure = 1.0;  // [1] of a tablet's pen; 1 for a mouse
  Viewpoint view;
  double orthographic = 0.0;                          // [m] height; 0: perspective
  NodeId under = kNoNode;                             // the picked node under the mouse, as last known
  dvec3 under_at{0};                                  // [m] world
  double dt = 0.0;                                    // [s]
  std::string typed;                                  // text typed while no field has focus
  bool enter = false, escape = false, erase = false;  // keys under the same condition
  ViewRay ray() const { return view_ray(view, orthographic, x, y, width, height); }
};

class ViewTool {
 public:
  virtual ~ViewTool() = default;
  virtual const char* name() const = 0;  // on its button
  virtual const char* sign() const = 0;  // a short label for narrow toolbars
  virtual const char* hint() const = 0;  // its effect, and its keys
  virtual bool usable(const Editor&) const { return true; }
  // True: the input was handled (not passed to selection and camera).
  virtual bool use(Editor& editor, const ViewportInput& input) = 0;
  // Draws over the picture, in window pixels.
  virtual void overlay(Editor&, const ViewportInput&, ImDrawList&) {}
  // Lines in the world, for the next picture.
  virtual void lines(const Editor&, std::vector<struct ViewLine>&) const {}
  virtual void leave(Editor&) {}  // another tool is activated
  // Its options, as a row of widgets at the viewport's upper left.
  virtual bool has_options() const { return false; }
  virtual void options(Editor&) {}
  // The tool takes keyboard input: actions' keys are disabled, and its gesture continues without the mouse.
  virtual bool wants_keys() const { return false; }
};

// A command, available by menu, key or button.
struct Action {
  std::string id;     // "file.save"
  std::string group;  // its menu: "File"
  std::string label;  // "Save"
  std::string keys;   // "Ctrl+S" by default; rebindable
  std::function<void(Editor&)> run;
  std::function<bool(const Editor&)> enabled = [](const Editor&) { return true; };
  std::function<bool(const Editor&)> checked = nullptr;  // for switches: whether it is on
  bool separator = false;                                // a line above it in the menu
  bool while_typing = false;                             // its keys also work in text fields
  bool always = false;                                   // and under dialogs and questions
  bool repeats = false;                                  // a held key repeats it
};

class App;
std::vector<std::unique_ptr<Panel>> make_panels(App& app);
std::vector<std::unique_ptr<ViewTool>> make_tools(App& app);
std::vector<Action> make_actions(App& app);

}  // namespace pliant
