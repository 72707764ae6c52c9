#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "devices/drivers/serial_device.h"
#include "devices/ports/serial_port.h"
#include "devices/servo/servo.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

std::string with_sum(std::string text) {
  unsigned sum = 0;
  for (const char letter : text) sum ^= static_cast<unsigned char>(letter);
  char end[8];
  std::snprintf(end, sizeof end, "*%02X", sum);
  return text + end;
}

TEST(SerialLine, APoseIsMicrometresInWorldAxes) {
  const auto pose = parse_serial_pose(with_sum("P 1234 10000 -20000 30000 5 250"));
  ASSERT_TRUE(pose);
  EXPECT_NEAR(length(pose->sample.position - dvec3(0.01, -0.02, 0.03)), 0.0, 1e-12);
  EXPECT_EQ(pose->sample.buttons, 5u);
  EXPECT_EQ(pose->sample.grip, 0.25);
  EXPECT_EQ(pose->time_ms, 1234u);
  EXPECT_TRUE(parse_serial_pose(with_sum("P 0 0 0 0 0 0") + "\r"));
}

TEST(SerialLine, LinesThatAreCutFalseOrOutOfReachAreRefused) {
  const std::string good = with_sum("P 1234 10000 -20000 30000 5 250");
  for (std::size_t cut = 0; cut < good.size(); ++cut) EXPECT_FALSE(parse_serial_pose(good.substr(0, cut))) << cut;
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] ^= 1;
    EXPECT_FALSE(parse_serial_pose(bad)) << bad;
  }
  for (const char* text : {"P", "P 1 2 3 4 5", "P 1 2 3 4 5 6 7", "P 1 2 3 4 5 1001", "P 1 9000000 0 0 0 0",
                           "P -1 0 0 0 0 0", "P 1 nan 0 0 0 0", "P  1 0 0 0 0 0", "P 1 0 0 0 0 0 ", "p 1 0 0 0 0 0",
                           "P 1 1e3 0 0 0 0", "P 1 99999999999999999999 0 0 0 0", "I a 1 1"})
    EXPECT_FALSE(parse_serial_pose(with_sum(text))) << text;
}

TEST(SerialLine, ForcesAreMillinewtonsAndNeverNaN) {
  SerialText text;
  EXPECT_EQ(std::string(text.data(), serial_force(7, {1.5, -0.25, 0}, text)), with_sum("F 7 1500 -250 0") + "\n");
  EXPECT_EQ(std::string(text.data(), serial_force(4294967295u, {NAN, 1e30, -INFINITY}, text)),
            with_sum("F 4294967295 0 100000 0") + "\n");
}

TEST(SerialLine, AStreamIsCutIntoLinesAndNoiseIsDropped) {
  SerialLines lines;
  std::string_view line;
  lines.add("on");
  EXPECT_FALSE(lines.next(line));
  lines.add("e\ntwo\nthr");
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "one");
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "two");
  EXPECT_FALSE(lines.next(line));
  lines.add(std::string(5000, 'x'));
  EXPECT_FALSE(lines.next(line));
  lines.add("\nfour\n");
  std::string last;
  while (lines.next(line)) last = line;
  EXPECT_EQ(last, "four");
}

// The board at the other end of a pseudo-terminal.
struct Board {
  int master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::string path;
  std::atomic<bool> stop{false}, silent{false}, garbled{false};
  std::atomic<long> x{0};          // [um]
  std::atomic<long> fx{0}, fy{0};  // [mN]
  std::atomic<int> forces{0};
  std::atomic<unsigned> newest{1};  // number of the last force
  std::thread thread;

  Board() {
    grantpt(master);
    unlockpt(master);
    path = ptsname(master);
    // Kept open here as well: reading a pseudo-terminal without an open peer is an error.
    held = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios line{};
    tcgetattr(held, &line);
    cfmakeraw(&line);
    tcsetattr(held, TCSANOW, &line);
  }
  void start() {
    thread = std::thread([this] { run(); });
  }
  ~Board() {
    stop = true;
    if (thread.joinable()) thread.join();
    ::close(held);
    ::close(master);
  }
  void say(const std::string& text) { EXPECT_GE(::write(master, text.data(), text.size()), 0); }
  void run() {
    std::string stream;
    while (!stop) {
      pollfd wait{master, POLLIN, 0};
      if (::poll(&wait, 1, 10) <= 0) continue;
      char bytes[256];
      const ssize_t got = ::read(master, bytes, sizeof bytes);
      if (got <= 0) continue;
      stream.append(bytes, static_cast<std::size_t>(got));
      for (std::size_t end; (end = stream.find('\n')) != std::string::npos; stream.erase(0, end + 1)) {
        const std::string line = stream.substr(0, end);
        if (silent) continue;
        unsigned number = 0;
        long a = 0, b = 0, c = 0;
        if (line == with_sum("?")) {
          say(with_sum("I hapkit 1 2000") + "\r\n");
        } else if (std::sscanf(line.c_str(), "F %u %ld %ld %ld", &number, &a, &b, &c) == 4 &&
                   with_sum(line.substr(0, line.size() - 3)) == line) {
          fx = a;
          fy = b;
          newest = number;
          ++forces;
          const std::string pose = "P " + std::to_string(number) + " " + std::to_string(x) + " 0 0 1 0";
          say(garbled ? pose + "*00\n" : with_sum(pose) + "\n");
        }
      }
    }
  }
  int held = -1;
};

