// SPDX-License-Identifier: Apache-2.0
// The little of SQLite that the map archive needs, with owned handles and errors as values.
// One thread at a time per Database.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <sqlite3.h>

#include "rt/result.hpp"

namespace lxd {

class Statement {
 public:
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

  // Parameters count from 1. Text and blobs are lent: they must live until the statement has been stepped or reset.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::byte> blob);

  // True: there is a row. False: done.
  Result<bool> step();
  // Steps to the end and makes ready for the next round.
  Status run();

  // Columns count from 0; what is returned for a blob lives until the next step.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::span<const std::byte> blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bind_code_ = SQLITE_OK;  // first failure of bind, told by step
};

// A blob in the file, read without a copy of it in between.
class Blob {
 public:
  explicit Blob(sqlite3_blob* blob) : blob_(blob) {}
  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(sqlite3_blob_bytes(blob_.get())); }
  // Its first out.size() bytes; false when they cannot be read.
  [[nodiscard]] bool read(std::span<std::byte> out) const {
    return sqlite3_blob_read(blob_.get(), out.data(), static_cast<int>(out.size()), 0) == SQLITE_OK;
  }

 private:
  struct Close {
    void operator()(sqlite3_blob* b) const { sqlite3_blob_close(b); }
  };
  std::unique_ptr<sqlite3_blob, Close> blob_;
};

class Database {
 public:
  // flags: SQLITE_OPEN_...
  static Result<Database> open(const std::filesystem::path& path, int flags);
  // One or several statements without results.
  [[nodiscard]] Status execute(const std::string& sql) const;
  [[nodiscard]] Result<Statement> prepare(std::string_view sql) const;
  struct BlobPlace {
    const char* table;
    const char* column;
    std::int64_t row;
  };
  // Error as well where there is no such blob.
  [[nodiscard]] Result<Blob> open_blob(const BlobPlace& place) const;

 private:
  struct Close {
    void operator()(sqlite3* d) const { sqlite3_close_v2(d); }
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}
  std::unique_ptr<sqlite3, Close> handle_;
};

// Everything between construction and commit() happens, or nothing of it. One may be within another.
class Transaction {
 public:
  explicit Transaction(const Database& database) : database_(database), begun_(database.execute("SAVEPOINT step")) {}
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  [[nodiscard]] const Status& begun() const { return begun_; }
  Status commit();

 private:
  const Database& database_;
  Status begun_;
  bool committed_ = false;
};

}  // namespace lxd
