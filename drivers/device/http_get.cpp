// SPDX-License-Identifier: Apache-2.0
// See http_get.hpp. Source: RFC 9110 and 9112. The request is of HTTP/1.0, so that the answer comes in one piece and
// ends with the connection.
#include "drivers/device/http_get.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include "drivers/device/file_descriptor.hpp"

namespace lxd {
namespace {

using Clock = std::chrono::steady_clock;

class Request {
 public:
  Request(const HttpTarget& target, const std::string& path, Duration deadline, std::size_t bytes_max)
      : target_(target),
        path_(path),
        end_(Clock::now() + std::chrono::nanoseconds(deadline.ns())),
        bytes_max_(bytes_max) {}

  Result<HttpAnswer> make() {
    if (const Status connected = connect(); !connected) return connected.error();
    if (const Status sent = send(); !sent) return sent.error();
    if (const Status received = receive(); !received) return received.error();
    return answer();
  }

 private:
  [[nodiscard]] Error failure(std::string_view what) const {
    return Error{fmt::format("http://{}:{}{}: {}", target_.address, target_.port, path_, what)};
  }
  [[nodiscard]] Error failure(std::string_view what, int cause) const {
    return failure(fmt::format("{}: {}", what, std::strerror(cause)));
  }

  // False: the time is over.
  [[nodiscard]] bool ready(short events) const {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end_ - Clock::now()).count();
    pollfd wanted{socket_.get(), events, 0};
    return left > 0 && ::poll(&wanted, 1, static_cast<int>(left)) > 0;
  }

  Status connect() {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    const std::string port = std::to_string(target_.port);
    if (const int refused = ::getaddrinfo(target_.address.c_str(), port.c_str(), &hints, &found); refused != 0)
      return failure(fmt::format("no address: {}", ::gai_strerror(refused)));
    socket_ = FileDescriptor(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int result = ::connect(socket_.get(), found->ai_addr, found->ai_addrlen);
    const int cause = errno;
    ::freeaddrinfo(found);
    if (result != 0 && cause != EINPROGRESS) return failure("no connection", cause);
    if (!ready(POLLOUT)) return failure("no connection in time");
    int refused = 0;
    socklen_t bytes = sizeof refused;
    (void)::getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &refused, &bytes);
    return refused == 0 ? success() : Status(failure("no connection", refused));
  }

  Status send() {
    const std::string request = fmt::format(
        "GET {} HTTP/1.0\r\nHost: {}\r\nAccept: application/json\r\nConnection: close\r\n\r\n", path_, target_.address);
    for (std::string_view rest = request; !rest.empty();) {
      if (!ready(POLLOUT)) return failure("the request was not taken in time");
      const ssize_t sent = ::send(socket_.get(), rest.data(), rest.size(), MSG_NOSIGNAL);
      if (sent < 0 && errno != EAGAIN) return failure("the request was not taken", errno);
      rest.remove_prefix(sent < 0 ? 0 : static_cast<std::size_t>(sent));
    }
    return success();
  }

  Status receive() {
    std::array<char, 4096> piece;
    for (;;) {
      if (!ready(POLLIN)) return failure("no whole answer in time");
      const ssize_t got = ::recv(socket_.get(), piece.data(), piece.size(), 0);
      if (got == 0) return success();
      if (got < 0 && errno == EAGAIN) continue;
      if (got < 0) return failure("the answer broke off", errno);
      received_.append(piece.data(), static_cast<std::size_t>(got));
      if (received_.size() > bytes_max_) return failure(fmt::format("more than {} bytes came", bytes_max_));
    }
  }

  // The value of a header line; none: there is no such. Names are of any case.
  static std::optional<std::string_view> header(std::string_view head, std::string_view name) {
    const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    while (!head.empty()) {
      const auto end = std::min(head.find("\r\n"), head.size());
      std::string_view line = head.substr(0, end);
      head.remove_prefix(std::min(end + 2, head.size()));
      if (line.size() <= name.size() || line[name.size()] != ':') continue;
      if (!std::equal(name.begin(), name.end(), line.begin(), [&](char a, char b) { return same(b, a); })) continue;
      line.remove_prefix(name.size() + 1);
      line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
      return line;
    }
    return std::nullopt;
  }

  Result<HttpAnswer> answer() const {
    constexpr std::string_view kVersion = "HTTP/1.";
    constexpr std::size_t kStatusAt = 9, kStatusDigits = 3;  // "HTTP/1.1 200"
    const auto head_end = received_.find("\r\n\r\n");
    HttpAnswer answer;
    const std::string_view all = received_;
    const bool whole =
        head_end != std::string::npos && all.starts_with(kVersion) && all.size() > kStatusAt + kStatusDigits;
    const char* const status = all.data() + kStatusAt;
    if (!whole || std::from_chars(status, status + kStatusDigits, answer.status).ptr != status + kStatusDigits)
      return failure("the answer is no HTTP");
    const std::string_view head = all.substr(0, head_end);
    answer.body = all.substr(head_end + 4);
    const auto length = header(head, "content-length");
    if (length && *length != std::to_string(answer.body.size()))
      return failure(fmt::format("found {} bytes, wanted {} as the answer says", answer.body.size(), *length));
    if (header(head, "transfer-encoding")) return failure("the answer comes in chunks, which HTTP/1.0 does not know");
    return answer;
  }

  const HttpTarget& target_;
  const std::string& path_;
  Clock::time_point end_;
  std::size_t bytes_max_;
  FileDescriptor socket_;
  std::string received_;
};

}  // namespace

Result<HttpAnswer> http_get(const HttpTarget& target, const std::string& path, Duration deadline,
                            std::size_t bytes_max) {
  return Request(target, path, deadline, bytes_max).make();
}

}  // namespace lxd
