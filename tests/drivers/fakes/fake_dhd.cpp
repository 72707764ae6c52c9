// A fake of Force Dimension's libdhd: an omega that checks every call. Misuse aborts, so that a test cannot miss it.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/drivers/fakes/fakes.h"

namespace {

FakeDhd fake;
std::atomic<int> inside{0};

void require(bool right, const char* what) {
  if (right) return;
  std::fprintf(stderr, "fake libdhd: %s\n", what);
  std::abort();
}

// The maker's library is not made for two threads at once.
struct Call {
  Call() { require(inside++ == 0, "called by two threads at once"); }
  ~Call() { --inside; }
};
// A call about a device that must be open.
struct DeviceCall : Call {
  explicit DeviceCall(char id) { require(fake.open && id == 5, "a device that is not open"); }
};

}  // namespace

extern "C" {
FakeDhd* fake_dhd() {
  return &fake;
}

int dhdGetDeviceCount() {
  const Call call;
  return fake.unplugged ? 0 : fake.devices.load();
}
int dhdOpenID(char index) {
  const Call call;
  require(!fake.open, "opened twice");
  if (fake.unplugged || index >= fake.devices) return -1;
  ++fake.opens;
  fake.open = true;
  return 5;
}
int dhdClose(char id) {
  const DeviceCall call(id);
  require(fake.unplugged || !fake.enabled || (fake.fx == 0 && fake.fy == 0 && fake.fz == 0), "closed under force");
  ++fake.closes;
  fake.open = fake.enabled = false;
  return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char id) {
  const DeviceCall call(id);
  if (fake.unplugged) return -1;
  *x = fake.x;
  *y = fake.y;
  *z = fake.z;
  ++fake.exchanges;
  return 1;  // the guard of time: no new value, and no error
}
// Rotated by 90 degrees about its vertical: x goes to y.
#ifndef SHORT
int dhdGetOrientationFrame(double frame[3][3], char id) {
  const DeviceCall call(id);
  if (fake.unplugged) return -1;
  const double turned[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) frame[row][column] = turned[row][column];
  return 0;
}
#endif
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double grip,
                                        char id) {
  const DeviceCall call(id);
  if (fake.unplugged) return -1;
  const double norm = std::sqrt(fx * fx + fy * fy + fz * fz);
  require(std::isfinite(norm + tx + ty + tz + grip), "a force that is not finite");
  require(fake.enabled || norm == 0.0, "a force before it was enabled");
  fake.fx = fx;
  fake.fy = fy;
  fake.fz = fz;
  fake.tz = tz;
  if (norm > fake.largest) fake.largest = norm;
  return 0;
}
unsigned dhdGetButtonMask(char id) {
  const DeviceCall call(id);
  return 1;
}
int dhdGetStatus(int status[17], char id) {
  const DeviceCall call(id);
  if (fake.unplugged) return -1;
  for (int i = 0; i < 17; ++i) status[i] = 0;
  status[0] = status[1] = 1;
  status[3] = fake.calibrated ? 0 : 1;
  status[5] = fake.enabled && fake.force_button;
  return 0;
}
int dhdEnableForce(unsigned char on, char id) {
  const DeviceCall call(id);
  require(fake.fx == 0 && fake.fy == 0 && fake.fz == 0, "enabled under force");
  fake.enabled = on != 0;
  return 0;
}
int dhdStop(char id) {
  const DeviceCall call(id);
  ++fake.stops;
  fake.enabled = false;
  fake.fx = fake.fy = fake.fz = 0;
  return 0;
}
int dhdGetSystemType(char id) {
  const DeviceCall call(id);
  return fake.type;
}

// Calls that would change the vendor's limits are forbidden.
int dhdEnableExpertMode() {
  std::abort();
}
int dhdSetWatchdog(unsigned char, char) {
  std::abort();
}
int dhdSetVelocityThreshold(unsigned, char) {
  std::abort();
}
int dhdSetMaxForce(double, char) {
  std::abort();
}
}
