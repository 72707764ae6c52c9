#include <memory>

#include "player/verbs/device_test.h"
#include "player/verbs/options.h"

namespace pliant {

void add_devices(CLI::App& app, int& status) {
  const auto options = std::make_shared<DeviceTestOptions>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("devices", "haptic and pointing devices found, and how to use each");
  verb->add_flag("--json", *json, "as JSON");
  CLI::Option* test =
      verb->add_option("--test", options->id, "live samples of this one")->type_name("ID")->check(named());
  verb->add_option("--seconds", options->seconds, "duration [s] (10)")->check(within(0.1, 86400.0))->needs(test);
  verb->add_flag("--push", options->push, "pushes gently along each axis, after a confirmation")->needs(test);
  verb->footer(
      "Examples:\n  pliant devices --json\n  pliant devices --test spacemouse\n  pliant devices --test falcon --push");
  verb->callback([options, json, &status] { status = options->id.empty() ? devices(*json) : test_device(*options); });
}

}  // namespace pliant
