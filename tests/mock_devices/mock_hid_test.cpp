// What hidapi and sysfs show of devices that umockdev makes: run it by ctest, or under umockdev-wrapper. A node is a
// pseudo terminal: good for one report at a time, not for timing.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <umockdev.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "devices/drivers/polhem_kinematics.h"
#include "devices/guard/watchman.h"
#include "devices/ports/hid_port.h"
#include "devices/servo/claim.h"
#include "devices/servo/device_identity.h"
#include "pliant/driver.h"
#include "pliant/drivers.h"
#include "tests/drivers/emulated_spacemouse.h"

namespace pliant {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  char two[3];
  for (const std::uint8_t byte : bytes) std::snprintf(two, sizeof two, "%02X", byte), text += two;
  return text;
}

struct Bench : testing::Test {
  void SetUp() override {
    const char* const first = std::getenv("LD_PRELOAD");
    if (!first || !std::strstr(first, "umockdev")) GTEST_SKIP() << "not under umockdev-wrapper";
    bed = umockdev_testbed_new();
    register_all_drivers();
  }
  void TearDown() override {
    if (bed) g_object_unref(bed);
  }

  struct Made {
    int number;  // of its hidraw node
    unsigned vendor, product;
    std::string name, serial;
    std::vector<std::uint8_t> descriptor;
    bool bluetooth = false;
  };
  void plug(const Made& made) {
    char id[64], parent[64];
    std::snprintf(id, sizeof id, "%04X:%08X:%08X", made.bluetooth ? 5 : 3, made.vendor, made.product);
    std::snprintf(parent, sizeof parent, "%04X:%04X:%04X.%04d", made.bluetooth ? 5 : 3, made.vendor, made.product,
                  made.number);
    const std::string port = "/devices/usb1/1-" + std::to_string(made.number),
                      face = port + "/1-" + std::to_string(made.number) + ":1.0";
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "A: idVendor=%04x\nA: idProduct=%04x\n", made.vendor, made.product);
    const std::string hid = face + "/" + parent, node = "hidraw" + std::to_string(made.number);
    const std::string text = "P: " + port + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n" + numbers +
                             "A: serial=" + made.serial + "\nA: product=" + made.name + "\n\n" + "P: " + face +
                             "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\n\n" + "P: " + hid +
                             "\nE: SUBSYSTEM=hid\nE: HID_ID=" + id + "\nE: HID_NAME=" + made.name +
                             "\nE: HID_UNIQ=" + made.serial + "\nH: report_descriptor=" + hex(made.descriptor) +
                             "\n\n" + "P: " + hid + "/hidraw/" + node + "\nN: " + node +
                             "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/" + node + "\nL: device=../../../" + parent + "\n";
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_add_from_string(bed, text.c_str(), &error)) << (error ? error->message : "");
    nodes[made.number] = "/sys" + hid + "/hidraw/" + node;
    std::vector<std::uint8_t> size(4), whole(4100);
    for (std::size_t i = 0; i < 4; ++i)
      size[i] = whole[i] = static_cast<std::uint8_t>(made.descriptor.size() >> (8 * i));
    std::copy(made.descriptor.begin(), made.descriptor.end(), whole.begin() + 4);
    const std::string file = testing::TempDir() + "pliant_ioctl_" + std::to_string(::getpid());
    if (std::FILE* out = std::fopen(file.c_str(), "w")) {
      std::fprintf(out, "@DEV /dev/%s\nHIDIOCGRDESCSIZE 0 %s\nHIDIOCGRDESC 0 %s\n", node.c_str(), hex(size).c_str(),
                   hex(whole).c_str());
      std::fclose(out);
    }
    ASSERT_TRUE(umockdev_testbed_load_ioctl(bed, nullptr, file.c_str(), &error)) << (error ? error->message : "");
    std::remove(file.c_str());
  }
  void unplug(int number) {
    const int other = umockdev_testbed_get_dev_fd(bed, ("/dev/hidraw" + std::to_string(number)).c_str());
    umockdev_testbed_remove_device(bed, nodes.at(number).c_str());
    ::close(other);
  }
  static std::vector<DeviceInfo> of(const std::string& driver) {
    std::vector<DeviceInfo> infos;
    for (const DeviceInfo& info : list_devices())
      if (info.driver == driver) infos.push_back(info);
    return infos;
  }
  static Made cap(int number, const std::string& serial) {
    return {number, 0x256f, 0xc635, "SpaceMouse Compact", serial, spacemouse_descriptor(false)};
  }

  UMockdevTestbed* bed = nullptr;
  std::map<int, std::string> nodes;
};

