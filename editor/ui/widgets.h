// Dear ImGui's widgets as the editor uses them: the same spaces everywhere, a tooltip for everything, and each one
// known by its label, so that a script of events can press what a hand presses.
//
// A widget's address is "SCOPE/LABEL", "Inspector/stiffness". What stands behind ## in a label is not shown, and is
// part of its address.
#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "editor/ui/theme.h"

namespace pliant::ui {

// Where a widget was in the frame before.
struct Place {
  std::string address;
  ImVec2 low{0, 0}, high{0, 0};            // [pixel]
  ImVec2 seen_low{0, 0}, seen_high{0, 0};  // what its panel shows of it
  bool enabled = true;
  ImGuiID window = 0, id = 0;   // 0: drawn by hand
  bool takes_text = false;      // a field that can be typed into
  bool through_popups = false;  // answers though a menu is open
};
// Names what is drawn while it lives, and gives it identities of its own: widgets of one label in two scopes are two.
// It ends in the window that it began in.
class Scope {
 public:
  explicit Scope(std::string name);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};
void keep_in_front();                                            // the window that is drawn, but for menus
void end_widgets();                                              // of a frame
void known_as(std::string_view label);                           // the item that was drawn last
void known_at(std::string_view label, ImVec2 low, ImVec2 high);  // something that is drawn by hand
void answers_through_popups();                                   // the one that was named last
void underline_item();                                           // the same, in the accent: it is the open one
// By its address, or by its label where only one has it.
std::optional<Place> find_widget(std::string_view address);
std::vector<std::string> widget_addresses();
const std::vector<Place>& widgets();  // of the frame before

// `hint` is what a tooltip says; where the widget is off, why.
void hint(const char* text);
bool button(const char* label, const char* hint_text = nullptr, bool enabled = true, float width = 0);
bool strong_button(const char* label, const char* hint_text = nullptr, bool enabled = true, float width = 0);
// One of a row of which one is down.
bool choice_button(const char* label, bool down, const char* hint_text = nullptr, bool enabled = true);
enum class Icon : std::uint8_t { kPlay, kPause, kStep, kStop, kRestart };
bool icon_button(const char* label, Icon icon, bool down, const char* hint_text = nullptr, bool enabled = true);
bool checkbox(const char* label, bool& value, const char* hint_text = nullptr);
bool text_field(const char* label, std::string& value, const char* placeholder = "", float width = 0,
                ImGuiInputTextFlags flags = 0);
// Dragged sideways, or typed with a double click: with a unit, as a sum (editor/ui/quantity.h); what cannot be read, or
// is out of range, changes nothing. `unit` is shown; behind # it is only understood ("#m"). Steps follow the size of
// the value; `logarithmic` for stiffnesses and the like. True while it changes; `finished` when a gesture has ended.
bool number(const char* label, double& value, double least, double most, const char* unit, bool logarithmic = false,
            float width = 0, bool* finished = nullptr);
std::optional<std::string> take_refused();          // why the text of a number was refused, once
bool color_field(const char* label, float rgb[3]);  // linear, a swatch and three numbers
// Between two ends, dragged along its whole width.
bool slider(const char* label, double& value, double least, double most, const char* hint_text = nullptr,
            float width = 0);
bool combo(const char* label, std::string& value, const std::vector<std::string>& choices, float width = 0);
bool selectable(const char* label, bool selected, ImGuiSelectableFlags flags = 0, ImVec2 size = {0, 0});
bool menu_item(const char* label, const char* shortcut = nullptr, bool checked = false, bool enabled = true);
bool begin_menu(const char* label, bool enabled = true);
bool section(const char* label, bool open_at_first = true);  // a header that folds
void label(const char* text, const char* hint_text = nullptr);
void dim(const char* text);  // wrapped, in the colour of what matters less
void title(const char* text);
// As much of a text as a box of `wide` by `high` pixels holds, wrapped; an ellipsis stands for the rest.
std::string fitted(const std::string& text, const ImFont& font, float wide, float high);
void gap(float points = kSpace);
// The next widget, labelled so, stands beside the last one, or below where there is no room up to rows_end_at().
void beside(float gap_points, const char* next, float more_points = 0);
void rows_end_at(float x);  // [pixel]; 0: nowhere

}  // namespace pliant::ui
