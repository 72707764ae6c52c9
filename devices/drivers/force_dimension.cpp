#include "devices/drivers/force_dimension.h"

#include <charconv>
#include <cmath>

namespace pliant {
namespace {

constexpr double kPeriod = 0.25e-3;   // [s] between two exchanges; the library's time guard may make it longer
constexpr double kRetry = 0.5;        // [s] between two reconnection attempts
constexpr int kErrorsUntilLost = 20;  // failed exchanges
constexpr int kStatusEvery = 16;      // exchanges

// dhdGetStatus
enum DhdStatus : int { kReset = 3, kForceOn = 5, kBraked = 6, kFault = 9 };
constexpr int kStatuses = 32;  // 17 are written; newer versions may write more

// World axes from the vendor's, and back.
dvec3 to_world(const dvec3& v) {
  return {v.y, v.z, v.x};
}
dvec3 to_device(const dvec3& v) {
  return {v.z, v.x, v.y};
}

// By dhdGetSystemType: the vendor's published figures per family; for unknown ones, less than any of them.
DeviceCapabilities figures_of(int type) {
  DeviceCapabilities can{.max_force = 8.0, .max_stiffness = 3000.0, .rate = 4000.0};
  if (type >= 32 && type <= 37) can.max_force = 12.0, can.max_stiffness = 5000.0;                          // omega
  if (type == 63 || type == 64) can.max_force = 20.0, can.max_stiffness = 5000.0;                          // delta
  if (type == 104 || type == 105) can.max_force = 12.0, can.max_torque = 0.2, can.max_stiffness = 4000.0;  // sigma
  can.senses_rotation = (type >= 33 && type <= 37) || type == 64 || type == 104 || type == 105;
  can.renders_torque = type == 104 || type == 105;
  return can;
}

}  // namespace

// The functions of libdhd in use. `char` is signed here, as on the vendor's platforms; device numbers are small and
// positive.
struct ForceDimension::Library {
  SharedLibrary file;
  int (*count)() = nullptr;
  int (*open)(signed char) = nullptr;
  int (*close)(signed char) = nullptr;
  int (*position)(double*, double*, double*, signed char) = nullptr;
  int (*orientation)(double (*)[3], signed char) = nullptr;
  int (*set_force)(double, double, double, double, double, double, double, signed char) = nullptr;
  unsigned (*buttons)(signed char) = nullptr;
  int (*status)(int*, signed char) = nullptr;
  int (*enable_force)(unsigned char, signed char) = nullptr;
  int (*stop)(signed char) = nullptr;
  int (*type)(signed char) = nullptr;
};

ForceDimension::ForceDimension(std::vector<std::string> libraries) : names_(std::move(libraries)) {
  if (names_.empty()) names_ = {"libdhd.so.3", "libdrd.so.3", "libdhd.so", "libdrd.so"};
}
ForceDimension::~ForceDimension() {
  close();
}

auto ForceDimension::load() const -> Result<std::shared_ptr<Library>> {
  auto file = SharedLibrary::open(names_, "install Force Dimension's SDK 3 with its shared libraries");
  if (!file) return file.error();
  auto library = std::make_shared<Library>();
  library->file = std::move(*file);
  SharedLibrary& in = library->file;
  in.need("dhdGetDeviceCount", library->count);
  in.need("dhdOpenID", library->open);
  in.need("dhdClose", library->close);
  in.need("dhdGetPosition", library->position);
  in.need("dhdGetOrientationFrame", library->orientation);
  in.need("dhdSetForceAndTorqueAndGripperForce", library->set_force);
  in.need("dhdGetButtonMask", library->buttons);
  in.need("dhdGetStatus", library->status);
  in.need("dhdEnableForce", library->enable_force);
  in.need("dhdStop", library->stop);
  in.need("dhdGetSystemType", library->type);
  if (auto complete = in.complete(); !complete) return complete.error();
  return library;
}

pliant::Status ForceDimension::open(const std::string& id) {
  close();
  const std::string where = "forcedimension `" + (id.empty() ? "0" : id) + "`";
  int index = 0;
  const char* end = id.data() + id.size();
  if (!id.empty())
    if (const auto [at, fault] = std::from_chars(id.data(), end, index);
        fault != std::errc() || at != end || index < 0 || index > 63)
      return Error{where, "is no number of a device", "it must be 0 to 63, see `pliant devices`"};
  auto library = load();
  if (!library) return library.error();
  const int count = (*library)->count();
  if (index >= count)
    return Error{where, "is not there, the library finds " + std::to_string(std::max(count, 0)),
                 "plug it in, switch it on, and see that its udev rule is installed"};
  index_ = static_cast<signed char>(index);
  const int device = (*library)->open(index_);
  if (device < 0 || device > 127)
    return Error{where, "cannot be opened", "end the program that uses it, and see that its udev rule is installed"};
  device_ = static_cast<signed char>(device);
  int status[kStatuses] = {};
  if ((*library)->status(status, device_) >= 0 && status[kReset] != 0) {
    (*library)->close(device_);
    device_ = -1;
    return Error{where, "is not calibrated", "run Force Dimension's HapticInit once after each power-up"};
  }
  library_ = std::move(*library);
  can_ = figures_of(library_->type(device_));
  sample_ = {};
  thread_.start([this] { run(); });
  return Done{};
}

// One sample and one force. False: the device did not answer.
bool ForceDimension::exchange(int& since_status, bool& braked) {
  if (since_status-- <= 0) {
    int status[kStatuses] = {};
    if (library_->status(status, device_) < 0) return false;
    force_on_ = status[kForceOn] != 0 && status[kBraked] == 0 && status[kFault] == 0 && status[kReset] == 0;
    since_status = kStatusEvery;
  }
  dvec3 position;
  if (library_->position(&position.x, &position.y, &position.z, device_) < 0) return false;
  bool known = std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z);
  if (can_.senses_rotation) {
    double frame[3][3] = {};
    if (library_->orientation(frame, device_) < 0) return false;
    // Rows and columns both change axes: R' = P R Pt.
    dmat3 turned;
    for (int column = 0; column < 3; ++column) {
      const int from = (column + 1) % 3;
      turned[column] = to_world({frame[0][from], frame[1][from], frame[2][from]});
    }
    const double volume = glm::determinant(turned);
    known = known && std::isfinite(volume) && std::abs(volume - 1.0) < 0.01;
    if (known) sample_.rotation = glm::normalize(glm::quat_cast(turned));
  }
  if (known) sample_.position = to_world(position);
  sample_.buttons = library_->buttons(device_);
  sample_.ready = known && force_on_ && !thread_.off();
  thread_.publish(sample_);
  if (thread_.off()) {
    if (!braked) library_->stop(device_);
    braked = true;
    return true;
  }
  const DeviceWrench wrench = thread_.wanted();
  const dvec3 force = to_device(wrench.force), torque = can_.renders_torque ? to_device(wrench.torque) : dvec3(0);
  return library_->set_force(force.x, force.y, force.z, torque.x, torque.y, torque.z, 0.0, device_) >= 0;
}

