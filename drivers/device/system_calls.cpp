// SPDX-License-Identifier: Apache-2.0
// See system_calls.hpp.
#include "drivers/device/system_calls.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace lxd {
namespace {

class KernelCalls final : public SystemCalls {
 public:
  int open(const std::string& path) override { return ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); }
  int control(int fd, unsigned long request, void* argument) override {
    int result = 0;
    do result = ::ioctl(fd, request, argument);
    while (result < 0 && errno == EINTR);
    return result;
  }
  void* map(int fd, std::size_t bytes, off_t offset) override {
    void* const begin = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    return begin == MAP_FAILED ? nullptr : begin;
  }
  void unmap(void* begin, std::size_t bytes) override { ::munmap(begin, bytes); }
  void close(int fd) override { ::close(fd); }
};

}  // namespace

SystemCalls& kernel_calls() {
  static KernelCalls kernel;
  return kernel;
}

}  // namespace lxd
