// SPDX-License-Identifier: Apache-2.0
// See libusb_bulk.hpp. Source: the documentation of libusb 1.0, "Asynchronous device I/O" and "Polling and timing".
#include "drivers/device/libusb_bulk.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>
#include <poll.h>
#include <sys/epoll.h>

namespace lxd {
namespace {

Error failure(const char* what, int code) {
  return Error{fmt::format("{}: {}", what, libusb_strerror(static_cast<libusb_error>(code)))};
}

const char* name_of(int transfer_status) {
  switch (transfer_status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
      return "the device is gone";
    case LIBUSB_TRANSFER_STALL:
      return "the endpoint has stalled";
    case LIBUSB_TRANSFER_OVERFLOW:
      return "more came than was asked for";
    default:
      return "a transfer has failed";
  }
}

}  // namespace

Status LibusbBulk::open(const UsbBulkConfig& config) {
  const Status started = start(config);
  if (!started) close();
  return started;
}

Status LibusbBulk::start(const UsbBulkConfig& config) {
  failure_ = 0;
  closing_ = false;
  if (const int code = libusb_init(&context_); code != 0) return failure("libusb", code);
  if (const Status found = find(config); !found) return found;
  (void)libusb_set_auto_detach_kernel_driver(handle_, 1);  // where there is no such thing, no driver is in the way
  if (const int code = libusb_claim_interface(handle_, config.interface); code != 0)
    return failure("the interface cannot be claimed", code);
  claimed_ = config.interface;
  if (const Status watched = watch(); !watched) return watched;
  return begin_transfers(config.endpoint);
}

Status LibusbBulk::begin_transfers(std::uint8_t endpoint) {
  transfers_ = std::make_unique<std::array<Transfer, kTransfers>>();
  for (Transfer& each : *transfers_) {
    each.owner = this;
    each.transfer = libusb_alloc_transfer(0);
    if (each.transfer == nullptr) return Error{"no memory for a transfer"};
    const auto ended = [](libusb_transfer* of) {
      auto* const transfer = static_cast<Transfer*>(of->user_data);
      transfer->owner->finished(*transfer);
    };
    libusb_fill_bulk_transfer(each.transfer, handle_, endpoint, each.bytes.data(), static_cast<int>(each.bytes.size()),
                              ended, &each, 0);
    if (const Status submitted = submit(each); !submitted) return submitted;
  }
  return success();
}

Status LibusbBulk::find(const UsbBulkConfig& config) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context_, &list);
  if (count < 0) return failure("the devices cannot be listed", static_cast<int>(count));
  const std::span devices(list, static_cast<std::size_t>(count));
  const bool found = std::ranges::any_of(devices, [&](libusb_device* device) { return is_wanted(device, config); });
  libusb_free_device_list(list, 1);
  return found ? success() : Status(Error{"not there, or not permitted"});
}

// Leaves the device open when it is.
bool LibusbBulk::is_wanted(libusb_device* device, const UsbBulkConfig& config) {
  libusb_device_descriptor about{};
  if (libusb_get_device_descriptor(device, &about) != 0) return false;
  if (about.idVendor != config.vendor || about.idProduct != config.product) return false;
  if (libusb_open(device, &handle_) != 0) return false;
  if (config.serial.empty()) return true;
  std::array<unsigned char, 256> text{};
  const int length = libusb_get_string_descriptor_ascii(handle_, about.iSerialNumber, text.data(), text.size());
  const auto* const begin = reinterpret_cast<const char*>(text.data());
  if (length > 0 && std::string(begin, static_cast<std::size_t>(length)) == config.serial) return true;
  libusb_close(std::exchange(handle_, nullptr));
  return false;
}

// libusb waits for several descriptors; one epoll stands for them all. Transfers have no time-out, so no timer is due.
Status LibusbBulk::watch() {
  poll_ = FileDescriptor(::epoll_create1(EPOLL_CLOEXEC));
  const libusb_pollfd** const descriptors = libusb_get_pollfds(context_);
  if (!poll_ || descriptors == nullptr) return Error{fmt::format("epoll: {}", std::strerror(errno))};
  for (const libusb_pollfd** each = descriptors; *each != nullptr; ++each) {
    epoll_event event{};
    event.events = ((*each)->events & POLLIN ? EPOLLIN : 0U) | ((*each)->events & POLLOUT ? EPOLLOUT : 0U);
    (void)::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, (*each)->fd, &event);
  }
  libusb_free_pollfds(descriptors);
  return success();
}

Status LibusbBulk::submit(Transfer& transfer) {
  const int code = libusb_submit_transfer(transfer.transfer);
  transfer.under_way = code == 0;
  return code == 0 ? success() : Status(failure("a transfer cannot begin", code));
}

// Called by libusb, within handle_events().
void LibusbBulk::finished(Transfer& transfer) {
  transfer.under_way = false;
  const libusb_transfer& ended = *transfer.transfer;
  if (closing_ || ended.status == LIBUSB_TRANSFER_CANCELLED) return;
  if (ended.status != LIBUSB_TRANSFER_COMPLETED) {
    failure_ = ended.status;
    return;
  }
  if (take_ != nullptr && ended.actual_length > 0)
    (*take_)(std::span(transfer.bytes).first(static_cast<std::size_t>(ended.actual_length)));
  if (!submit(transfer)) failure_ = LIBUSB_TRANSFER_ERROR;
}

void LibusbBulk::handle_events(int wait_ms) {
  constexpr int kMicrosPerMilli = 1000;
  timeval wait{0, wait_ms * kMicrosPerMilli};
  (void)libusb_handle_events_timeout_completed(context_, &wait, nullptr);  // a failed transfer tells its own story
}

Status LibusbBulk::read(const std::function<void(std::span<const std::uint8_t>)>& take) {
  take_ = &take;
  handle_events(0);
  take_ = nullptr;
  return failure_ == 0 ? success() : Status(Error{name_of(failure_)});
}

bool LibusbBulk::under_way() const {
  return transfers_ != nullptr && std::ranges::any_of(*transfers_, &Transfer::under_way);
}

// A transfer that is under way belongs to libusb until it ends, cancelled or whole. One that does not end is never
// freed.
void LibusbBulk::close() {
  constexpr int kPatience = 100, kWait_ms = 10;
  closing_ = true;
  if (transfers_ != nullptr) {
    for (Transfer& each : *transfers_) {
      if (each.under_way) (void)libusb_cancel_transfer(each.transfer);
    }
    for (int i = 0; i < kPatience && under_way(); ++i) handle_events(kWait_ms);
    if (under_way()) return abandon();
    for (Transfer& each : *transfers_) libusb_free_transfer(each.transfer);
    transfers_.reset();
  }
  if (claimed_ >= 0) (void)libusb_release_interface(handle_, std::exchange(claimed_, -1));
  if (handle_ != nullptr) libusb_close(std::exchange(handle_, nullptr));
  poll_.reset();
  if (context_ != nullptr) libusb_exit(std::exchange(context_, nullptr));
}

void LibusbBulk::abandon() {
  (void)transfers_.release();
  handle_ = nullptr;
  context_ = nullptr;
  claimed_ = -1;
  poll_.reset();
}

}  // namespace lxd