TEST_F(Bench, NothingThereIsAnEmptyList) {
  const std::set<std::string> hid{"spacemouse", "dualsense", "dualshock4", "polhem", "gamepad"};
  for (const DeviceInfo& device : list_devices()) EXPECT_FALSE(hid.contains(device.driver)) << device.name;
  EXPECT_THAT((*make_driver("spacemouse"))->open("").error().message(), HasSubstr("none is there; plug it in"));
}

TEST_F(Bench, ACapIsListedOpenedAndMovesAPose) {
  plug(cap(3, "S42"));
  const std::vector<DeviceInfo> found = of("spacemouse");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "SpaceMouse Compact");
  EXPECT_EQ(found[0].id, "S42");
  EXPECT_EQ(found[0].missing, "");
  EXPECT_FALSE(found[0].can.renders_force);
  const std::unique_ptr<Driver> driver = *make_driver("spacemouse");
  const Status opened = driver->open("S42?control=position&dead_zone=0");
  ASSERT_TRUE(opened.ok()) << opened.error().message();
  const int other = umockdev_testbed_get_dev_fd(bed, "/dev/hidraw3");
  const std::array<std::uint8_t, 7> report{1, 0x5e, 0x01, 0, 0, 0, 0};  // X at full deflection
  DeviceSample sample;
  for (int i = 0; i < 2000 && sample.position.x < 0.02; ++i) {
    if (i % 8 == 0) ASSERT_EQ(::write(other, report.data(), report.size()), 7);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(driver->read(sample));
  }
  EXPECT_GE(sample.position.x, 0.02);
  EXPECT_THAT((*make_driver("spacemouse"))->open("S43").error().message(), HasSubstr("there are: S42"));
}

TEST_F(Bench, UnpluggedTheLineDiesAndThePluggedOneIsOpenedAnew) {
  plug(cap(1, "S1"));
  const std::unique_ptr<Driver> driver = *make_driver("spacemouse");
  ASSERT_TRUE(driver->open("").ok());
  DeviceSample sample;
  EXPECT_TRUE(driver->read(sample));
  unplug(1);
  bool lost = false;
  for (int i = 0; i < 2000 && !lost; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    lost = !driver->read(sample);
  }
  EXPECT_TRUE(lost);
  EXPECT_THAT(of("spacemouse"), IsEmpty());
  EXPECT_FALSE(driver->open("S1").ok());
  plug(cap(2, "S1"));
  const Status again = driver->open("S1");
  EXPECT_TRUE(again.ok()) << again.error().message();
  EXPECT_TRUE(driver->read(sample));
}

TEST_F(Bench, WhatMayNotBeOpenedNamesTheRules) {
  plug(cap(0, "S1"));
  if (::geteuid() != 0) {
    GTEST_SKIP() << "only root can give the made device to someone else";
  }
  gchar* const root = umockdev_testbed_get_root_dir(bed);
  ::chmod(root, 0755);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(root) + "/ioctl"))
    std::filesystem::permissions(entry.path(), std::filesystem::perms::all);  // where umockdev answers
  g_free(root);
  const std::string node = "/dev/hidraw0";
  ASSERT_EQ(::chmod(node.c_str(), 0600), 0);
  ASSERT_EQ(::seteuid(65534), 0);
  const std::vector<DeviceInfo> found = of("spacemouse");
  const Status opened = (*make_driver("spacemouse"))->open("");
  ASSERT_EQ(::seteuid(0), 0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].missing, HasSubstr("you may not open /dev/hidraw0"));
  EXPECT_THAT(found[0].missing, HasSubstr("/usr/lib/udev/rules.d/70-pliant.rules"));
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(opened.error().message(), HasSubstr("70-pliant.rules"));
}

