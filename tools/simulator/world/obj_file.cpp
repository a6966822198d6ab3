// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/obj_file.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

class Words {
 public:
  explicit Words(std::string_view line) : rest_(line.substr(0, line.find('#'))) {}

  // Empty at the end.
  std::string_view next() {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    const std::size_t begin = rest_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return rest_ = {};
    rest_.remove_prefix(begin);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    return word;
  }

 private:
  std::string_view rest_;
};

template <typename T>
bool parse(std::string_view word, T& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

// The cause when the statement is not as it should be, else empty.
std::string add_vertex(Words& words, TriangleMesh& mesh) {
  Eigen::Vector3d p;
  for (double& value : p) {
    const std::string_view word = words.next();
    if (!parse(word, value) || !std::isfinite(value)) return fmt::format("found '{}', wanted a finite number", word);
  }
  mesh.vertices_m.push_back(p);
  return "";
}

std::string add_face(Words& words, TriangleMesh& mesh, std::vector<std::uint32_t>& corners) {
  corners.clear();
  const auto count = static_cast<std::int64_t>(mesh.vertices_m.size());
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    std::int64_t index = 0;
    if (!parse(word.substr(0, word.find('/')), index)) return fmt::format("found '{}', wanted a vertex's number", word);
    const std::int64_t from_zero = index > 0 ? index - 1 : count + index;
    if (index == 0 || from_zero < 0 || from_zero >= count)
      return fmt::format("found vertex {}, wanted one of the {} before this line", index, count);
    corners.push_back(static_cast<std::uint32_t>(from_zero));
  }
  if (corners.size() < 3) return fmt::format("found a face of {} vertices, wanted at least 3", corners.size());
  for (std::size_t i = 2; i < corners.size(); ++i) mesh.faces.push_back({corners[0], corners[i - 1], corners[i]});
  return "";
}

}  // namespace

Result<TriangleMesh> load_mesh_obj(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  TriangleMesh mesh;
  std::vector<std::uint32_t> corners;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    Words words(line);
    const std::string_view keyword = words.next();
    std::string wrong;
    if (keyword == "v") wrong = add_vertex(words, mesh);
    if (keyword == "f") wrong = add_face(words, mesh, corners);
    if (!wrong.empty()) return Error{fmt::format("{}:{}: {}", path.string(), number, wrong)};
  }
  if (file.bad()) return Error{fmt::format("{}: cannot be read to its end", path.string())};
  return mesh;
}

}  // namespace lxd::sim