TEST(SerialDevice, LinesThatAreNotUsedAreCountedByWhy) {
  Board board;
  board.start();
  SerialDevice driver;
  ASSERT_TRUE(driver.open(board.path));
  EXPECT_EQ(describe(driver.dropped()), "");
  board.garbled = true;
  DeviceSample sample;
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool) { return driver.dropped().checksum > 3; }));
  EXPECT_EQ(driver.dropped().damaged(), driver.dropped().checksum);
  EXPECT_NE(describe(driver.dropped()).find("with a wrong check sum"), std::string::npos);
  for (const auto& [line, why] :
       {std::pair<std::string, SerialFault>(with_sum("P 1 0 0 0 0 1001"), SerialFault::kNumber),
        {with_sum("P 1 0 0 0"), SerialFault::kForm},
        {"P 1 0 0 0 0 0*00", SerialFault::kSum},
        {"P", SerialFault::kTooShort},
        {with_sum("P 1 0 0 0 0 0"), SerialFault::kNone}}) {
    SerialFault fault = SerialFault::kNone;
    (void)parse_serial_pose(line, &fault);
    EXPECT_EQ(fault, why) << line;
  }
}

TEST(SerialDevice, AfterKillNineAGuardProcessWritesALineOfZero) {
  Board board;
  const pid_t engine = fork();  // before there is a thread, which could hold the allocator's lock
  if (engine == 0) {
    Servo servo(std::make_unique<SerialDevice>());
    if (!servo.open(board.path) || !servo.start()) _exit(3);
    for (;;) usleep(1000);
  }
  board.start();
  ASSERT_TRUE(soon([&] { return board.forces > 100; }));
  ASSERT_NE(board.newest, 0u);
  kill(engine, SIGKILL);
  waitpid(engine, nullptr, 0);
  EXPECT_TRUE(soon([&] { return board.newest == 0u; })) << "the guard process's own line";
}

TEST(SerialDevice, ABoardOfOneAxisIsReadAndPushedAlongThatAxisAlone) {
  Board board;
  board.start();
  board.x = 12500;
  SerialDevice driver;
  const auto opened = driver.open(board.path + "@1000000");
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_EQ(driver.name(), "hapkit");
  EXPECT_NEAR(driver.capabilities().max_force, 2.0, 1e-12);
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0.75, 1, 1}}, [&](bool came) { return came && board.fx == 750; }));
  EXPECT_EQ(board.fy, 0);
  EXPECT_NEAR(sample.position.x, 0.0125, 1e-12);
  EXPECT_EQ(sample.buttons, 1u);
  EXPECT_TRUE(soon([&] { return board.fx == 0; })) << "a force that nobody renews is over";
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0.75, 1, 1}}, [&](bool came) { return came && board.fx == 750; }));
  driver.close();
  EXPECT_TRUE(soon([&] { return board.fx == 0; })) << "and so is the last";
}

TEST(SerialDevice, ABoardThatSpeaksNonsenseGetsNoForce) {
  Board board;
  board.start();
  SerialDevice driver;
  ASSERT_TRUE(driver.open(board.path));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {1, 0, 0}}, [&](bool) { return board.fx == 1000; }));
  board.garbled = true;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {1, 0, 0}}, [&](bool) { return board.fx == 0; }));
  const int before = board.forces;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {1, 0, 0}}, [&](bool) { return board.forces > before + 10; }));
  EXPECT_EQ(board.fx, 0);
  EXPECT_FALSE(driver.read(sample));
  board.garbled = false;
  EXPECT_TRUE(runs_until(driver, sample, {.force = {1, 0, 0}}, [&](bool) { return board.fx == 1000; }));
}

TEST(SerialDevice, WhatIsMissingIsOneSentence) {
  SerialDevice driver;
  EXPECT_EQ(driver.open("").error().message(),
            "serial: needs its line; give one such as serial:/dev/ttyACM0, see `pliant devices`");
  EXPECT_EQ(driver.open("/dev/ttyACM999").error().message(),
            "/dev/ttyACM999: is not there; plug the device in, and see `pliant devices`");
  EXPECT_NE(driver.open("/dev/null").error().message().find("is no serial line"), std::string::npos);
  EXPECT_NE(driver.open("/dev/ttyACM0@17").error().message().find("17 is no speed"), std::string::npos);
  EXPECT_FALSE(driver.open("/dev/ttyACM0@fast"));
  Board board;
  board.start();
  board.silent = true;
  EXPECT_NE(driver.open(board.path).error().message().find("does not answer as a device of Pliant"), std::string::npos);
}

TEST(SerialDevice, LinesOfUsbAreListedAndOthersAreNot) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "serial_lines_test";
  std::filesystem::create_directories(folder);
  EXPECT_FALSE(list_serial(folder.string()).at(0).missing.empty());
  for (const char* name : {"ttyUSB1", "ttyACM0", "ttyS0", "tty"}) std::ofstream(folder / name).put('x');
  const auto found = list_serial(folder.string());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].id, (folder / "ttyACM0").string());
  EXPECT_TRUE(found[1].missing.empty());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pliant
