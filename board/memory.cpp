// SPDX-License-Identifier: Apache-2.0
#include "board/memory.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "board/default/capacities.hpp"

namespace lxd {
namespace {

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(capacities::kMebibyte); }

std::size_t name_width(const Arena& arena) {
  std::size_t width = std::string_view("capacity").size();
  for (const ArenaCut& cut : arena.cuts()) width = std::max(width, cut.name.size());
  return width;
}

}  // namespace

Arena static_arena() {
  alignas(Arena::kAlignment) static std::array<std::byte, capacities::kArenaBytes> block;
  return Arena(block);
}

Status check_fits(const Arena& arena) {
  if (!arena.exhausted()) return success();
  return Error{fmt::format("memory: this rig wants {} bytes ({:.1f} MiB) of the profile's {} ({:.1f} MiB):\n{}",
                           arena.wanted_bytes(), mebibytes(arena.wanted_bytes()), arena.capacity_bytes(),
                           mebibytes(arena.capacity_bytes()), budget_table(arena))};
}

std::string budget_table(const Arena& arena) {
  const std::size_t width = name_width(arena);
  std::string table =
      fmt::format("{:<{}}  {:>13}  {:>9}  {:>11}  {:>8}\n", "pool", width, "element bytes", "count", "bytes", "MiB");
  for (const ArenaCut& cut : arena.cuts()) {
    table += fmt::format("{:<{}}  {:>13}  {:>9}  {:>11}  {:>8.2f}\n", cut.name, width, cut.element_bytes, cut.count,
                         cut.bytes, mebibytes(cut.bytes));
  }
  const auto sum = [&](std::string_view name, std::size_t bytes) {
    table += fmt::format("{:<{}}  {:>13}  {:>9}  {:>11}  {:>8.2f}\n", name, width, "", "", bytes, mebibytes(bytes));
  };
  sum("total", arena.wanted_bytes());
  sum("capacity", arena.capacity_bytes());
  return table;
}

std::string budget_json(const Arena& arena) {
  nlohmann::ordered_json pools = nlohmann::ordered_json::array();
  for (const ArenaCut& cut : arena.cuts()) {
    pools.push_back(
        {{"name", cut.name}, {"element_bytes", cut.element_bytes}, {"count", cut.count}, {"bytes", cut.bytes}});
  }
  const nlohmann::ordered_json budget = {
      {"pools", pools}, {"total_bytes", arena.wanted_bytes()}, {"capacity_bytes", arena.capacity_bytes()}};
  return budget.dump(2) + "\n";
}

}  // namespace lxd
