// pliant devices: what can move a probe: the built-in sources, and HID devices that we know by vendor and product.
#include <fmt/format.h>
#include <hidapi/hidapi.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "player/print.h"
#include "player/verbs/verbs.h"

namespace pliant {
namespace {

struct BuiltIn {
  const char* name;
  const char* what;
  const char* use;
};
constexpr BuiltIn kBuiltIn[] = {
    {"script", "follows a CSV of times and poses",
     "--probe NAME=script:FILE.csv (header time_s,x,y,z; metres, world frame)"},
    {"orbit", "approaches, presses, slides and leaves, by itself", "--probe NAME=orbit"},
    {"mouse", "moves in the plane of the picture", "in a window: `pliant run LEVEL --probe finger=mouse`"},
    {"null", "stays where the level put it", "\"driver\": \"null\" in the level's PLIANT_haptic_device"},
};

// USB vendor and product ids, from public lists.
struct Known {
  std::uint16_t vendor;
  std::vector<std::uint16_t> products;
  const char* driver;
  const char* what;
};
const std::vector<Known>& known_devices() {
  static const std::vector<Known> known{
      {0x046d,
       {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b},
       "spacemouse",
       "3Dconnexion six-axis mouse (senses; no force)"},
      {0x256f,
       {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636, 0xc638, 0xc63a},
       "spacemouse",
       "3Dconnexion six-axis mouse (senses; no force)"},
      {0x054c, {0x0ce6, 0x0df2}, "dualsense", "DualSense controller (trigger resistance, vibration)"},
      {0x054c, {0x05c4, 0x09cc}, "dualshock4", "DualShock 4 controller (vibration)"},
      {0x16c0, {0x0486}, "polhem", "Polhem / WoodenHaptics (three-axis force, six-axis sensing)"},
      {0x1532, {0x0300}, "hydra", "Razer Hydra (two six-axis trackers; no force)"},
      {0x0403, {0xcb48}, "falcon", "Novint Falcon (three-axis force)"},
  };
  return known;
}

struct Found {
  std::string id;  // for device:ID
  std::string driver, what, product;
  bool opens = false;  // may we open it?
};

std::string narrow(const wchar_t* text) {
  std::string ascii;
  for (; text && *text; ++text) ascii += (*text >= 0x20 && *text < 0x7f) ? static_cast<char>(*text) : '?';
  return ascii;
}

// One entry a device, though it may show several interfaces.
std::vector<Found> find_devices() {
  std::vector<Found> found;
  if (hid_init() != 0) return found;
  std::set<std::string> seen;
  hid_device_info* all = hid_enumerate(0, 0);
  for (const hid_device_info* info = all; info; info = info->next) {
    for (const Known& known : known_devices()) {
      if (info->vendor_id != known.vendor ||
          std::find(known.products.begin(), known.products.end(), info->product_id) == known.products.end())
        continue;
      Found device;
      device.id = fmt::format("{:04x}:{:04x}", info->vendor_id, info->product_id);
      if (const std::string serial = narrow(info->serial_number); !serial.empty()) device.id += ":" + serial;
      if (!seen.insert(device.id).second) continue;
      device.driver = known.driver;
      device.what = known.what;
      device.product = narrow(info->product_string);
      if (hid_device* handle = hid_open_path(info->path)) {
        device.opens = true;
        hid_close(handle);
      }
      found.push_back(std::move(device));
    }
  }
  hid_free_enumeration(all);
  hid_exit();
  return found;
}

std::string how_to_use(const Found& device) {
  std::string use = fmt::format("a driver `{}` for it is not yet built", device.driver);
  if (!device.opens)
    use += "; besides, it may not be opened: give your user access to its /dev/hidraw node (udev rule with uaccess)";
  return use;
}

}  // namespace

int devices(bool json) {
  const std::vector<Found> found = find_devices();
  if (json) {
    nlohmann::ordered_json out;
    out["built_in"] = nlohmann::ordered_json::array();
    for (const BuiltIn& source : kBuiltIn)
      out["built_in"].push_back({{"name", source.name}, {"what", source.what}, {"use", source.use}});
    out["found"] = nlohmann::ordered_json::array();
    for (const Found& device : found)
      out["found"].push_back({{"id", device.id},
                              {"driver", device.driver},
                              {"what", device.what},
                              {"product", device.product},
                              {"opens", device.opens},
                              {"use", how_to_use(device)}});
    print_json(out);
    return 0;
  }
  print("Built in:\n");
  for (const BuiltIn& source : kBuiltIn) print("  {:<8} {}\n           {}\n", source.name, source.what, source.use);
  print("\nFound on this machine:\n");
  if (found.empty())
    print("  no known haptic or pointing device (plugged in, switched on, passed through to this machine?)\n");
  for (const Found& device : found)
    print("  {} {}\n           {}\n           {}\n", device.id, device.product, device.what, how_to_use(device));
  return 0;
}

}  // namespace pliant
