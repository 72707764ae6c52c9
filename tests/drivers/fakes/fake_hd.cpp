// A fake of 3D Systems' libHD: one device and its scheduler, a thread of 1 kHz. Misuse aborts, so that a test cannot
// miss it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <thread>

#include "tests/drivers/fakes/fakes.h"

namespace {

FakeHd fake;
std::thread scheduler;
std::mutex mutex;  // of the tasks
unsigned (*task)(void*) = nullptr;
void* task_data = nullptr;
std::atomic<bool> stopping{false};
std::atomic<unsigned> pending{0};
std::atomic<bool> current{false}, in_frame{false};
std::atomic<std::thread::id> owner{};
double wanted[3] = {};
constexpr unsigned kDevice = 3;
constexpr double kLimit = 3.3;  // [N]

void require(bool right, const char* what) {
  if (right) return;
  std::fprintf(stderr, "fake libHD: %s\n", what);
  std::abort();
}
void in_a_frame() {
  require(in_frame && owner.load() == std::this_thread::get_id(), "state outside of a frame of this thread");
}

}  // namespace

extern "C" {
struct HdFault {
  unsigned code;
  int detail;
  unsigned device;
};

FakeHd* fake_hd() {
  return &fake;
}

unsigned hdInitDevice(const char* name) {
  require(!fake.running, "a device after the scheduler had started");
  if (!fake.present || (name && std::string_view(name) != "right hand")) {
    pending = 0x301;
    return 0xFFFFFFFF;
  }
  require(!fake.initialised, "opened twice");
  fake.initialised = current = true;
  return kDevice;
}
void hdDisableDevice(unsigned device) {
  require(device == kDevice && fake.initialised && !fake.running, "disabled while the scheduler runs");
  require(fake.fx == 0 && fake.fy == 0 && fake.fz == 0, "disabled under force");
  fake.initialised = false;
}
void hdMakeCurrentDevice(unsigned device) {
  require(device == kDevice && fake.initialised, "no such device");
  current = true;
}
void hdBeginFrame(unsigned device) {
  require(device == kDevice && current && !in_frame, "frames within frames");
  require(!fake.running || std::this_thread::get_id() == scheduler.get_id(), "a frame beside the scheduler's");
  in_frame = true;
  owner = std::this_thread::get_id();
}
void hdEndFrame(unsigned device) {
  require(device == kDevice, "no such device");
  in_a_frame();
  const double norm = std::sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1] + wanted[2] * wanted[2]);
  require(std::isfinite(norm) && norm <= kLimit + 1e-9, "more force than the device has");
  require(fake.output || norm == 0.0, "a force without output");
  fake.fx = wanted[0];
  fake.fy = wanted[1];
  fake.fz = wanted[2];
  if (norm > fake.largest) fake.largest = norm;
  in_frame = false;
  ++fake.frames;
  pending = fake.next_fault.exchange(0);
}
void hdEnable(unsigned what) {
  require(fake.initialised, "nothing to enable");
  if (what == 0x4000) {
    require(fake.clamp && fake.ramp && fake.limit, "output before its limits");
    fake.output = true;
  }
  if (what == 0x4001) fake.clamp = true;
  if (what == 0x4002) fake.ramp = true;
  if (what == 0x4003) fake.limit = true;
}
void hdDisable(unsigned what) {
  require(what == 0x4000, "a limit of the maker was switched off");
  fake.output = false;
}
void hdGetDoublev(unsigned what, double* values) {
  if (what == 0x2603) {
    values[0] = kLimit;
    return;
  }
  in_a_frame();
  if (what == 0x2050) {
    values[0] = fake.x;
    values[1] = fake.y;
    values[2] = fake.z;
  } else if (what == 0x2052) {  // by columns
    const double c = std::cos(fake.turn), s = std::sin(fake.turn);
    const double all[16] = {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, fake.x, fake.y, fake.z, 1};
    for (int i = 0; i < 16; ++i) values[i] = all[i];
  } else {
    require(false, "an unknown number was asked for");
  }
}
void hdGetIntegerv(unsigned what, int* values) {
  in_a_frame();
  require(what == 0x2000, "an unknown number was asked for");
  values[0] = fake.buttons;
}
void hdSetDoublev(unsigned what, const double* values) {
  in_a_frame();
  require(what == 0x2700, "an unknown number was set");
  for (int i = 0; i < 3; ++i) wanted[i] = values[i];
}
unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
  const std::lock_guard lock(mutex);
  require(!task, "two tasks");
  task = callback;
  task_data = data;
  return 1;
}
void hdUnschedule(unsigned long handle) {
  const std::lock_guard lock(mutex);
  require(handle == 1 && task, "no such task");
  task = nullptr;
}
void hdStartScheduler() {
  require(fake.initialised && !fake.running, "started twice, or without a device");
  stopping = false;
  fake.running = true;
  std::atomic<bool> begun{false};
  scheduler = std::thread([&begun] {
    while (!begun) std::this_thread::yield();  // until `scheduler` has its thread id
    while (!stopping) {
      {
        const std::lock_guard lock(mutex);
        if (task && task(task_data) == 0) task = nullptr;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  begun = true;
  while (fake.frames == 0) std::this_thread::yield();  // `begun` lives until then
}
void hdStopScheduler() {
  require(fake.running, "stopped, and did not run");
  stopping = true;
  scheduler.join();
  fake.running = false;
}
#ifndef SHORT
HdFault hdGetError() {
  return {pending.exchange(0), 0, kDevice};
}
#endif
unsigned hdCheckCalibration() {
  in_a_frame();
  return fake.calibration;
}
}
