// A device that is unplugged and plugged in again (devices/wrappers/refound.h), and one that two drivers find.
#include "devices/wrappers/refound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "devices/wrappers/chain.h"

namespace pliant {
namespace {

struct Plug {
  std::atomic<bool> in{true};
  std::atomic<int> opened{0}, closed{0}, written{0};
  std::atomic<double> strongest{3.0};  // [N] of the connected device
  std::atomic<bool> guarded{false};    // by a process with its line
};
class PluggedDevice final : public Driver {
 public:
  explicit PluggedDevice(Plug& plug) : plug_(plug) {}
  Status open(const std::string& id) override {
    if (!plug_.in || id != "left") return Error{"plugged", "is not there; plug it in"};
    ++plug_.opened;
    gone_ = false;
    return Done{};
  }
  DeviceCapabilities capabilities() const override { return {.max_force = plug_.strongest}; }
  bool read(DeviceSample& sample) override {
    gone_ = gone_ || !plug_.in;
    if (gone_) return false;
    sample = {};
    sample.position = {0, 0.01, 0};
    return true;
  }
  void write(const DeviceWrench&) override { ++plug_.written; }
  void close() override { ++plug_.closed; }
  bool safe_line(SafeLine&) const override { return plug_.guarded; }
  bool gone() const override { return gone_; }

 private:
  Plug& plug_;
  bool gone_ = false;
};

bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(Refound, AnUnpluggedDeviceIsOpenedAnewUnderItsIdAndReadAgain) {
  Plug plug;
  Refound device(std::make_unique<PluggedDevice>(plug));
  ASSERT_TRUE(device.open("left"));
  DeviceSample sample;
  ASSERT_TRUE(device.read(sample));
  plug.in = false;
  EXPECT_FALSE(device.read(sample));
  EXPECT_TRUE(device.gone());
  const int written = plug.written;
  device.write({});
  device.make_safe();
  EXPECT_EQ(plug.written, written) << "what is gone is written nothing";
  ASSERT_TRUE(comes_true([&] { return plug.closed >= 2; })) << "it is looked for again and again";
  EXPECT_FALSE(device.read(sample));
  EXPECT_EQ(plug.opened, 1);
  plug.in = true;
  ASSERT_TRUE(comes_true([&] { return device.read(sample); }));
  EXPECT_EQ(plug.opened, 2);
  EXPECT_FALSE(device.gone());
  device.write({});
  EXPECT_GT(plug.written, written);
}

TEST(Refound, AnotherDeviceInItsPlaceIsNotTaken) {
  Plug plug;
  Refound device(std::make_unique<PluggedDevice>(plug));
  ASSERT_TRUE(device.open("left"));
  DeviceSample sample;
  plug.in = false;
  EXPECT_FALSE(device.read(sample));
  plug.strongest = 30.0;
  plug.in = true;
  ASSERT_TRUE(comes_true([&] { return plug.opened >= 3; }));
  EXPECT_FALSE(device.read(sample)) << "its limits are not those that were promised";
  plug.strongest = 3.0;
  ASSERT_TRUE(comes_true([&] { return device.read(sample); }));
}

// The servo sends the new line to the guard process (ProcessFault.AGuardProcessGetsANewLine).
TEST(Refound, OneWhoseLineAGuardProcessHoldsIsOpenedAnewTooAndHasNoLineMeanwhile) {
  Plug plug;
  plug.guarded = true;
  Refound device(std::make_unique<PluggedDevice>(plug));
  ASSERT_TRUE(device.open("left"));
  DeviceSample sample;
  SafeLine line;
  EXPECT_TRUE(device.safe_line(line));
  plug.in = false;
  EXPECT_FALSE(device.read(sample));
  EXPECT_FALSE(device.safe_line(line));
  plug.in = true;
  ASSERT_TRUE(comes_true([&] { return device.read(sample); }));
  EXPECT_EQ(plug.opened, 2);
  EXPECT_TRUE(device.safe_line(line));
}

TEST(Refound, ClosingWhileItIsGoneEndsTheSearchAndOpeningBeginsAnew) {
  Plug plug;
  Refound device(std::make_unique<PluggedDevice>(plug));
  ASSERT_TRUE(device.open("left"));
  DeviceSample sample;
  plug.in = false;
  EXPECT_FALSE(device.read(sample));
  device.close();
  const int closed = plug.closed;
  std::this_thread::sleep_for(std::chrono::duration<double>(2 * Refound::kLookEvery));
  EXPECT_EQ(plug.closed, closed);
  EXPECT_FALSE(device.open("left"));
  plug.in = true;
  ASSERT_TRUE(device.open("left"));
  EXPECT_TRUE(device.read(sample));
}

TEST(ListDevices, APadThatTwoDriversFindIsListedOnceByTheOneThatIsMadeForIt) {
  const auto listed = [](const char* driver, const char* id, const char* hardware, bool general) {
    const DeviceInfo info{driver, id, "pad", "", {}, hardware, general, {}};
    return register_driver(
        driver, [] { return std::unique_ptr<Driver>(); }, [info] { return std::vector<DeviceInfo>{info}; });
  };
  ASSERT_TRUE(listed("a general pad", "event7", "054c:0ce6:a4:53", true));
  ASSERT_TRUE(listed("made for the pad", "a4:53", "054c:0ce6:", false));
  ASSERT_TRUE(listed("another pad", "event9", "054c:09cc:b1:22", true));
  std::vector<std::string> found;
  std::string also;
  for (const DeviceInfo& device : list_devices()) {
    found.push_back(device.driver);
    if (device.driver == "made for the pad") also = device.also;
  }
  EXPECT_THAT(found, testing::AllOf(testing::Contains("made for the pad"), testing::Contains("another pad"),
                                    testing::Not(testing::Contains("a general pad"))));
  EXPECT_EQ(also, "a general pad:event7");
}

}  // namespace
}  // namespace pliant
