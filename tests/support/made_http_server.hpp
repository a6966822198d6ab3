// SPDX-License-Identifier: Apache-2.0
// An HTTP server on the loopback, as a sensor has one: answers by path, and can misbehave. Serves one request after the
// other, in a thread of its own.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include "drivers/device/file_descriptor.hpp"

namespace lxd::test {

class MadeHttpServer {
 public:
  // Path -> the whole answer, with its head. What is not there is 404; an empty answer is none, ever.
  using Answers = std::map<std::string, std::string>;
  explicit MadeHttpServer(Answers answers)
      : answers_(std::move(answers)), listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t bytes = sizeof here;
    EXPECT_EQ(::bind(listening_.get(), reinterpret_cast<const sockaddr*>(&here), bytes), 0);
    EXPECT_EQ(::listen(listening_.get(), 4), 0);
    EXPECT_EQ(::getsockname(listening_.get(), reinterpret_cast<sockaddr*>(&here), &bytes), 0);
    port_ = ntohs(here.sin_port);
    server_ = std::thread([this] { serve(); });
  }
  MadeHttpServer(const MadeHttpServer&) = delete;
  MadeHttpServer& operator=(const MadeHttpServer&) = delete;
  ~MadeHttpServer() {
    ended_ = true;
    server_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int requests() const { return requests_; }

  static std::string found(const std::string& body) {
    return "HTTP/1.1 200 OK\r\nServer: nginx\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" + body;
  }

 private:
  static bool waits(int fd) {
    pollfd wanted{fd, POLLIN, 0};
    return ::poll(&wanted, 1, 10) > 0;
  }

  void serve() {
    while (!ended_) {
      if (!waits(listening_.get())) continue;
      const FileDescriptor client(::accept(listening_.get(), nullptr, nullptr));
      answer(client.get());
    }
  }
  void answer(int client) {
    std::string request;
    while (!ended_ && request.find("\r\n\r\n") == std::string::npos) {
      std::array<char, 1024> piece;
      if (!waits(client)) continue;
      const ssize_t got = ::recv(client, piece.data(), piece.size(), 0);
      if (got <= 0) return;
      request.append(piece.data(), static_cast<std::size_t>(got));
    }
    ++requests_;
    const std::string path = request.substr(4, request.find(' ', 4) - 4);
    const auto found = answers_.find(path);
    const std::string text =
        found == answers_.end() ? "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n" : found->second;
    while (!ended_ && text.empty() && !waits(client)) {
    }
    ::send(client, text.data(), text.size(), MSG_NOSIGNAL);
  }

  std::map<std::string, std::string> answers_;
  FileDescriptor listening_;
  std::uint16_t port_ = 0;
  std::atomic<bool> ended_{false};
  std::atomic<int> requests_{0};
  std::thread server_;
};

}  // namespace lxd::test
