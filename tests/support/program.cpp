// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program.hpp"

#include <array>
#include <csignal>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lxd::test {
namespace {

std::vector<std::string> words_of(const std::string& arguments) {
  std::vector<std::string> words{LXD_SLAM_PROGRAM};
  std::istringstream stream(arguments);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

void apply(const ProgramLimits& limits) {
  if (!limits.file_bytes) return;
  ::signal(SIGXFSZ, SIG_IGN);  // then write() fails, as on a full disk
  const rlimit limit{*limits.file_bytes, *limits.file_bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

// In the child; never returns.
[[noreturn]] void become(std::vector<std::string>& words, const ProgramLimits& limits, int out) {
  constexpr int kNoProgram = 127;  // as a shell says it
  const auto connect = [out](const std::string& file, int to) {
    ::dup2(file.empty() ? out : ::open(file.c_str(), O_WRONLY), to);
  };
  connect(limits.standard_output, STDOUT_FILENO);
  connect(limits.standard_error, STDERR_FILENO);
  apply(limits);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(kNoProgram);
}

}  // namespace

Program::Program(const std::string& arguments, const ProgramLimits& limits) {
  std::vector<std::string> words = words_of(arguments);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  process_ = ::fork();
  if (process_ == 0) become(words, limits, ends[1]);
  ::close(ends[1]);
  pipe_ = ends[0];
}

Program::~Program() {
  if (process_ < 0) return;
  signal(SIGKILL);
  (void)wait();
}

void Program::signal(int number) const {
  if (process_ > 0) ::kill(process_, number);
}

Ended Program::wait() {
  Ended ended;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = ::read(pipe_, buffer.data(), buffer.size())) > 0;)
    ended.text.append(buffer.data(), static_cast<std::size_t>(n));
  ::close(pipe_);
  int raw = 0;
  rusage usage{};
  ::wait4(process_, &raw, 0, &usage);
  process_ = -1;
  if (WIFEXITED(raw)) ended.status = WEXITSTATUS(raw);
  constexpr double kKibibytesPerMebibyte = 1024;
  ended.peak_rss_mib = static_cast<double>(usage.ru_maxrss) / kKibibytesPerMebibyte;
  return ended;
}

Ended lxd_slam(const std::string& arguments, const ProgramLimits& limits) { return Program(arguments, limits).wait(); }

nlohmann::json evaluated(const std::string& arguments) {
  const Ended ended = lxd_slam("evaluate --json " + arguments);
  EXPECT_EQ(ended.status, 0) << ended.text;
  return ended.status == 0 ? nlohmann::json::parse(ended.text) : nlohmann::json::object();
}

}  // namespace lxd::test