TEST_F(Bench, TwoOfTheSameSerialAreDistinguishedByTheirPaths) {
  plug(cap(4, "same"));
  plug(cap(11, "same"));
  plug(cap(5, ""));
  std::vector<std::string> ids;
  for (const DeviceInfo& info : of("spacemouse")) ids.push_back(info.id);
  EXPECT_THAT(ids, testing::ElementsAre("same", "/dev/hidraw5", "/dev/hidraw11"));
}

TEST_F(Bench, EveryKindIsListedUnderItsOwnDriver) {
  const std::vector<std::uint8_t> pad{0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01, 0x75,
                                      0x08, 0x95, 0x3f, 0x09, 0x30, 0x81, 0x02, 0xc0};
  const std::vector<std::uint8_t> raw{0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1, 0x01, 0x75,
                                      0x08, 0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0xc0};
  plug({1, 0x054c, 0x0ce6, "DualSense Wireless Controller", "a0:b1", pad, true});
  plug({2, 0x054c, 0x09cc, "Wireless Controller", "c2:d3", pad, false});
  plug({3, 0x16c0, 0x0486, "Polhem", "77", raw, false});
  plug({4, 0x256f, 0xc652, "Universal Receiver's mouse", "9", pad, false});  // no cap
  ASSERT_EQ(of("dualsense").size(), 1u);
  EXPECT_THAT(of("dualsense")[0].name, HasSubstr("(Bluetooth)"));
  EXPECT_TRUE(of("dualsense")[0].can.resists_only);
  ASSERT_EQ(of("dualshock4").size(), 1u);
  EXPECT_EQ(of("dualshock4")[0].id, "c2:d3");
  ASSERT_EQ(of("polhem").size(), 1u);
  EXPECT_THAT(of("polhem")[0].missing, HasSubstr("polhem:77?mechanism=NAME"));
  EXPECT_THAT(of("spacemouse"), IsEmpty());
}

TEST_F(Bench, AGamepadIsTakenFromWhatSysfsSays) {
  GError* error = nullptr;
  ASSERT_TRUE(umockdev_testbed_add_from_string(
      bed,
      "P: /devices/usb1/1-1/input/input5\nE: SUBSYSTEM=input\nA: name=Some Gamepad\nA: uniq=42:43\n"
      "A: capabilities/abs=3003f\nA: capabilities/key=7cdb000000000000 0 0 0 0\nA: capabilities/ff=107030000 0\n\n"
      "P: /devices/usb1/1-1/input/input5/event7\nN: input/event7\nE: SUBSYSTEM=input\nE: DEVNAME=/dev/input/event7\n"
      "L: device=../../input5\n\n"
      "P: /devices/usb1/1-2/input/input6\nE: SUBSYSTEM=input\nA: name=Some Keyboard\nA: uniq=\n"
      "A: capabilities/abs=0\nA: capabilities/key=402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe\n"
      "A: capabilities/ff=0\n\n"
      "P: /devices/usb1/1-2/input/input6/event8\nN: input/event8\nE: SUBSYSTEM=input\nE: DEVNAME=/dev/input/event8\n"
      "L: device=../../input6\n",
      &error))
      << (error ? error->message : "");
  const std::vector<DeviceInfo> found = of("gamepad");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "Some Gamepad");
  EXPECT_EQ(found[0].id, "42:43");
  EXPECT_TRUE(found[0].can.renders_vibration);
  EXPECT_TRUE(found[0].can.resists_only);
}