void ForceDimension::run() {
  bool braked = false;
  const auto begin = [&] {
    library_->set_force(0, 0, 0, 0, 0, 0, 0, device_);
    library_->enable_force(1, device_);
  };
  begin();
  int errors = 0, since_status = 0;
  double due = DeviceThread::seconds();
  while (!thread_.stopping()) {
    errors = exchange(since_status, braked) ? 0 : errors + 1;
    if (errors > kErrorsUntilLost) {
      library_->close(device_);
      device_ = -1;
      while (device_ < 0 && !thread_.stopping()) {
        DeviceThread::sleep(kRetry);
        const int found = library_->open(index_);
        device_ = static_cast<signed char>(found >= 0 && found < 128 ? found : -1);
      }
      if (device_ < 0) return;
      if (!thread_.off()) begin();
      errors = since_status = 0;
    }
    due = std::max(due + kPeriod, DeviceThread::seconds());
    DeviceThread::sleep(due - DeviceThread::seconds());
  }
  library_->set_force(0, 0, 0, 0, 0, 0, 0, device_);
  library_->stop(device_);  // brakes: the motors short-circuited
  library_->close(device_);
  device_ = -1;
}

void ForceDimension::close() {
  thread_.stop();
  library_.reset();
}

std::vector<DeviceInfo> ForceDimension::list() {
  DeviceInfo info{.driver = "forcedimension", .name = "Force Dimension omega, delta, sigma", .can = figures_of(0)};
  const auto library = load();
  if (!library) {
    info.missing = library.error().message();
    return {info};
  }
  const int count = (*library)->count();
  if (count <= 0) info.missing = "none is plugged in and switched on, or its udev rule is not installed";
  std::vector<DeviceInfo> found;
  for (int i = 0; i < count; ++i) {
    info.id = std::to_string(i);
    found.push_back(info);
  }
  return found.empty() ? std::vector{info} : found;
}

std::vector<DeviceInfo> list_force_dimension() {
  return ForceDimension().list();
}

}  // namespace pliant
