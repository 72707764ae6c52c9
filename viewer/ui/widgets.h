// Dear ImGui's widgets with uniform spacing and tooltips. Each one is identified by its label, so that scripts can
// press it.
//
// A widget's address is "SCOPE/LABEL", "Inspector/stiffness". Text after ## in a label is not shown, and is part of its
// address.
#pragma once

#include <imgui.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/ui/theme.h"

namespace pliant::ui {

// Position of a widget in the last frame.
struct Place {
  std::string address;
  ImVec2 low{0, 0}, high{0, 0};            // [pixel]
  ImVec2 seen_low{0, 0}, seen_high{0, 0};  // the visible part
  bool enabled = true;
  ImGuiID window = 0, id = 0;   // 0: custom drawing
  bool takes_text = false;      // a field that can be typed into
  bool through_popups = false;  // usable while a menu is open
};
// Names the widgets drawn during its lifetime, and separates their identities from equal labels in other scopes. It
// must end in the same window.
class Scope {
 public:
  explicit Scope(std::string name);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};
void keep_in_front();                                            // the current window, but below menus
void end_widgets();                                              // of a frame
void known_as(std::string_view label);                           // the item that was drawn last
void known_at(std::string_view label, ImVec2 low, ImVec2 high);  // for custom drawing
void answers_through_popups();                                   // for the last named widget
void underline_item();                                           // with the accent colour: marks the open one
// By address, or by label if unique.
std::optional<Place> find_widget(std::string_view address);
std::vector<std::string> widget_addresses();
const std::vector<Place>& widgets();  // of the last frame

// Tooltip; for a disabled widget, the reason.
void hint(const char* text);
bool button(const char* label, const char* hint_text = nullptr, bool enabled = true, float width = 0);
bool strong_button(const char* label, const char* hint_text = nullptr, bool enabled = true, float width = 0);
// One of a row of exclusive buttons.
bool choice_button(const char* label, bool down, const char* hint_text = nullptr, bool enabled = true);
enum class Icon : std::uint8_t { kPlay, kPause, kStep, kStop, kRestart };
bool icon_button(const char* label, Icon icon, bool down, const char* hint_text = nullptr, bool enabled = true);
bool checkbox(const char* label, bool& value, const char* hint_text = nullptr);
bool text_field(const char* label, std::string& value, const char* placeholder = "", float width = 0,
                ImGuiInputTextFlags flags = 0);
// Dragged sideways, or typed after a double click, with units and arithmetic (viewer/ui/quantity.h). Invalid or
// out-of-range text changes nothing. `unit` is shown; after # it is only understood ("#m"). Steps are proportional to
// the value; `logarithmic` for stiffnesses and similar. True while it changes; `finished` at the end of a gesture.
bool number(const char* label, double& value, double least, double most, const char* unit, bool logarithmic = false,
            float width = 0, bool* finished = nullptr);
void zero_reads(std::string text);                  // how the next number shows 0, "automatic: 12 mm"
std::optional<std::string> take_refused();          // why a number's text was rejected, once
bool color_field(const char* label, float rgb[3]);  // linear, a swatch and three numbers
// A bar dragged along its whole width.
bool slider(const char* label, double& value, double least, double most, const char* hint_text = nullptr,
            float width = 0);
bool combo(const char* label, std::string& value, const std::vector<std::string>& choices, float width = 0);
bool selectable(const char* label, bool selected, ImGuiSelectableFlags flags = 0, ImVec2 size = {0, 0});
bool menu_item(const char* label, const char* shortcut = nullptr, bool checked = false, bool enabled = true);
bool begin_menu(const char* label, bool enabled = true);
bool section(const char* label, bool open_at_first = true);  // a foldable header
// Where sections that were opened or closed are kept, by address; null: nowhere. It must outlive the widgets.
void remember_sections(std::map<std::string, bool>* opened);
void label(const char* text, const char* hint_text = nullptr);
void dim(const char* text);  // wrapped, in a subdued colour
void title(const char* text);
// As much of a text as a box of `wide` by `high` pixels holds, wrapped; an ellipsis stands for the rest.
std::string fitted(const std::string& text, const ImFont& font, float wide, float high);
void gap(float points = kSpace);
// Places the next widget, with this label, beside the last one, or below if there is no space up to rows_end_at().
void beside(float gap_points, const char* next, float more_points = 0);
void rows_end_at(float x);  // [pixel]; 0: unlimited

}  // namespace pliant::ui
