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

constexpr const char* kSubmeshColumns = "id, session, piece, first_ns, last_ns, T_map_submesh";
constexpr const char* kIsColoured = "EXISTS (SELECT 1 FROM colour WHERE submesh = id)";

// The row under the cursor, checked. Storage is the caller's.
struct SubmeshRow {
  SubmeshSurface surface;
  std::vector<SubmeshKeyFrame> key_frames;

  // The cause when the record is damaged, else empty.
  std::string read(const Database& database, const Statement& row, SubmeshView& view) {
    const std::int64_t id = row.integer(0);
    auto& [vertices, faces, colours] = surface;
    const auto T = unpack_pose(row.blob(5));
    if (!T) return "pose is not twelve finite numbers";
    const Result<bool> has_vertices = read_array(database, {"submesh", "vertices", id}, vertices);
    if (!has_vertices.ok()) return has_vertices.error().message;
    if (!*has_vertices) return "vertices are not whole";
    const Result<bool> has_faces = read_array(database, {"submesh", "faces", id}, faces);
    if (!has_faces.ok()) return has_faces.error().message;
    if (!*has_faces) return "faces are not whole";
    if (!names_existing_vertices(faces, vertices.size())) return "a face names a vertex that does not exist";
    if (std::string damage = read_key_frames(database, id); !damage.empty()) return damage;
    if (std::string damage = read_colours(database, id, row.integer(6) != 0); !damage.empty()) return damage;
    const RigTime first = RigTime::from_ns(row.integer(3)), last = RigTime::from_ns(row.integer(4));
    view = {id, row.integer(1), row.integer(2), *T, first, last, vertices, faces, key_frames, colours};
    return "";
  }

  std::string read_colours(const Database& database, std::int64_t id, bool coloured) {
    surface.colours.clear();
    if (!coloured) return "";
    const Result<bool> whole = read_array(database, {"colour", "colours", id}, surface.colours);
    if (!whole.ok()) return whole.error().message;
    return *whole && surface.colours.size() == surface.vertices.size() ? "" : "colours are not one a vertex";
  }

  std::string read_key_frames(const Database& database, std::int64_t id) {
    key_frames.clear();
    Result<Statement> rows =
        database.prepare("SELECT stamp_ns, T_submesh_body FROM keyframe WHERE submesh = ? ORDER BY stamp_ns");
    if (!rows.ok()) return rows.error().message;
    Result<bool> row = rows->bind(1, id).step();
    for (; row.ok() && *row; row = rows->step()) {
      const auto T = unpack_pose(rows->blob(1));
      if (!T) return "a key frame's pose is not twelve finite numbers";
      key_frames.push_back({RigTime::from_ns(rows->integer(0)), *T});
    }
    return row.ok() ? "" : row.error().message;
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
      "SELECT total(piece = 0), total(length(vertices) * (piece = 0)), total(length(faces) * (piece = 0)), "
      "(SELECT count(*) FROM pose WHERE session = (SELECT max(session) FROM pose)), total(piece != 0), "
      "max(ifnull(max(session), -1), ifnull((SELECT max(session) FROM pose), -1)) + 1, ifnull(max(id), -1) "
      "FROM submesh");
  if (!sums.ok()) return sums.error();
  if (const Result<bool> row = sums->step(); !row.ok()) return row.error();
  const auto number = [&](int column) { return static_cast<std::uint64_t>(sums->integer(column)); };
  totals_ = {number(0),
             number(1) / sizeof(MeshVertex),
             number(2) / sizeof(MeshFace),
             number(3),
             number(4),
             sums->integer(5),
             sums->integer(6),
             0};
  return count_coloured();
}

Status Archive::count_coloured() {
  const Result<bool> any = has_colours(database_);
  if (!any.ok()) return any.error();
  if (!*any) return success();
  Result<Statement> coloured =
      database_.prepare("SELECT count(*) FROM colour JOIN submesh ON submesh.id = colour.submesh WHERE piece = 0");
  if (!coloured.ok()) return coloured.error();
  if (const Result<bool> row = coloured->step(); !row.ok()) return row.error();
  totals_.submeshes_coloured = static_cast<std::uint64_t>(coloured->integer(0));
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
  return edit_each_submesh([&](const SubmeshView& view, SubmeshSurface&) { return visit(view); });
}

Status Archive::edit_each_submesh(const SubmeshEditor& edit) const {
  Result<Statement> rows = database_.prepare(fmt::format("SELECT {}, {} FROM submesh WHERE piece = 0 ORDER BY id",
                                                         kSubmeshColumns, totals_.coloured() ? kIsColoured : "0"));
  if (!rows.ok()) return rows.error();
  SubmeshRow storage;
  SubmeshView view;
  Result<bool> row = rows->step();
  for (; row.ok() && *row; row = rows->step()) {
    if (const std::string damage = storage.read(database_, *rows, view); !damage.empty())
      return Error{fmt::format("{}: sub-mesh {}: {}", path_.string(), rows->integer(0), damage)};
    if (const Status edited = edit(view, storage.surface); !edited.ok()) return edited;
  }
  return row.ok() ? success() : Status(row.error());
}

bool Archive::read_vertices(std::int64_t submesh, std::vector<MeshVertex>& vertices) const {
  const Result<bool> whole = read_array(database_, {"submesh", "vertices", submesh}, vertices);
  return whole.ok() && *whole;
}

bool Archive::read_colours(std::int64_t submesh, std::vector<VertexColour>& colours) const {
  const Result<bool> whole = read_array(database_, {"colour", "colours", submesh}, colours);
  return whole.ok() && *whole;
}

Result<std::vector<StampedPose>> Archive::poses(std::optional<std::int64_t> session) const {
  Result<Statement> rows =
      database_.prepare("SELECT stamp_ns, T_map_reference FROM pose WHERE session = ? ORDER BY stamp_ns");
  if (!rows.ok()) return rows.error();
  rows->bind(1, session.value_or(totals_.sessions - 1));
  std::vector<StampedPose> poses;
  poses.reserve(static_cast<std::size_t>(totals_.poses));
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
