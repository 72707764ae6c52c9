// The devices that a level may request. A level is untrusted, so PLIANT_haptic_device/id may name kinds of devices
// only. Addresses, ports, serial lines, files, and wrappers that use files need the user's consent (`--probe`, or an
// answer to a question). `run`, the window, the editor, `validate` and `inspect` all use this decision.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct DeviceRequest {
  std::string allowed;               // the alternatives that a level may request, as they are opened; "": none
  std::vector<std::string> refused;  // one sentence per rejected alternative: "`network:10.0.0.7:17716` names an
                                     // address, ..."
};

// Decides from the text alone. Anything not known to be harmless is rejected.
DeviceRequest device_request(std::string_view id);

// A device of the level with an `id`.
struct LevelRequest {
  std::size_t node = 0;  // its node
  std::string moves;     // the probe or tool that it moves; if none, its node's own name
  std::string id;        // as in the level
  bool used = false;     // its driver is `external`, so the id is used
  DeviceRequest request;
};
std::vector<LevelRequest> device_requests(const Level& level);

// "give it yourself with --probe tip='device:network:10.0.0.7:17716'", quoted for a shell.
std::string device_cure(const LevelRequest& asked);

}  // namespace pliant
