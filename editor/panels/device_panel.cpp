// The devices of the played level (ui/device_list.h); before playing, the available devices and what is missing.
#include "devices/choose.h"
#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/device_list.h"
#include "viewer/ui/widgets.h"
#include "viewer/window/keys.h"

namespace pliant {
namespace {

class DevicePanel : public Panel {
 public:
  explicit DevicePanel(App& app) : app_(app) {}
  const char* name() const override { return "Devices"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    Play& play = app_.play();
    if (play.on()) {
      DevicesView view = play.status().devices;
      for (const PlayEffector& each : play.status().effectors) {
        const auto is_moved = [&](const DeviceView& device) { return device.effector == each.name; };
        if (std::none_of(view.devices.begin(), view.devices.end(), is_moved))
          view.others.push_back({each.name, each.source});
      }
      view.unusable.clear();  // below, as they are now
      DeviceOrders orders;
      ui::device_list(view, app_.keys_of(kStopAction), orders);
      play.order(orders);
      ui::gap(ui::kGap);
    }
    if (!editor.devices_looked_for) editor.look_for_devices();
    const bool looks = editor.jobs.running(Editor::kDeviceJob);
    if (ui::section(play.on() ? "On this machine" : "Devices on this machine", !play.on())) {
      if (editor.devices.empty()) ui::dim(looks ? "Looking \u2026" : "None is there: plugged in, switched on?");
      for (const DeviceInfo& device : editor.devices) {
        ImGui::TextUnformatted(printable(device.name).c_str());
        ImGui::PushFont(ui::font(ui::Type::kSmall));
        ui::dim(printable(full_id(device)).c_str());
        if (!device.missing.empty()) {
          ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().warning);
          ImGui::TextWrapped("Not usable yet: %s", printable(device.missing).c_str());
          ImGui::PopStyleColor();
        }
        ImGui::PopFont();
        ui::gap(2);
      }
      if (ui::button("Look again", "What is plugged in now, and what is missing to use it", !looks))
        editor.look_for_devices();
      if (!play.on())
        ui::dim("Play's tab says what moves each probe; a level says it by a device node with the driver `external`.");
    }
  }

 private:
  App& app_;
};

}  // namespace

std::unique_ptr<Panel> make_device_panel(App& app) {
  return std::make_unique<DevicePanel>(app);
}

}  // namespace pliant
