// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/growing_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>

namespace lxd {
namespace {

constexpr mode_t kEveryoneReads = 0644;

}  // namespace

Result<GrowingFile> GrowingFile::create(const std::filesystem::path& path) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kEveryoneReads));
  if (!file) return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
  return GrowingFile(std::move(file), path.string());
}

GrowingFile::GrowingFile(FileDescriptor file, std::string name) : file_(std::move(file)), name_(std::move(name)) {
  buffer_.reserve(kBufferBytes);
}

Status GrowingFile::append(std::initializer_list<Piece> pieces) {
  if (cause_ != 0) return fail();
  std::size_t bytes = 0;
  for (const Piece piece : pieces) bytes += piece.size();
  if (buffer_.size() + bytes > kBufferBytes) {
    Status flushed = flush();
    if (!flushed) return flushed;
  }
  for (const Piece piece : pieces) buffer_.insert(buffer_.end(), piece.begin(), piece.end());
  return success();
}

Status GrowingFile::flush() {
  if (cause_ != 0) return fail();
  Status written = write(buffer_);
  buffer_.clear();
  return written;
}

Status GrowingFile::write(Piece bytes) {
  const std::size_t all = bytes.size();
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_.get(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      cause_ = errno;
      // Half a record must not stay; cutting needs no room. What cannot be cut (a device) has no records to save.
      (void)!::ftruncate(file_.get(), static_cast<off_t>(flushed_));
      return fail();
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  flushed_ += all;
  return success();
}

Status GrowingFile::sync() {
  Status flushed = flush();
  if (!flushed) return flushed;
  // EINVAL: a file that has no disk below it.
  if (::fdatasync(file_.get()) != 0 && errno != EINVAL) {
    cause_ = errno;
    return fail();
  }
  return success();
}

Status GrowingFile::close() {
  Status synced = sync();
  file_.reset();
  return synced;
}

Status GrowingFile::fail() { return Error{fmt::format("{}: cannot be written: {}", name_, std::strerror(cause_))}; }

}  // namespace lxd
