// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 binary of the whole map (Khronos glTF 2.0 specification, section 4). Vertices are written as the archive
// stores them: one interleaved buffer view a sub-mesh. Two passes: bounds and sizes for the JSON, then the
// bytes.
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "backend/archive_format.hpp"
#include "backend/colour/srgb.hpp"
#include "backend/mesh_export.hpp"
#include "backend/part_file.hpp"
#include "backend/seams/fused_map.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kChunkJson = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kChunkBinary = 0x004E4942;
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kUnsignedShort = 5123;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::size_t kNormalAt = 12;  // in MeshVertex
constexpr std::size_t kVarianceAt = 24;
constexpr std::uint64_t kAlignment = 4;

using nlohmann::json;

json to_json(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

// Column by column, as glTF wants it.
json to_json(const Pose& T) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = T.R;
  matrix.topRightCorner<3, 1>() = T.p;
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

Pose z_up_to_y_up() {
  Pose T;
  T.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return T;
}

// COLOR_0: red, green, blue, and whether it is known; parts of 65535.
using GltfColour = std::array<std::uint16_t, 4>;

GltfColour gltf_colour(const VertexColour& colour) {
  constexpr float kWhole = 65535;
  const auto part = [](std::uint8_t level) { return static_cast<std::uint16_t>(kWhole * light_of(level) + 0.5F); };
  const auto known = static_cast<std::uint16_t>(colour.known() ? kWhole : 0);
  return {part(colour.red), part(colour.green), part(colour.blue), known};
}

bool has_surface(const SubmeshView& submesh) { return !submesh.faces.empty(); }

// The JSON chunk, grown sub-mesh by sub-mesh.
class Document {
 public:
  explicit Document(bool coloured) : coloured_(coloured) {}

  void add(const SubmeshView& submesh) {
    const std::size_t vertices = view(submesh.vertices.size_bytes(), kArrayBuffer);
    document_["bufferViews"][vertices]["byteStride"] = sizeof(MeshVertex);
    const std::size_t faces = view(submesh.faces.size_bytes(), kElementArrayBuffer);
    const std::size_t count = submesh.vertices.size();
    const std::size_t position = accessor(vertices, 0, kFloat, count, "VEC3");
    set_bounds(position, submesh.vertices);
    json attributes = {{"POSITION", position},
                       {"NORMAL", accessor(vertices, kNormalAt, kFloat, count, "VEC3")},
                       {"_VARIANCE", accessor(vertices, kVarianceAt, kFloat, count, "SCALAR")}};
    if (coloured_) {
      const std::size_t colours = view(count * sizeof(GltfColour), kArrayBuffer);
      attributes["COLOR_0"] = accessor(colours, 0, kUnsignedShort, count, "VEC4");
      document_["accessors"].back()["normalized"] = true;
    }
    const json primitive = {{"attributes", attributes},
                            {"indices", accessor(faces, 0, kUnsignedInt, 3 * submesh.faces.size(), "SCALAR")},
                            {"material", 0}};
    document_["meshes"].push_back({{"primitives", json::array({primitive})}});
    nodes_.push_back({{"name", fmt::format("submesh {}", submesh.id)},
                      {"mesh", nodes_.size()},
                      {"matrix", to_json(submesh.T_map_submesh)}});
  }

  [[nodiscard]] std::string text() {
    document_["asset"] = {{"version", "2.0"}, {"generator", "LXD-SLAM"}};
    document_["scene"] = 0;
    document_["scenes"] = json::array({json::object()});
    if (!nodes_.empty()) add_tree();
    std::string text = document_.dump();
    text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
    return text;
  }

  [[nodiscard]] std::uint64_t binary_bytes() const { return bytes_; }

 private:
  std::size_t view(std::size_t bytes, int target) {
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
    bytes_ += bytes;
    return document_["bufferViews"].size() - 1;
  }

  std::size_t accessor(std::size_t view, std::size_t offset, int component, std::size_t count, const char* type) {
    document_["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", offset}, {"componentType", component}, {"count", count}, {"type", type}});
    return document_["accessors"].size() - 1;
  }

  void set_bounds(std::size_t accessor, std::span<const MeshVertex> vertices) {
    Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector3f high = -low;
    for (const MeshVertex& v : vertices) {
      low = low.cwiseMin(v.position_m);
      high = high.cwiseMax(v.position_m);
    }
    document_["accessors"][accessor]["min"] = to_json(low);
    document_["accessors"][accessor]["max"] = to_json(high);
  }

  // Node 0 turns the axes; its children are the sub-meshes.
  void add_tree() {
    json children = json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) children.push_back(i + 1);
    json nodes = json::array({{{"name", "map"}, {"matrix", to_json(z_up_to_y_up())}, {"children", children}}});
    nodes.insert(nodes.end(), nodes_.begin(), nodes_.end());
    document_["nodes"] = nodes;
    document_["scenes"][0]["nodes"] = {0};
    document_["buffers"] = json::array({{{"byteLength", bytes_}}});
    const json surface = {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
    document_["materials"] = json::array({{{"doubleSided", true}, {"pbrMetallicRoughness", surface}}});
  }

  bool coloured_;
  json document_;
  json nodes_ = json::array();
  std::uint64_t bytes_ = 0;
};

