// A row of a panel's properties.
#pragma once

#include <string>

namespace pliant {

inline constexpr float kLabelShare = 0.42f;  // [1] of the panel's width

// Label at the left; the field follows at the right. True while the label's mark for "back to the default" is pressed.
bool property_row(const char* label, const char* hint_text, bool differs, float share = kLabelShare);

// Whether a search for `what` finds the text, in either letter case. Empty: everything.
bool matches(const std::string& what, const std::string& text);

}  // namespace pliant
