#include <gtest/gtest.h>

#include <algorithm>

#include "pliant/driver.h"
#include "pliant/drivers.h"

namespace pliant {
namespace {

TEST(AllDrivers, EachOfTheNetworkServiceLibraryAndCableIsRegisteredAndSaysWhatIsMissing) {
  register_all_drivers();
  register_all_drivers();
  const auto names = driver_names();
  const auto devices = list_devices();
  for (const std::string name : {"falcon", "forcedimension", "haply", "network", "serial", "touch"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    EXPECT_TRUE(make_driver(name)) << name;
    const auto listed =
        std::find_if(devices.begin(), devices.end(), [&](const DeviceInfo& info) { return info.driver == name; });
    ASSERT_NE(listed, devices.end()) << name;
    EXPECT_NE(listed->missing.empty(), listed->id.empty()) << name << ": it can be opened, or says why not";
    EXPECT_FALSE(listed->name.empty());
  }
}

}  // namespace
}  // namespace pliant
