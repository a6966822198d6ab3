// SPDX-License-Identifier: Apache-2.0
// Buffered file output over POSIX calls, because a stream tells neither the cause of a failure nor syncs to the disk.
#include "backend/part_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace lxd {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;
constexpr int kFileMode = 0644;

}  // namespace

Result<PartFile> PartFile::create(const std::filesystem::path& path) {
  const std::string part = path.string() + ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (descriptor < 0) return Error{fmt::format("{}: cannot be written: {}", part, std::strerror(errno))};
  return PartFile(descriptor, path);
}

PartFile::PartFile(int descriptor, std::filesystem::path path) : descriptor_(descriptor), path_(std::move(path)) {
  buffer_.reserve(kBufferBytes);
}

PartFile::PartFile(PartFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      cause_(other.cause_),
      flushed_(other.flushed_),
      path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)) {}

PartFile::~PartFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(part_path().c_str());
}

void PartFile::write(std::span<const std::byte> bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) flush();
  if (bytes.size() > kBufferBytes) {
    write_through(bytes, flushed_);
    flushed_ += ok() ? bytes.size() : 0;
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
}

void PartFile::write_text(std::string_view text) { write(std::as_bytes(std::span(text))); }

void PartFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
  flush();
  write_through(bytes, offset);
}

void PartFile::flush() {
  write_through(buffer_, flushed_);
  flushed_ += ok() ? buffer_.size() : 0;
  buffer_.clear();
}

void PartFile::resume() {
  buffer_.clear();
  cause_ = ::ftruncate(descriptor_, static_cast<off_t>(flushed_)) == 0 ? 0 : errno;
}

void PartFile::write_through(std::span<const std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty() && ok()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      cause_ = written < 0 ? errno : EIO;
      return;
    }
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

Status PartFile::status() const {
  if (ok()) return success();
  return Error{fmt::format("{}: writing failed after {} bytes: {}", path_.string(), flushed_, std::strerror(cause_))};
}

Status PartFile::commit() {
  flush();
  if (ok() && ::fsync(descriptor_) != 0) cause_ = errno;
  if (!ok()) return status();
  ::close(std::exchange(descriptor_, -1));
  if (::rename(part_path().c_str(), path_.c_str()) == 0) return success();
  return Error{
      fmt::format("{}: cannot be renamed to {}: {}", part_path().string(), path_.string(), std::strerror(errno))};
}

std::filesystem::path PartFile::part_path() const { return path_.string() + ".part"; }

}  // namespace lxd
