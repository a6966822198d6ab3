// SPDX-License-Identifier: Apache-2.0
// A USB device of one bulk endpoint to the host, made of this process by the kernel's FunctionFS: what is written comes
// out at the host. Source: Documentation/usb/functionfs.rst, linux/usb/functionfs.h; USB 2.0, 9.6.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <unistd.h>

#include "drivers/device/file_descriptor.hpp"

namespace lxd::hil {

class UsbFunction {
 public:
  // `folder`: where the function's file system is mounted. The gadget is to be bound to its controller afterwards.
  explicit UsbFunction(const std::filesystem::path& folder) : control_(::open((folder / "ep0").c_str(), O_RDWR)) {
    constexpr std::uint16_t kFullSpeedBytes = 64, kHighSpeedBytes = 512;  // a packet of a bulk endpoint
    std::vector<std::uint8_t> speeds;
    put(speeds, kEntries, 4);
    put(speeds, kEntries, 4);
    put_interface(speeds, kFullSpeedBytes);
    put_interface(speeds, kHighSpeedBytes);
    declare(FUNCTIONFS_DESCRIPTORS_MAGIC_V2, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC, speeds);
    declare(FUNCTIONFS_STRINGS_MAGIC, 0, {0, 0, 0, 0});  // no strings, in no language
    endpoint_ = FileDescriptor(::open((folder / "ep1").c_str(), O_WRONLY));
    if (!endpoint_) throw std::runtime_error("ep1 cannot be opened");
  }

  // Waits until the host has taken it. False: the host has gone.
  [[nodiscard]] bool send(std::span<const std::uint8_t> bytes) const {
    return ::write(endpoint_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }

 private:
  static constexpr std::uint32_t kEntries = 2;  // of each speed: interface and endpoint

  static void put(std::vector<std::uint8_t>& to, std::uint32_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) to.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  }

  static void put_interface(std::vector<std::uint8_t>& to, std::uint16_t packet_bytes) {
    constexpr std::uint8_t kOfMaker = 0xFF, kIn1 = 0x81, kBulk = 2;
    to.insert(to.end(), {9, USB_DT_INTERFACE, 0, 0, 1, kOfMaker, 0, 0, 0});
    to.insert(to.end(), {7, USB_DT_ENDPOINT, kIn1, kBulk});
    put(to, packet_bytes, 2);
    to.push_back(0);
  }

  // Magic, length of all, a number (flags; of strings how many), and the rest.
  void declare(std::uint32_t magic, std::uint32_t number, const std::vector<std::uint8_t>& rest) const {
    std::vector<std::uint8_t> all;
    put(all, magic, 4);
    put(all, static_cast<std::uint32_t>(rest.size() + 12), 4);
    put(all, number, 4);
    all.insert(all.end(), rest.begin(), rest.end());
    if (::write(control_.get(), all.data(), all.size()) != static_cast<ssize_t>(all.size()))
      throw std::runtime_error("ep0 refuses what the device is to be");
  }

  FileDescriptor control_, endpoint_;
};

}  // namespace lxd::hil
