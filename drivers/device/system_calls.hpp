// SPDX-License-Identifier: Apache-2.0
// The system calls that devices other than sockets and terminals take, so that tests can stand in for a kernel that has
// them.
#pragma once

#include <cstddef>
#include <string>

#include <sys/types.h>

namespace lxd {

class SystemCalls {
 public:
  virtual ~SystemCalls() = default;

  // As the system calls of these names: -1 (null for map) and errno when they fail.
  virtual int open(const std::string& path) = 0;  // for reading and writing, without waiting
  virtual int control(int fd, unsigned long request, void* argument) = 0;
  virtual void* map(int fd, std::size_t bytes, off_t offset) = 0;
  virtual void unmap(void* begin, std::size_t bytes) = 0;
  virtual void close(int fd) = 0;
};

// The kernel's; calls that a signal interrupted are made again.
SystemCalls& kernel_calls();

}  // namespace lxd
