// SPDX-License-Identifier: Apache-2.0
#include "board/memory.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <malloc.h>
#include <nlohmann/json.hpp>

#include "board/default/capacities.hpp"

namespace lxd {
namespace {

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(capacities::kMebibyte); }

constexpr std::string_view kPools = "all pools";
constexpr std::string_view kBeside = "program, libraries, stacks, files";
constexpr std::string_view kTotal = "total";

// Equal pools, as those of the sub-meshes, are one row.
struct PoolRow {
  ArenaCut cut;  // bytes: of all of them
  std::size_t pools = 1;
};

std::vector<PoolRow> rows_of(const Arena& arena) {
  std::vector<PoolRow> rows;
  for (const ArenaCut& cut : arena.cuts()) {
    const auto same = std::ranges::find_if(rows, [&](const PoolRow& row) {
      return row.cut.name == cut.name && row.cut.element_bytes == cut.element_bytes && row.cut.count == cut.count;
    });
    if (same == rows.end()) {
      rows.push_back({cut});
    } else {
      ++same->pools;
      same->cut.bytes += cut.bytes;
    }
  }
  return rows;
}

std::size_t name_width(const Arena& arena) {
  std::size_t width = kBeside.size();
  for (const ArenaCut& cut : arena.cuts()) width = std::max(width, cut.name.size());
  return width;
}

std::size_t total_bytes(const Arena& arena) { return arena.wanted_bytes() + capacities::kOutsideArenaBytes; }

}  // namespace

Arena static_arena() {
  alignas(Arena::kAlignment) static std::array<std::byte, capacities::kArenaBytes> block;
  return Arena(block);
}

void return_large_blocks() {
#ifdef __GLIBC__
  constexpr int kLarge_bytes = 256 * 1024;
  (void)mallopt(M_MMAP_THRESHOLD, kLarge_bytes);
#endif
}

Status check_fits(const Arena& arena) {
  if (!arena.exhausted()) return success();
  return Error{fmt::format("memory: this rig wants {} bytes ({:.1f} MiB) of the profile's {} ({:.1f} MiB):\n{}",
                           arena.wanted_bytes(), mebibytes(arena.wanted_bytes()), arena.capacity_bytes(),
                           mebibytes(arena.capacity_bytes()), budget_table(arena))};
}

std::string budget_table(const Arena& arena) {
  const std::size_t width = name_width(arena);
  std::string table = fmt::format("{:<{}}  {:>5}  {:>13}  {:>9}  {:>11}  {:>8}\n", "pool", width, "pools",
                                  "element bytes", "count", "bytes", "MiB");
  for (const auto& [cut, pools] : rows_of(arena)) {
    table += fmt::format("{:<{}}  {:>5}  {:>13}  {:>9}  {:>11}  {:>8.2f}\n", cut.name, width, pools, cut.element_bytes,
                         cut.count, cut.bytes, mebibytes(cut.bytes));
  }
  const auto sum = [&](std::string_view name, std::size_t bytes) {
    table += fmt::format("{:<{}}  {:>5}  {:>13}  {:>9}  {:>11}  {:>8.2f}\n", name, width, "", "", "", bytes,
                         mebibytes(bytes));
  };
  sum(kPools, arena.wanted_bytes());
  sum(kBeside, capacities::kOutsideArenaBytes);
  sum(kTotal, total_bytes(arena));
  return table;
}

std::string budget_json(const Arena& arena) {
  nlohmann::ordered_json pools = nlohmann::ordered_json::array();
  for (const auto& [cut, count] : rows_of(arena)) {
    pools.push_back({{"name", cut.name},
                     {"pools", count},
                     {"element_bytes", cut.element_bytes},
                     {"count", cut.count},
                     {"bytes", cut.bytes}});
  }
  const nlohmann::ordered_json budget = {{"pools", pools},
                                         {"pools_bytes", arena.wanted_bytes()},
                                         {"capacity_bytes", arena.capacity_bytes()},
                                         {"beside_bytes", capacities::kOutsideArenaBytes},
                                         {"total_bytes", total_bytes(arena)}};
  return budget.dump(2) + "\n";
}

}  // namespace lxd
