// SPDX-License-Identifier: Apache-2.0
// The runtime's one block of memory. It is static, so that the loader refuses a machine that cannot hold it, and so
// that nothing of the real-time path ever comes from the heap.
#pragma once

#include "rt/arena.hpp"
#include "rt/result.hpp"

namespace lxd {

// An arena over the static block of the board profile. Once a process: two arenas would share their bytes.
Arena static_arena();

// Refuses an arena that was asked for more than it holds; the message is the table of cuts with the sum.
Status check_fits(const Arena& arena);

// The memory budget: pools by name, element size, count, bytes, MiB; what the process takes beside them at most; and
// the total, as a table for people.
std::string budget_table(const Arena& arena);
// The same as JSON: {"pools": [{"name", "pools", "element_bytes", "count", "bytes"}], "pools_bytes", "capacity_bytes",
// "beside_bytes", "total_bytes"}.
std::string budget_json(const Arena& arena);

// Large blocks, such as a sub-mesh's triangles on their way into a file, go back to the system when they are freed. The
// C library would otherwise learn to keep them, and the process would grow with every sub-mesh. Once, at start-up.
void return_large_blocks();

}  // namespace lxd
