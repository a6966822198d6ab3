// SPDX-License-Identifier: Apache-2.0
// The program lxd-slam as a child process: what it says, how it ends, and how much memory it took at most.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/types.h>

namespace lxd::test {

struct Ended {
  int status = -1;          // of the exit; -1 when a signal ended it
  std::string text;         // standard output and error
  double peak_rss_mib = 0;  // as the kernel counted it

  [[nodiscard]] bool says(const std::string& part) const { return text.find(part) != std::string::npos; }
};

// What the child is given besides its arguments.
struct ProgramLimits {
  std::optional<rlim_t> file_bytes{};  // no file grows beyond: stands in for a full disk
  std::string standard_output{};       // a file in place of the pipe; likewise
  std::string standard_error{};
};

// Runs; wait() ends it.
class Program {
 public:
  // Arguments are parted by blanks.
  explicit Program(const std::string& arguments, const ProgramLimits& limits = {});
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  void signal(int number) const;
  [[nodiscard]] pid_t id() const { return process_; }
  [[nodiscard]] Ended wait();

 private:
  pid_t process_ = -1;
  int pipe_ = -1;
};

[[nodiscard]] Ended lxd_slam(const std::string& arguments, const ProgramLimits& limits = {});

// `evaluate --json` of a run against its truth; fails the test and is empty when it does not succeed.
[[nodiscard]] nlohmann::json evaluated(const std::string& arguments);

}  // namespace lxd::test