void write_chunk_header(PartFile& file, std::uint64_t bytes, std::uint32_t type) {
  file.write_value(static_cast<std::uint32_t>(bytes));
  file.write_value(type);
}

void write_colours(PartFile& file, const SubmeshView& submesh) {
  for (std::size_t i = 0; i < submesh.vertices.size(); ++i)
    file.write_value(gltf_colour(submesh.colours.empty() ? VertexColour{} : submesh.colours[i]));
}

constexpr std::uint64_t kFileHeaderBytes = 12;
constexpr std::uint64_t kChunkHeaderBytes = 8;

std::uint64_t file_bytes(std::uint64_t json_bytes, std::uint64_t binary_bytes) {
  const std::uint64_t binary_chunk = binary_bytes > 0 ? kChunkHeaderBytes + binary_bytes : 0;
  return kFileHeaderBytes + kChunkHeaderBytes + json_bytes + binary_chunk;
}

void write_head(PartFile& file, const std::string& text, std::uint64_t binary_bytes) {
  constexpr std::uint32_t kVersion = 2;
  file.write_value(kMagic);
  file.write_value(kVersion);
  file.write_value(static_cast<std::uint32_t>(file_bytes(text.size(), binary_bytes)));
  write_chunk_header(file, text.size(), kChunkJson);
  file.write_text(text);
  if (binary_bytes > 0) write_chunk_header(file, binary_bytes, kChunkBinary);
}

}  // namespace

Status write_mesh_glb(const std::filesystem::path& path, const Archive& archive) {
  const Result<FusedMap> map = FusedMap::create(archive, path.parent_path());
  if (!map.ok()) return map.error();
  const bool coloured = map->totals().coloured();
  Document document(coloured);
  const Status described = map->for_each_submesh([&](const SubmeshView& submesh) {
    if (has_surface(submesh)) document.add(submesh);
    return success();
  });
  if (!described.ok()) return described;
  const std::string text = document.text();
  if (file_bytes(text.size(), document.binary_bytes()) > std::numeric_limits<std::uint32_t>::max())
    return Error{
        fmt::format("{}: GLB ends at 4 GiB, the mesh has {} bytes; use PLY", path.string(), document.binary_bytes())};
  Result<PartFile> file = PartFile::create(path);
  if (!file.ok()) return file.error();
  write_head(*file, text, document.binary_bytes());
  const Status written = map->for_each_submesh([&](const SubmeshView& submesh) {
    if (!has_surface(submesh)) return success();
    file->write_values(submesh.vertices);
    file->write_values(submesh.faces);
    if (coloured) write_colours(*file, submesh);
    return file->status();
  });
  return written.ok() ? file->commit() : written;
}

}  // namespace lxd
