#include "components/device_spec.h"

namespace pliant {
namespace {

std::string_view without_margins(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? std::string_view{}
                                         : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

// Removes the part up to the next `mark` from `text` and returns it; `more` is false after the last one.
std::string_view take_part(std::string_view& text, char mark, bool& more) {
  const std::size_t end = text.find(mark);
  more = end != std::string_view::npos;
  const std::string_view part = without_margins(text.substr(0, end));
  text.remove_prefix(more ? end + 1 : text.size());
  return part;
}

}  // namespace

std::string DeviceSpec::words() const {
  std::string words = device();
  for (const std::string& wrapper : wrappers) words += "|" + wrapper;
  return words;
}

std::vector<DeviceSpec> parse_device_specs(std::string_view words) {
  std::vector<DeviceSpec> all;
  for (bool more = true; more;) {
    std::string_view one = take_part(words, ';', more);
    DeviceSpec& spec = all.emplace_back();
    bool wrapped = false;
    std::string_view device = take_part(one, '|', wrapped);
    spec.driver = take_part(device, ':', spec.has_id);
    spec.id = without_margins(device);
    while (wrapped) spec.wrappers.emplace_back(take_part(one, '|', wrapped));
  }
  return all;
}

}  // namespace pliant
