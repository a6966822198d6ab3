// SPDX-License-Identifier: Apache-2.0
// Owned SQLite handles; every failure names the file, SQLite's message and the system's cause where there is one.
#include "backend/sqlite.hpp"

#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace lxd {
namespace {

Error error_of(sqlite3* handle, std::string_view file) {
  const int cause = sqlite3_system_errno(handle);
  const std::string system = cause != 0 ? fmt::format(" ({})", std::strerror(cause)) : "";
  return Error{fmt::format("{}: {}{}", file, sqlite3_errmsg(handle), system)};
}

Error error_of(sqlite3* handle) {
  const char* const file = sqlite3_db_filename(handle, "main");
  return error_of(handle, file != nullptr ? file : "database");
}

}  // namespace

Statement& Statement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(statement_.get(), parameter, value);
  if (bind_code_ == SQLITE_OK) bind_code_ = code;
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  const int code =
      sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
  if (bind_code_ == SQLITE_OK) bind_code_ = code;
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::byte> blob) {
  const void* const data = blob.empty() ? "" : static_cast<const void*>(blob.data());  // null would bind NULL
  const int code = sqlite3_bind_blob64(statement_.get(), parameter, data, blob.size(), SQLITE_STATIC);
  if (bind_code_ == SQLITE_OK) bind_code_ = code;
  return *this;
}

Result<bool> Statement::step() {
  if (bind_code_ != SQLITE_OK) return error_of(sqlite3_db_handle(statement_.get()));
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return error_of(sqlite3_db_handle(statement_.get()));
}

Status Statement::run() {
  Result<bool> row = step();
  while (row.ok() && *row) row = step();
  sqlite3_reset(statement_.get());
  bind_code_ = SQLITE_OK;
  return row.ok() ? success() : Status(row.error());
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto bytes = blob(column);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* const data = sqlite3_column_blob(statement_.get(), column);  // before the size, as SQLite asks
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::byte*>(data), data != nullptr ? static_cast<std::size_t>(size) : 0};
}

Result<Database> Database::open(const std::filesystem::path& path, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  Database database(handle);
  if (code != SQLITE_OK) return error_of(handle, path.string());
  return database;
}

Status Database::execute(const std::string& sql) const {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK) return success();
  return error_of(handle_.get());
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(handle_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr) != SQLITE_OK)
    return error_of(handle_.get());
  return Statement(statement);
}

Result<Blob> Database::open_blob(const BlobPlace& place) const {
  constexpr int kReadOnly = 0;
  sqlite3_blob* blob = nullptr;
  const int code = sqlite3_blob_open(handle_.get(), "main", place.table, place.column, place.row, kReadOnly, &blob);
  if (code != SQLITE_OK) return error_of(handle_.get());
  return Blob(blob);
}

Transaction::~Transaction() {
  if (begun_.ok() && !committed_) std::ignore = database_.execute("ROLLBACK TO step; RELEASE step");
}

Status Transaction::commit() {
  const Status done = database_.execute("RELEASE step");
  committed_ = done.ok();
  return done;
}

}  // namespace lxd
