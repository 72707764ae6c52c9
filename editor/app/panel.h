// A panel, a tool of the viewport, an action: each is one file and one line in app/registry.cpp.
#pragma once

#include <imgui.h>

#include <memory>
#include <string>
#include <vector>

#include "editor/app/editor.h"

namespace pliant {

class Panel {
 public:
  enum class Place : std::uint8_t {
    kLeft,    // stacked at the left
    kRight,   // a tab at the right
    kBottom,  // a tab below the viewport
    kOver,    // draws its own window, when it is asked for (a dialog)
    kBanner,  // a line over the upper edge of the viewport, while it is shown()
  };
  virtual ~Panel() = default;
  virtual const char* name() const = 0;  // on its tab, and first in its widgets' addresses
  virtual Place place() const = 0;
  virtual bool shown(const Editor&) const { return true; }
  virtual std::string badge(const Editor&) const { return {}; }  // after the name: a count, say
  virtual void draw(Editor& editor) = 0;                         // within its child window; kOver: anything
};

// What the mouse does over the viewport, in a frame.
struct ViewportInput {
  double x = 0, y = 0;                                   // [pixel] of the viewport, from its upper left corner
  double dx = 0, dy = 0;                                 // since the frame before
  int width = 1, height = 1;                             // [pixel]
  ImVec2 corner{0, 0};                                   // [pixel] of the window
  bool over = false;                                     // the mouse is over it, and nothing else has it
  bool pressed = false, held = false, released = false;  // the left button, of a press that began over the viewport
  bool shift = false, control = false, alt = false;
  double pressure = 1.0;  // [1] of a tablet's pen; 1 of a mouse
  Viewpoint view;
  double orthographic = 0.0;                          // [m] height; 0: perspective
  NodeId under = kNoNode;                             // what the picture shows under the mouse, as known last
  dvec3 under_at{0};                                  // [m] world
  double dt = 0.0;                                    // [s]
  std::string typed;                                  // what was typed while no field had the keys
  bool enter = false, escape = false, erase = false;  // keys of the same
  ViewRay ray() const { return view_ray(view, orthographic, x, y, width, height); }
};

class ViewTool {
 public:
  virtual ~ViewTool() = default;
  virtual const char* name() const = 0;  // on its button
  virtual const char* sign() const = 0;  // a letter or sign, where there is little room
  virtual const char* hint() const = 0;  // what it does, and its keys
  virtual bool usable(const Editor&) const { return true; }
  // True: what the hand does is taken (selecting and the camera leave it alone).
  virtual bool use(Editor& editor, const ViewportInput& input) = 0;
  // Over the picture, in pixels of the window.
  virtual void overlay(Editor&, const ViewportInput&, ImDrawList&) {}
  // Lines in the world, for the next picture.
  virtual void lines(const Editor&, std::vector<struct ViewLine>&) const {}
  virtual void leave(Editor&) {}  // another tool is taken
  // What can be set about it, as widgets in a row, in a strip at the viewport's upper left.
  virtual bool has_options() const { return false; }
  virtual void options(Editor&) {}
  // What is typed is its own now: no action's keys count, and its gesture goes on without the mouse.
  virtual bool wants_keys() const { return false; }
};

// Something that can be done, by a menu, a key or a button.
struct Action {
  std::string id;     // "file.save"
  std::string group;  // its menu: "File"
  std::string label;  // "Save"
  std::string keys;   // "Ctrl+S" by default; rebindable
  std::function<void(Editor&)> run;
  std::function<bool(const Editor&)> enabled = [](const Editor&) { return true; };
  std::function<bool(const Editor&)> checked = nullptr;  // a switch: whether it is on
  bool separator = false;                                // a line above it in the menu
  bool while_typing = false;                             // its keys count in text fields, too
  bool always = false;                                   // and under dialogs and questions
  bool repeats = false;                                  // its key that is held goes on doing it
};

class App;
std::vector<std::unique_ptr<Panel>> make_panels(App& app);
std::vector<std::unique_ptr<ViewTool>> make_tools(App& app);
std::vector<Action> make_actions(App& app);

}  // namespace pliant
