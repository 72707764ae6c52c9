// Orders of a window's side panel: sliders, the probe that the mouse moves, a path to record.
#include <fmt/format.h>

#include "components/name_of.h"
#include "player/window/window_loop.h"
#include "runtime/printable.h"
#include "systems/device/hands.h"
#include "systems/device/mouse.h"

namespace pliant {

// Before the clocks start: whatever follows a press is prepared, because the touch clock owns the world then.
void WindowLoop::list_hands() {
  for (std::size_t i = 0; i < s_.journal.probes().size(); ++i) {
    const Entity hand = s_.journal.probes()[i], device = device_of(s_.world, hand);
    HapticDevice* const of = device == kNoEntity ? nullptr : s_.world.registry.find<HapticDevice>(device);
    if (!of || (s_.devices && s_.devices->moves(hand))) continue;
    Holdable it{i, device, {}, of->position};
    const Pose* const pose = s_.world.registry.find<Pose>(hand);
    if (pose && of->driver == DriverKind::kNull) it.at = of->position = pose->position, of->rotation = pose->rotation;
    if (const Probe* const probe = s_.world.registry.find<Probe>(hand))
      it.hand.take(Pointer(s_.world, probe->radius, camera_.viewpoint(), probe->meets));
    else
      it.hand.take(Carrier::waiting(s_.world, hand, device));
    if (of->driver == DriverKind::kMouse) state_.panel.holds = holdable_.size();
    state_.panel.hands.push_back(printable(s_.keeper.summaries()[i].name));
    holdable_.push_back(std::move(it));
  }
  if (!holdable_.empty() && !s_.world.mouse) add_mouse(s_.world, dvec3(0));
  if (state_.panel.holds) state_.panel.plots = holdable_[*state_.panel.holds].journal;
  if (!state_.panel.plots && !state_.probes.empty()) state_.panel.plots = 0;
}

void WindowLoop::list_sliders() {
  if (!s_.live) return;
  for (const Slider& each : s_.sliders)
    if (const auto value = s_.live->get(each.object, each.key))
      state_.panel.sliders.push_back({each, *value, *value});
    else
      say(value.error().message(), true);
}

// The mouse lets go of what it moves, and takes this one where it is.
void WindowLoop::hold(std::size_t which) {
  if (which >= holdable_.size() || state_.panel.holds == which) return;
  if (record_.on()) record();
  release();
  std::string words = "the mouse moves `" + state_.panel.hands[which] + "`";
  if (state_.panel.holds) words += "; nothing moves `" + state_.panel.hands[*state_.panel.holds] + "`";
  Holdable& it = holdable_[which];
  hand_ = it.hand;
  hand_.begin(it.at);
  taken_ = it.device;
  probe_at_ = tool_at_ = it.at;
  mouse_probe_ = hand_.has_probe() ? std::optional(it.journal) : std::nullopt;
  carried_ = hand_.has_tool() ? std::optional(it.journal) : std::nullopt;
  state_.panel.holds = which;
  state_.panel.plots = it.journal;
  say(words, false);
}

void WindowLoop::record() {
  if (!record_.on()) {
    if (state_.panel.holds) record_.begin(static_cast<std::uint32_t>(holdable_[*state_.panel.holds].journal));
    return;
  }
  const auto saved = record_.save(s_.out.path(), state_.panel.hands[*state_.panel.holds]);
  say(saved ? saved->string() : saved.error().message(), !saved);
}

void WindowLoop::set_slider(std::size_t which, double value) {
  if (which >= state_.panel.sliders.size() || !s_.live) return;
  PanelSlider& slider = state_.panel.sliders[which];
  if (slider.value == value) return;
  if (const Status set = s_.live->set(slider.of.object, slider.of.key, value); !set)
    say(set.error().message(), true);
  else
    slider.value = value;
}

void WindowLoop::undo_slider() {
  if (undo_.empty()) return;
  const auto values = std::move(undo_.back());
  undo_.pop_back();
  for (std::size_t i = 0; i < values.size(); ++i) set_slider(i, values[i]);
}

void WindowLoop::take(const PanelOrders& orders) {
  const auto remember = [&] {
    std::vector<double> values;
    for (const PanelSlider& each : state_.panel.sliders) values.push_back(each.value);
    if (undo_.empty() || undo_.back() != values) undo_.push_back(std::move(values));
  };
  if (!orders.open.empty()) open(orders.open);
  if (orders.picture) ++screenshots_;
  if (orders.hold) hold(*orders.hold);
  if (orders.record) record();
  if (orders.set) {
    if (orders.set->begins) remember();
    set_slider(orders.set->slider, orders.set->value);
  }
  if (orders.undo) undo_slider();
  if (orders.reset) {
    remember();
    for (std::size_t i = 0; i < state_.panel.sliders.size(); ++i) set_slider(i, state_.panel.sliders[i].authored);
  }
  state_.panel.can_undo = !undo_.empty();
}

}  // namespace pliant