// A process of its own that renders `force` until it is killed; its guard process has the line.
pid_t rendering(const char* driver, const char* id, dvec3 force) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const std::unique_ptr<Driver> made = *make_driver(driver);
  if (!made->open(id)) ::_exit(3);
  LineWatch watch;
  if (!watch.start(*made, made->capabilities()).empty()) ::_exit(4);
  DeviceSample sample;
  for (double now = 0.0;; now += 1e-3) {
    made->wait(2e-3);
    made->read(sample);
    made->write({.force = force});
    watch.beat(*made, now);
    ::usleep(1000);
  }
}

// Every packet that comes until `enough`, or until none has come for a second. True: enough.
bool hear(int line, std::size_t size, std::vector<std::uint8_t>& last, const std::function<bool()>& enough) {
  for (std::vector<std::uint8_t> packet;;) {
    pollfd watched{line, POLLIN, 0};
    if (::poll(&watched, 1, 1000) != 1) return false;
    std::uint8_t byte[1024];
    const ssize_t got = ::read(line, byte, size - packet.size());
    if (got <= 0) return false;
    packet.insert(packet.end(), byte, byte + got);
    if (packet.size() < size) continue;
    last = std::exchange(packet, {});
    if (enough()) return true;
  }
}

const std::vector<std::uint8_t> kPad{0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01, 0x75,
                                     0x08, 0x95, 0x3f, 0x09, 0x30, 0x81, 0x02, 0xc0};

TEST_F(Bench, AfterKillNineAGuardProcessLetsAPadRest) {
  plug({1, 0x054c, 0x0ce6, "DualSense Wireless Controller", "a0:b1", kPad, false});
  const int line = umockdev_testbed_get_dev_fd(bed, "/dev/hidraw1");
  const int held = ::open("/dev/hidraw1", O_RDWR | O_NOCTTY);  // a pseudo terminal that no process has open ends
  const pid_t engine = rendering("dualsense", "a0:b1", {0, 2, 0});
  std::vector<std::uint8_t> last;
  const auto shakes = [&] { return last[3] != 0 || last[4] != 0; };
  ASSERT_TRUE(hear(line, 48, last, shakes));
  ::kill(engine, SIGKILL);
  ::waitpid(engine, nullptr, 0);
  hear(line, 48, last, [] { return false; });
  ASSERT_EQ(last.size(), 48u);
  EXPECT_EQ(last[0], 0x02);
  EXPECT_FALSE(shakes()) << "the last that the pad heard";
  ::close(held);
}

TEST_F(Bench, AfterKillNineAGuardProcessTakesTheCurrentsFromAnArm) {
  const std::vector<std::uint8_t> raw{0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1, 0x01, 0x75,
                                      0x08, 0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0xc0};
  plug({3, 0x16c0, 0x0486, "Polhem", "77", raw, false});
  const int line = umockdev_testbed_get_dev_fd(bed, "/dev/hidraw3");
  const int held = ::open("/dev/hidraw3", O_RDWR | O_NOCTTY);
  const PolhemConfig& config = kPolhemConfigs[0];
  const pid_t engine = rendering("polhem", ("77?home=kept&mechanism=" + std::string(config.name)).c_str(), {0, 1, 0});
  std::array<std::uint8_t, 64> parked{};
  for (std::size_t i = 0; i < 3; ++i) {
    parked[2 * i] = static_cast<std::uint8_t>(config.home[i]);
    parked[2 * i + 1] = static_cast<std::uint8_t>(config.home[i] >> 8);
  }
  std::vector<std::uint8_t> last;
  const auto drives = [&] { return std::any_of(last.begin() + 1, last.begin() + 7, [](auto b) { return b != 0; }); };
  ASSERT_TRUE(hear(line, 65, last, [&] {
    if (drives()) return true;
    EXPECT_EQ(::write(line, parked.data(), parked.size()), static_cast<ssize_t>(parked.size()));
    return false;
  }));
  ::kill(engine, SIGKILL);
  ::waitpid(engine, nullptr, 0);
  hear(line, 65, last, [] { return false; });
  ASSERT_EQ(last.size(), 65u) << "a report of 65 bytes";
  EXPECT_FALSE(drives()) << "the last that the arm heard";
  ::close(held);
}

