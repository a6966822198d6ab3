// SPDX-License-Identifier: Apache-2.0
// Errors as values, for everything that loads, opens or checks. Not for the real-time path: a message allocates.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace lxd {

// Names the file, the line or key, what was found and what was wanted.
struct Error {
  std::string message;
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}  // NOLINT(google-explicit-constructor): return value; reads best
  Result(Error error)
      : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor): return Error{...}; reads best

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  // Precondition of value(): ok(); of error(): !ok().
  [[nodiscard]] T& value() { return std::get<T>(content_); }
  [[nodiscard]] const T& value() const { return std::get<T>(content_); }
  [[nodiscard]] const Error& error() const { return std::get<Error>(content_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, Error> content_;
};

// For operations that give nothing but success.
using Status = Result<std::monostate>;
inline Status success() { return std::monostate{}; }

}  // namespace lxd
