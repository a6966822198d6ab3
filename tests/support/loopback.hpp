// SPDX-License-Identifier: Apache-2.0
// Stand-ins for wires: a sender of datagrams on the loopback, and a serial line whose far end the test holds.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/device/device.hpp"
#include "drivers/device/file_descriptor.hpp"

namespace lxd::test {

inline constexpr std::uint32_t kLoopback = 0x7F000001;  // 127.0.0.1; the other addresses of 127/8 are loopback too

inline std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class UdpSender {
 public:
  // source_port 0: the kernel chooses.
  explicit UdpSender(std::uint32_t source_address = kLoopback, std::uint16_t source_port = 0)
      : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in end = end_of(source_address, source_port);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&end), sizeof(end)), 0);
  }

  void send(std::uint16_t port, std::span<const std::uint8_t> bytes) const {
    const sockaddr_in end = end_of(kLoopback, port);
    const ssize_t sent =
        ::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&end), sizeof(end));
    EXPECT_EQ(sent, static_cast<ssize_t>(bytes.size()));
  }
  void send(std::uint16_t port, const std::string& text) const { send(port, bytes_of(text)); }

 private:
  static sockaddr_in end_of(std::uint32_t address, std::uint16_t port) {
    sockaddr_in end{};
    end.sin_family = AF_INET;
    end.sin_addr.s_addr = htonl(address);
    end.sin_port = htons(port);
    return end;
  }

  FileDescriptor socket_;
};

// A port that nobody has at this moment.
inline std::uint16_t free_udp_port() {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in end{};
  end.sin_family = AF_INET;
  socklen_t bytes = sizeof(end);
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&end), sizeof(end)), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&end), &bytes), 0);
  return ntohs(end.sin_port);
}

// The sensor's end of a serial line; the host's end is at a path of its own, as below /dev/serial/by-id.
class SerialCable {
 public:
  explicit SerialCable(std::filesystem::path path) : path_(std::move(path)) { plug(); }
  ~SerialCable() { pull(); }
  SerialCable(const SerialCable&) = delete;
  SerialCable& operator=(const SerialCable&) = delete;

  void plug() {
    far_end_ = FileDescriptor(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
    ASSERT_EQ(::grantpt(far_end_.get()), 0);
    ASSERT_EQ(::unlockpt(far_end_.get()), 0);
    const FileDescriptor once(::open(::ptsname(far_end_.get()), O_RDWR | O_NOCTTY | O_CLOEXEC));  // see heard()
    std::filesystem::create_symlink(::ptsname(far_end_.get()), path_);
  }
  void pull() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    far_end_.reset();
  }
  // Whether the host's end has been open for so long that it no longer throws away what came before: from then on not a
  // byte is lost. Whether it is open the kernel tells only after it was open once.
  [[nodiscard]] bool heard() {
    constexpr std::chrono::milliseconds kFlushed{50};
    pollfd asked{far_end_.get(), 0, 0};
    const auto now = std::chrono::steady_clock::now();
    if (!far_end_ || (::poll(&asked, 1, 0) > 0 && (asked.revents & POLLHUP) != 0))
      open_since_.reset();
    else if (!open_since_)
      open_since_ = now;
    return open_since_ && now - *open_since_ >= kFlushed;
  }
  // Waits while the line is full. While the cable is pulled nobody hears it.
  void send(std::span<const std::uint8_t> bytes) const {
    if (!far_end_) return;
    ASSERT_EQ(::write(far_end_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void send(const std::string& text) const { send(bytes_of(text)); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  FileDescriptor far_end_;
  std::optional<std::chrono::steady_clock::time_point> open_since_;
};

// Keeps what a device hands over.
class KeepChunks final : public ChunkSink {
 public:
  struct Kept {
    RigTime received;
    ChunkOrigin origin;
    std::uint8_t channel;
    std::string text;
  };

  void take(const Chunk& chunk) override {
    chunks.push_back({chunk.received, chunk.origin, chunk.channel, {chunk.bytes.begin(), chunk.bytes.end()}});
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const Kept& chunk : chunks) all += chunk.text;
    return all;
  }

  std::vector<Kept> chunks;
};

// Whether something waits at the device before a deadline that only a hang meets.
inline bool readable(const Device& device, std::chrono::milliseconds deadline = std::chrono::seconds(10)) {
  pollfd wanted{device.fd(), POLLIN, 0};
  return ::poll(&wanted, 1, static_cast<int>(deadline.count())) == 1;
}

}  // namespace lxd::test
