// SPDX-License-Identifier: Apache-2.0
// A kernel with a camera, a pulse source and a GPIO line that a program's threads can poll, and a test can play upon
// meanwhile: frames, pulses and edges at given times, and devices that are pulled out.
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sys/eventfd.h>
#include <unistd.h>

#include "board/live_rig.hpp"
#include "drivers/device/file_descriptor.hpp"
#include "tests/support/made_camera.hpp"
#include "tests/support/made_pps.hpp"

namespace lxd::test {

// Readable while something waits.
class Bell {
 public:
  void ring() const {
    const std::uint64_t one = 1;
    (void)!::write(event_.get(), &one, sizeof one);
  }
  void silence() const {
    std::uint64_t times = 0;
    (void)!::read(event_.get(), &times, sizeof times);
  }
  [[nodiscard]] int fd() const { return event_.get(); }

 private:
  FileDescriptor event_{::eventfd(0, EFD_NONBLOCK)};
};

class MadeBoard final : public SystemCalls {
 public:
  explicit MadeBoard(std::uint32_t frame_bytes) { camera_.buffer_bytes = frame_bytes; }

  [[nodiscard]] LiveKernel kernel() {
    LiveKernel kernel;
    kernel.calls = this;
    kernel.gpio = [this] { return std::make_unique<Line>(*this); };
    return kernel;
  }

  void send(MadeCamera::Frame frame) {
    const std::scoped_lock lock(mutex_);
    camera_.send(std::move(frame));
    frames_.ring();
  }
  void pulse(RigTime t) {
    const std::scoped_lock lock(mutex_);
    pps_.pulse(t);
  }
  void edge(std::int64_t monotonic_ns, bool rising) {
    const std::scoped_lock lock(mutex_);
    waiting_edges_.push_back({monotonic_ns, rising});
    edges_.ring();
  }
  void plug_camera(bool present) {
    const std::scoped_lock lock(mutex_);
    camera_.present = present;
    frames_.ring();
  }
  [[nodiscard]] bool streaming() {
    const std::scoped_lock lock(mutex_);
    return camera_.streaming && pps_.open_files > 0 && line_held_;
  }

  int open(const std::string& path) override {
    const std::scoped_lock lock(mutex_);
    const bool pulse = path.starts_with("/dev/pps");
    const int opened = pulse ? pps_.open(path) : camera_.open(path);
    if (opened < 0) return opened;
    return pulse ? kPulseFd : frames_.fd();
  }
  void close(int fd) override {
    const std::scoped_lock lock(mutex_);
    fd == kPulseFd ? pps_.close(fd) : camera_.close(fd);
  }
  void* map(int fd, std::size_t bytes, off_t offset) override {
    const std::scoped_lock lock(mutex_);
    return camera_.map(fd, bytes, offset);
  }
  void unmap(void* begin, std::size_t bytes) override {
    const std::scoped_lock lock(mutex_);
    camera_.unmap(begin, bytes);
  }
  int control(int fd, unsigned long request, void* argument) override {
    const std::scoped_lock lock(mutex_);
    if (fd == kPulseFd) return pps_.control(fd, request, argument);
    const int done = camera_.control(fd, request, argument);
    const int cause = errno;
    if (done < 0 && cause == EAGAIN) frames_.silence();
    errno = cause;
    return done;
  }

 private:
  static constexpr int kPulseFd = 1001;  // of no open file

  class Line final : public GpioApi {
   public:
    explicit Line(MadeBoard& board) : board_(board) {}
    int request(const std::string&, unsigned) override {
      const std::scoped_lock lock(board_.mutex_);
      board_.line_held_ = true;
      return board_.edges_.fd();
    }
    int read(int, std::span<GpioEvent> events) override {
      const std::scoped_lock lock(board_.mutex_);
      auto& waiting = board_.waiting_edges_;
      const std::size_t count = std::min(events.size(), waiting.size());
      std::copy_n(waiting.begin(), count, events.begin());
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
      if (waiting.empty()) board_.edges_.silence();
      return static_cast<int>(count);
    }
    void release() override {}

   private:
    MadeBoard& board_;
  };

  std::mutex mutex_;
  MadeCamera camera_;
  MadePps pps_;
  bool line_held_ = false;
  std::vector<GpioEvent> waiting_edges_;
  Bell frames_, edges_;
};

}  // namespace lxd::test
