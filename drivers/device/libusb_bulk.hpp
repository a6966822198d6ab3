// SPDX-License-Identifier: Apache-2.0
// UsbBulkApi by libusb 1.0: transfers that are always under way, so that the sensor never waits for the host.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "drivers/device/file_descriptor.hpp"
#include "drivers/device/usb_bulk_api.hpp"

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;
struct libusb_transfer;

namespace lxd {

class LibusbBulk final : public UsbBulkApi {
 public:
  LibusbBulk() = default;
  LibusbBulk(const LibusbBulk&) = delete;
  LibusbBulk& operator=(const LibusbBulk&) = delete;
  ~LibusbBulk() override { LibusbBulk::close(); }

  Status open(const UsbBulkConfig& config) override;
  // Of libusb's descriptors together (epoll).
  [[nodiscard]] int fd() const override { return poll_.get(); }
  Status read(const std::function<void(std::span<const std::uint8_t>)>& take) override;
  void close() override;

 private:
  static constexpr std::size_t kTransfers = 4, kTransferBytes = 4096;

  struct Transfer {
    LibusbBulk* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    bool under_way = false;
    std::array<std::uint8_t, kTransferBytes> bytes{};
  };

  Status start(const UsbBulkConfig& config);
  Status find(const UsbBulkConfig& config);
  bool is_wanted(libusb_device* device, const UsbBulkConfig& config);
  Status watch();
  Status begin_transfers(std::uint8_t endpoint);
  Status submit(Transfer& transfer);
  void finished(Transfer& transfer);
  void handle_events(int wait_ms);
  [[nodiscard]] bool under_way() const;
  void abandon();

  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  int claimed_ = -1;
  FileDescriptor poll_;
  std::unique_ptr<std::array<Transfer, kTransfers>> transfers_;
  const std::function<void(std::span<const std::uint8_t>)>* take_ = nullptr;  // during read()
  int failure_ = 0;                                                           // a transfer's status; 0: none failed
  bool closing_ = false;
};

}  // namespace lxd
