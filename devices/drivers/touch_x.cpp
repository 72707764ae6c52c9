#include "devices/drivers/touch_x.h"

#include <cmath>

#include "runtime/clock.h"

namespace pliant {
namespace {

// Constants of the vendor's interface.
constexpr unsigned kInvalid = 0xFFFFFFFF;
constexpr unsigned kForceOutput = 0x4000, kMaxForceClamp = 0x4001, kForceRamp = 0x4002, kSoftwareLimit = 0x4003;
constexpr unsigned kButtons = 0x2000, kPosition = 0x2050, kTransform = 0x2052, kForce = 0x2700, kMaxForce = 0x2603;
constexpr unsigned kCalibrated = 0x5000;
constexpr unsigned kContinue = 1;
constexpr unsigned short kPriority = 0xFFFF;  // the highest, as usual for force rendering

constexpr double kDeadline = 0.020;  // [s] watchdog: a force that is not renewed becomes zero
constexpr double kMillimetre = 1e-3;

double seconds_now() {
  return static_cast<double>(now_ns()) * 1e-9;
}
bool finite(const double* values, int count) {
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
}

}  // namespace

struct Touch::Library {
  struct Fault {
    unsigned code;
    int detail;
    unsigned device;
  };
  SharedLibrary file;
  unsigned (*init)(const char*) = nullptr;
  void (*disable_device)(unsigned) = nullptr;
  void (*make_current)(unsigned) = nullptr;
  void (*begin)(unsigned) = nullptr;
  void (*end)(unsigned) = nullptr;
  void (*enable)(unsigned) = nullptr;
  void (*disable)(unsigned) = nullptr;
  void (*get_doubles)(unsigned, double*) = nullptr;
  void (*get_integers)(unsigned, int*) = nullptr;
  void (*set_doubles)(unsigned, const double*) = nullptr;
  void (*start)() = nullptr;
  void (*stop)() = nullptr;
  unsigned long (*schedule)(unsigned (*)(void*), void*, unsigned short) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;
  Fault (*fault)() = nullptr;
  unsigned (*calibration)() = nullptr;  // missing in older versions
};

Touch::Touch(std::vector<std::string> libraries) : names_(std::move(libraries)) {
  if (names_.empty()) names_ = {"libHD.so", "libHD.so.3.4", "libHD.so.3.0", "libHD.so.3"};
}
Touch::~Touch() {
  close();
}

auto Touch::load() const -> Result<std::shared_ptr<Library>> {
  auto file = SharedLibrary::open(names_, "install 3D Systems' OpenHaptics 3 and the driver of the device");
  if (!file) return file.error();
  auto library = std::make_shared<Library>();
  library->file = std::move(*file);
  SharedLibrary& in = library->file;
  in.need("hdInitDevice", library->init);
  in.need("hdDisableDevice", library->disable_device);
  in.need("hdMakeCurrentDevice", library->make_current);
  in.need("hdBeginFrame", library->begin);
  in.need("hdEndFrame", library->end);
  in.need("hdEnable", library->enable);
  in.need("hdDisable", library->disable);
  in.need("hdGetDoublev", library->get_doubles);
  in.need("hdGetIntegerv", library->get_integers);
  in.need("hdSetDoublev", library->set_doubles);
  in.need("hdStartScheduler", library->start);
  in.need("hdStopScheduler", library->stop);
  in.need("hdScheduleAsynchronous", library->schedule);
  in.need("hdUnschedule", library->unschedule);
  in.need("hdGetError", library->fault);
  in.find("hdCheckCalibration", library->calibration);
  if (auto complete = in.complete(); !complete) return complete.error();
  return library;
}

Status Touch::open(const std::string& id) {
  close();
  const std::string where = "touch `" + (id.empty() ? "default device" : id) + "`";
  auto library = load();
  if (!library) return library.error();
  library_ = std::move(*library);
  while (library_->fault().code != 0) {
  }  // discards an old sample
  device_ = library_->init(id.empty() || id == "default" ? nullptr : id.c_str());
  if (const auto fault = library_->fault(); device_ == kInvalid || fault.code != 0) {
    if (device_ != kInvalid) library_->disable_device(device_);
    library_.reset();
    char code[16];
    std::snprintf(code, sizeof code, "0x%x", fault.code);
    return Error{where, std::string("cannot be opened (error ") + code + " of libHD)",
                 "set it up with the maker's program, and give the name used there"};
  }
  double force = 0.0;
  library_->get_doubles(kMaxForce, &force);
  can_ = {.senses_rotation = true,
          .max_force = std::isfinite(force) && force > 0.0 && force < 40.0 ? force : 3.3,
          .max_stiffness = 400.0,  // stable with a Touch; the vendor's stiffer models allow more
          .rate = 1000.0,
          .loop = DeviceLoop::kCallback};
  for (const unsigned safety : {kMaxForceClamp, kForceRamp, kSoftwareLimit}) library_->enable(safety);
  while (library_->fault().code != 0) {
  }  // a model without one of these reports it
  library_->enable(kForceOutput);
  off_ = was_off_ = failed_ = has_tick_ = false;
  sample_ = {};
  samples_.acquire();
  task_ = library_->schedule(on_frame, this, kPriority);
  library_->start();
  if (const auto fault = library_->fault(); fault.code != 0) {
    close();
    return Error{where, "its scheduler does not start", "end the program that uses it"};
  }
  return Done{};
}

unsigned Touch::on_frame(void* self) {
  static_cast<Touch*>(self)->frame();
  return kContinue;
}

// On the vendor's thread, once per period.
void Touch::frame() {
  library_->make_current(device_);
  library_->begin(device_);
  double position[3] = {}, transform[16] = {};
  int buttons = 0;
  library_->get_doubles(kPosition, position);
  library_->get_doubles(kTransform, transform);
  library_->get_integers(kButtons, &buttons);
  bool known = finite(position, 3) && finite(transform, 16) && !failed_ && !off_;
  if (library_->calibration && library_->calibration() != kCalibrated) known = false;
  // Column-major; its fourth column is the position again.
  const dmat3 turn(transform[0], transform[1], transform[2], transform[4], transform[5], transform[6], transform[8],
                   transform[9], transform[10]);
  known = known && std::abs(glm::determinant(turn) - 1.0) < 0.01;
  if (known) {
    sample_.rotation = glm::normalize(glm::quat_cast(turn));
    sample_.position = kMillimetre * dvec3(position[0], position[1], position[2]);
  }
  sample_.buttons = static_cast<std::uint32_t>(buttons);
  sample_.ready = known;
  sample_.time = seconds_now();
  samples_.write() = sample_;
  samples_.publish();
  if (has_tick_.load(std::memory_order_acquire)) tick_();
  if (forces_.acquire()) newest_ = forces_.read();
  const bool apply = known && !off_ && seconds_now() - newest_.time < kDeadline;
  const dvec3 force = apply ? newest_.force : dvec3(0);
  const double newtons[3] = {force.x, force.y, force.z};
  library_->set_doubles(kForce, newtons);
  if (off_ && !was_off_) {
    library_->disable(kForceOutput);
    was_off_ = true;
  }
  library_->end(device_);
  // Overheated motors, too high a speed or force, a lost connection: zero force in the next frame, and an unknown pose
  // until a frame without errors.
  failed_ = false;
  for (int i = 0; i < 16 && library_->fault().code != 0; ++i) failed_ = true;
}

bool Touch::read(DeviceSample& sample) {
  if (!samples_.acquire()) return false;
  sample = samples_.read();
  return true;
}

void Touch::write(const DeviceWrench& wrench) {
  forces_.write() = {wrench.force, seconds_now()};
  forces_.publish();
}

Status Touch::run(std::function<void()> tick) {
  if (!library_) return Error{"touch", "has no loop before it is opened"};
  if (has_tick_) return Error{"touch", "its loop has a tick already", "close it first"};
  tick_ = std::move(tick);
  has_tick_.store(true, std::memory_order_release);
  return Done{};
}

void Touch::close() {
  if (!library_) return;
  off_ = true;
  // The scheduler is stopped between two frames. The last force is set to zero here, then the force output is switched
  // off.
  library_->stop();
  library_->unschedule(task_);
  library_->make_current(device_);
  library_->begin(device_);
  const double zero[3] = {0, 0, 0};
  library_->set_doubles(kForce, zero);
  library_->end(device_);
  library_->disable(kForceOutput);
  library_->disable_device(device_);
  has_tick_ = false;
  tick_ = {};
  library_.reset();
}

std::vector<DeviceInfo> Touch::list() {
  // Listing the devices would require opening them: the library cannot count them.
  DeviceInfo info{.driver = "touch", .name = "3D Systems Touch, Touch X, Phantom"};
  info.can = {.senses_rotation = true, .max_force = 3.3, .max_stiffness = 400.0, .rate = 1000.0};
  if (const auto library = load(); !library)
    info.missing = library.error().message();
  else
    info.id = "default";
  return {info};
}

std::vector<DeviceInfo> list_touch() {
  return Touch().list();
}

}  // namespace pliant
