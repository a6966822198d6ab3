// SPDX-License-Identifier: Apache-2.0
// `errors.png`: what `evaluate` found, at one glance.
#pragma once

#include <filesystem>
#include <string>

#include "rt/result.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

// Position and attitude errors with the filter's three sigma, errors after alignment, drift, NEES and NIS, and of the
// mesh the distances and the reliability of its variance; rows of which nothing is known are left out. 1800 pixels
// wide. Error: the picture cannot be written.
Status write_error_plots(const std::filesystem::path& png, const EvaluationReport& report, const std::string& title);

}  // namespace lxd