// A driver's open handle, without a device.
struct OpenedNode final : Driver {
  explicit OpenedNode(std::string path) : path_(std::move(path)) {}
  Status open(const std::string&) override { return Done{}; }
  bool read(DeviceSample&) override { return false; }
  void write(const DeviceWrench&) override {}
  void close() override {}
  std::string node() const override { return path_; }

 private:
  std::string path_;
};

// One pad, two kinds of node and any number of names.
TEST_F(Bench, APadIsOneDeviceForWhateverDriverOpensIt) {
  plug({1, 0x054c, 0x0ce6, "DualSense Wireless Controller", "a0:b1", kPad, false});
  plug({2, 0x054c, 0x0ce6, "DualSense Wireless Controller", "a0:b2", kPad, false});
  GError* error = nullptr;
  std::string text;
  for (const auto& [pad, input, event] : {std::array{"0001", "5", "7"}, {"0001", "6", "8"}, {"0002", "9", "11"}}) {
    const std::string port = pad[3] == '1' ? "1-1" : "1-2";
    const std::string at = "/devices/usb1/" + port + "/" + port + ":1.0/0003:054C:0CE6." + pad + "/input/input" + input;
    text += "P: " + at + "\nE: SUBSYSTEM=input\nA: name=Pad\nA: uniq=\n\nP: " + at + "/event" + event +
            "\nN: input/event" + event + "\nE: SUBSYSTEM=input\nE: DEVNAME=/dev/input/event" + event +
            "\nL: device=../../input" + input + "\n\n";
  }
  ASSERT_TRUE(umockdev_testbed_add_from_string(bed, text.c_str(), &error)) << (error ? error->message : "");
  const std::string one = device_identity("dualsense:a0:b1");
  EXPECT_THAT(one, HasSubstr("0003:054C:0CE6.0001"));
  for (const char* same : {"dualsense:/dev/hidraw1", "gamepad:/dev/input/event7", "gamepad:/dev/input/event8",
                           "gamepad:/dev/input/../input/event7?speed=1|delay=5", "gamepad:a0:b1"})
    EXPECT_EQ(device_identity(same), one) << same;
  EXPECT_NE(device_identity("gamepad:/dev/input/event11"), one);
  EXPECT_EQ(device_identity("gamepad:/dev/input/event11"), device_identity("dualsense:a0:b2"));

  DeviceClaim pad, again, other;
  ASSERT_TRUE(pad.take("dualsense"));  // the first one
  const std::unique_ptr<Driver> driver = *make_driver("dualsense");
  ASSERT_TRUE(driver->open(""));
  EXPECT_EQ(driver->node(), "/dev/hidraw1");
  ASSERT_TRUE(pad.take_opened("dualsense", *driver));
  EXPECT_FALSE(again.take("gamepad:/dev/input/event7"));
  EXPECT_FALSE(again.take("dualsense:a0:b1"));
  ASSERT_TRUE(other.take("gamepad"));  // the first one, whichever that is
  const Status twice = other.take_opened("gamepad", OpenedNode("/dev/input/event8"));
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message(), HasSubstr("moves another effector already"));
  EXPECT_TRUE(other.take_opened("gamepad", OpenedNode("/dev/input/event11")));
  pad.release();
  EXPECT_TRUE(again.take("gamepad:/dev/input/event7"));
}

}  // namespace
}  // namespace pliant
