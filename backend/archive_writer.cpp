// SPDX-License-Identifier: Apache-2.0
// Writing the map archive: one transaction a sub-mesh.
#include <system_error>

#include <fmt/format.h>

#include "backend/archive.hpp"
#include "backend/archive_format.hpp"

namespace lxd {
namespace {

// Write-ahead log: a crash loses the transaction that was under way, never one before it. FULL syncs the log at each
// commit: a battery pulled out loses nothing that was appended, and at one sub-mesh a minute the sync costs nothing.
constexpr const char* kDurability = "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;";

std::span<const std::byte> bytes_of(const PackedPose& packed) { return std::as_bytes(std::span(packed)); }

Status remove_old(const std::filesystem::path& path) {
  for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) {
    std::error_code cause;
    std::filesystem::remove(path.string() + suffix, cause);
    if (cause) return Error{fmt::format("{}{}: cannot be replaced: {}", path.string(), suffix, cause.message())};
  }
  return success();
}

}  // namespace

Result<ArchiveWriter> ArchiveWriter::create(const std::filesystem::path& path) {
  if (const Status removed = remove_old(path); !removed.ok()) return removed.error();
  Result<Database> database = Database::open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!database.ok()) return database.error();
  // The tables come before the log, so that the file itself says from the first moment what it is.
  const std::string identity = fmt::format("BEGIN; PRAGMA application_id = {}; PRAGMA user_version = {}; {} COMMIT;",
                                           kArchiveApplicationId, kArchiveVersion, kArchiveSchema);
  if (const Status made = database->execute(identity); !made.ok()) return made.error();
  if (const Status durable = database->execute(kDurability); !durable.ok()) return durable.error();
  return ArchiveWriter(std::move(*database));
}

Status ArchiveWriter::set_meta(std::string_view key, std::string_view value) {
  Result<Statement> insert = database_.prepare("INSERT OR REPLACE INTO meta VALUES (?, ?)");
  if (!insert.ok()) return insert.error();
  return insert->bind(1, key).bind(2, value).run();
}

Status ArchiveWriter::append(const SubmeshView& submesh) {
  return all_or_nothing([&] {
    Result<Statement> insert = database_.prepare("INSERT OR REPLACE INTO submesh VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    if (!insert.ok()) return Status(insert.error());
    const PackedPose T = pack(submesh.T_map_submesh);
    insert->bind(1, submesh.id).bind(2, submesh.session).bind(3, submesh.piece);
    insert->bind(4, submesh.first.ns()).bind(5, submesh.last.ns()).bind(6, bytes_of(T));
    insert->bind(7, std::as_bytes(submesh.vertices)).bind(8, std::as_bytes(submesh.faces));
    Status done = insert->run();
    if (done.ok()) done = append_key_frames(submesh);
    if (!done.ok()) return done;
    return submesh.colours.empty() ? forget_colours(submesh.id) : set_colours(submesh.id, submesh.colours);
  });
}

Status ArchiveWriter::set_colours(std::int64_t submesh, std::span<const VertexColour> colours) {
  return all_or_nothing([&] {
    Status made =
        database_.execute(fmt::format("{} PRAGMA user_version = {};", kColourSchema, kColouredArchiveVersion));
    if (!made.ok()) return made;
    Result<Statement> insert = database_.prepare("INSERT OR REPLACE INTO colour VALUES (?, ?)");
    if (!insert.ok()) return Status(insert.error());
    return insert->bind(1, submesh).bind(2, std::as_bytes(colours)).run();
  });
}

// Those of an older surface of the same number.
Status ArchiveWriter::forget_colours(std::int64_t submesh) {
  const Result<bool> any = has_colours(database_);
  if (!any.ok()) return any.error();
  if (!*any) return success();
  Result<Statement> remove = database_.prepare("DELETE FROM colour WHERE submesh = ?");
  if (!remove.ok()) return remove.error();
  return remove->bind(1, submesh).run();
}

Status ArchiveWriter::append_key_frames(const SubmeshView& submesh) {
  Result<Statement> insert = database_.prepare("INSERT OR REPLACE INTO keyframe VALUES (?, ?, ?)");
  if (!insert.ok()) return insert.error();
  for (const SubmeshKeyFrame& frame : submesh.key_frames) {
    const PackedPose T = pack(frame.T_submesh_body);
    Status done = insert->bind(1, submesh.id).bind(2, frame.stamp.ns()).bind(3, bytes_of(T)).run();
    if (!done.ok()) return done;
  }
  return success();
}

Status ArchiveWriter::set_pose(std::int64_t submesh, const Pose& T_map_submesh, std::int64_t piece) {
  Result<Statement> update = database_.prepare("UPDATE submesh SET T_map_submesh = ?2, piece = ?3 WHERE id = ?1");
  if (!update.ok()) return update.error();
  const PackedPose T = pack(T_map_submesh);
  return update->bind(1, submesh).bind(2, bytes_of(T)).bind(3, piece).run();
}

Status ArchiveWriter::append_poses(std::span<const StampedPose> poses, std::int64_t session) {
  return all_or_nothing([&] {
    Result<Statement> insert = database_.prepare("INSERT OR REPLACE INTO pose VALUES (?, ?, ?)");
    if (!insert.ok()) return Status(insert.error());
    for (const StampedPose& pose : poses) {
      const PackedPose T = pack(pose.T);
      Status done = insert->bind(1, session).bind(2, pose.stamp.ns()).bind(3, bytes_of(T)).run();
      if (!done.ok()) return done;
    }
    return success();
  });
}

Status ArchiveWriter::all_or_nothing(const std::function<Status()>& work) {
  Transaction transaction(database_);
  if (!transaction.begun().ok()) return transaction.begun();
  Status done = work();
  return done.ok() ? transaction.commit() : done;
}

Status ArchiveWriter::finish() { return database_.execute("PRAGMA journal_mode = DELETE;"); }

}  // namespace lxd
