// What a level may ask a run for. A level is a file of whoever wrote it, and its PLIANT_haptic_device/id may name kinds
// of devices only: addresses, ports, serial lines, files, and wrappers that touch files are the user's word (`--probe`,
// an answer to a question). One place decides, for `run`, the window, the editor, `validate` and `inspect`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct DeviceRequest {
  std::string allowed;               // the alternatives that a level may name, as they are to be opened; "": none
  std::vector<std::string> refused;  // of each other one a sentence: "`network:10.0.0.7:17716` names an address, ..."
};

// Of the text alone. What is not known to be harmless is refused, whatever its spelling.
DeviceRequest device_request(std::string_view id);

// A device of the level with an `id`.
struct LevelRequest {
  std::size_t node = 0;  // its node
  std::string moves;     // the probe or tool that it moves; of none, its node's own name
  std::string id;        // as the level says it
  bool used = false;     // its driver is `external`: the id is read
  DeviceRequest request;
};
std::vector<LevelRequest> device_requests(const Level& level);

// "give it yourself with --probe tip='device:network:10.0.0.7:17716'", fit for a shell whatever the level's names are.
std::string device_cure(const LevelRequest& asked);

}  // namespace pliant
