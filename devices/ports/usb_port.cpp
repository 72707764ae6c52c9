#include "devices/ports/usb_port.h"

#include <libusb.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {

struct UsbPort::Handles {
  UsbAddress address;
  libusb_context* context = nullptr;
  libusb_device_handle* device = nullptr;
  std::array<std::uint8_t, 512> in{};  // whole USB packets: a shorter buffer would lose bytes
  ~Handles() {
    if (device) libusb_release_interface(device, 0);
    if (device) libusb_close(device);
    if (context) libusb_exit(context);
  }
  std::string name() const {
    char text[24];
    std::snprintf(text, sizeof text, "USB %04x:%04x", address.vendor, address.product);
    return text;
  }
};

namespace {

// Calls `each` with the devices of this kind until it returns true; returns the number of calls.
template <class F>
int visit(libusb_context* context, std::uint16_t vendor, std::uint16_t product, F&& each) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  int found = 0;
  bool enough = false;
  for (ssize_t i = 0; i < count && !enough; ++i) {
    libusb_device_descriptor about{};
    if (libusb_get_device_descriptor(list[i], &about) != 0) continue;
    if (about.idVendor != vendor || about.idProduct != product) continue;
    enough = each(found++, list[i]);
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  return found;
}

}  // namespace

UsbPort::UsbPort(std::unique_ptr<Handles> handles) : handles_(std::move(handles)) {}
UsbPort::~UsbPort() = default;

int UsbPort::count(std::uint16_t vendor, std::uint16_t product) {
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) return 0;
  const int found = visit(context, vendor, product, [](int, libusb_device*) { return false; });
  libusb_exit(context);
  return found;
}

Result<std::unique_ptr<UsbPort>> UsbPort::open(const UsbAddress& address) {
  auto handles = std::make_unique<Handles>();
  handles->address = address;
  if (libusb_init(&handles->context) != 0) {
    handles->context = nullptr;
    return Error{handles->name(), "libusb could not begin", "is /dev/bus/usb there?"};
  }
  int fault = LIBUSB_ERROR_NO_DEVICE;
  visit(handles->context, address.vendor, address.product, [&](int number, libusb_device* device) {
    if (number != address.index) return false;
    fault = libusb_open(device, &handles->device);
    return true;
  });
  if (fault == LIBUSB_ERROR_ACCESS)
    return Error{handles->name(), "may not be opened by this user",
                 "install the udev rule 70-pliant.rules and plug it in again"};
  if (fault != 0) return Error{handles->name(), "is not there", "plug it in and switch it on"};
  libusb_set_auto_detach_kernel_driver(handles->device, 1);
  if (libusb_claim_interface(handles->device, 0) != 0)
    return Error{handles->name(), "is in use", "end the program that uses it"};
  return std::unique_ptr<UsbPort>(new UsbPort(std::move(handles)));
}

Status UsbPort::send(std::span<const std::uint8_t> packet) {
  int sent = 0;
  const int fault =
      libusb_bulk_transfer(handles_->device, handles_->address.out, const_cast<std::uint8_t*>(packet.data()),
                           static_cast<int>(packet.size()), &sent, 100);
  if (fault == 0 && sent == static_cast<int>(packet.size())) return Done{};
  return Error{handles_->name(), std::string("does not take what is sent: ") + libusb_error_name(fault)};
}

Result<std::size_t> UsbPort::receive(std::span<std::uint8_t> into, double seconds) {
  int got = 0;
  // libusb treats 0 as infinite.
  const auto milliseconds = static_cast<unsigned>(std::max(1.0, std::ceil(std::min(seconds, 1e6) * 1e3)));
  const int fault = libusb_bulk_transfer(handles_->device, handles_->address.in, handles_->in.data(),
                                         static_cast<int>(handles_->in.size()), &got, milliseconds);
  if (fault != 0 && fault != LIBUSB_ERROR_TIMEOUT)
    return Error{handles_->name(), std::string("is gone: ") + libusb_error_name(fault)};
  const std::size_t size = std::min(static_cast<std::size_t>(std::max(got, 0)), into.size());
  std::copy_n(handles_->in.begin(), size, into.begin());
  return size;
}

Status UsbPort::set_feature(std::span<const std::uint8_t> request) {
  if (request.size() != 5) return Error{handles_->name(), "a control request has five bytes"};
  const auto word = [&](std::size_t at) { return static_cast<std::uint16_t>(request[at] | request[at + 1] << 8); };
  const int fault = libusb_control_transfer(handles_->device, 0x40, request[0], word(1), word(3), nullptr, 0, 1000);
  if (fault >= 0) return Done{};
  return Error{handles_->name(), std::string("refuses a setting: ") + libusb_error_name(fault)};
}

}  // namespace pliant
