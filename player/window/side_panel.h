// The panel at the right of a run's window (L): sliders of the level, what the mouse moves, force over depth, a path to
// record, levels to open. The window's thread keeps the state, the picture's thread draws it and returns orders.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pliant/slider.h"

namespace pliant {

struct PanelSlider {
  Slider of;
  double value = 0.0, authored = 0.0;  // in the key's unit
};

struct SidePanel {
  bool shown = false;
  std::vector<std::string> levels;  // files that it offers
  std::string level;                // the one that runs
  std::vector<PanelSlider> sliders;
  bool can_undo = false;
  std::vector<std::string> hands;    // probes and tools that the mouse can move
  std::optional<std::size_t> holds;  // into these
  std::optional<std::size_t> plots;  // into OverlayState::probes: force over depth
  std::optional<double> recording;   // [s] recorded so far
};

struct SliderOrder {
  std::size_t slider = 0;
  double value = 0.0;
  bool begins = false;  // the first of a gesture
};

// Commands from the panel.
struct PanelOrders {
  std::string open;  // a level; empty: none
  bool picture = false, record = false, undo = false, reset = false;
  std::optional<std::size_t> hold;  // into SidePanel::hands
  std::optional<SliderOrder> set;
};

}  // namespace pliant
