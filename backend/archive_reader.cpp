// SPDX-License-Identifier: Apache-2.0
// Reading the map archive, one sub-mesh at a time; nothing in the file is believed before it is checked.
#include <algorithm>

#include <fmt/format.h>

#include "backend/archive.hpp"
#include "backend/archive_format.hpp"

namespace lxd {
namespace {

// Reads a blob into an array that is reused from one sub-mesh to the next. False: not a whole number of elements.
template <typename T>
Result<bool> read_array(const Database& database, const Database::BlobPlace& place, std::vector<T>& out) {
  const Result<Blob> blob = database.open_blob(place);
  if (!blob.ok()) return blob.error();
  if (blob->bytes() % sizeof(T) != 0) return false;
  const std::size_t count = blob->bytes() / sizeof(T);
  if (count > out.capacity()) std::vector<T>().swap(out);  // not both at once
  out.resize(count);
  return out.empty() || blob->read(std::as_writable_bytes(std::span(out)));
}

bool names_existing_vertices(std::span<const MeshFace> faces, std::size_t vertices) {
  return std::ranges::all_of(faces, [vertices](const MeshFace& face) {
    return std::ranges::all_of(face, [vertices](std::uint32_t v) { return v < vertices; });
  });
}

// The row under the cursor, checked. Storage is the caller's.
struct SubmeshRow {
  std::vector<MeshVertex> vertices;
  std::vector<MeshFace> faces;

  // The cause when the record is damaged, else empty.
  std::string read(const Database& database, const Statement& row, SubmeshView& view) {
    const std::int64_t id = row.integer(0);
    const auto T = unpack_pose(row.blob(3));
    if (!T) return "pose is not twelve finite numbers";
    const Result<bool> has_vertices = read_array(database, {"submesh", "vertices", id}, vertices);
    if (!has_vertices.ok()) return has_vertices.error().message;
    if (!*has_vertices) return "vertices are not whole";
    const Result<bool> has_faces = read_array(database, {"submesh", "faces", id}, faces);
    if (!has_faces.ok()) return has_faces.error().message;
    if (!*has_faces) return "faces are not whole";
    if (!names_existing_vertices(faces, vertices.size())) return "a face names a vertex that does not exist";
    view = {id, *T, RigTime::from_ns(row.integer(1)), RigTime::from_ns(row.integer(2)), vertices, faces};
    return "";
  }
};

}  // namespace

Result<Archive> Archive::open(const std::filesystem::path& path) {
  if (const Status known = check_archive_header(path); !known.ok()) return known.error();
  Result<Database> database = Database::open(path, SQLITE_OPEN_READONLY);
  if (!database.ok()) return database.error();
  Archive archive(path, std::move(*database));
  if (const Status counted = archive.count(); !counted.ok()) return counted.error();
  return archive;
}

// length() of a blob is read from the record's header, not by loading the blob.
Status Archive::count() {
  Result<Statement> sums = database_.prepare(
      "SELECT count(*), total(length(vertices)), total(length(faces)), (SELECT count(*) FROM pose) FROM submesh");
  if (!sums.ok()) return sums.error();
  if (const Result<bool> row = sums->step(); !row.ok()) return row.error();
  const auto number = [&](int column) { return static_cast<std::uint64_t>(sums->integer(column)); };
  totals_ = {number(0), number(1) / sizeof(MeshVertex), number(2) / sizeof(MeshFace), number(3)};
  return success();
}

Result<std::map<std::string, std::string>> Archive::meta() const {
  Result<Statement> rows = database_.prepare("SELECT key, value FROM meta");
  if (!rows.ok()) return rows.error();
  std::map<std::string, std::string> meta;
  Result<bool> row = rows->step();
  for (; row.ok() && *row; row = rows->step()) meta.emplace(rows->text(0), rows->text(1));
  if (!row.ok()) return row.error();
  return meta;
}

Status Archive::for_each_submesh(const SubmeshVisitor& visit) const {
  Result<Statement> rows = database_.prepare("SELECT id, first_ns, last_ns, T_map_submesh FROM submesh ORDER BY id");
  if (!rows.ok()) return rows.error();
  SubmeshRow storage;
  SubmeshView view;
  Result<bool> row = rows->step();
  for (; row.ok() && *row; row = rows->step()) {
    if (const std::string damage = storage.read(database_, *rows, view); !damage.empty())
      return Error{fmt::format("{}: sub-mesh {}: {}", path_.string(), rows->integer(0), damage)};
    if (const Status visited = visit(view); !visited.ok()) return visited;
  }
  return row.ok() ? success() : Status(row.error());
}

Result<std::vector<StampedPose>> Archive::poses() const {
  Result<Statement> rows = database_.prepare("SELECT stamp_ns, T_map_reference FROM pose ORDER BY stamp_ns");
  if (!rows.ok()) return rows.error();
  std::vector<StampedPose> poses;
  poses.reserve(totals_.poses);
  Result<bool> row = rows->step();
  for (; row.ok() && *row; row = rows->step()) {
    const auto T = unpack_pose(rows->blob(1));
    if (!T)
      return Error{fmt::format("{}: pose at {} ns is not twelve finite numbers", path_.string(), rows->integer(0))};
    poses.push_back({RigTime::from_ns(rows->integer(0)), *T});
  }
  if (!row.ok()) return row.error();
  return poses;
}

}  // namespace lxd
