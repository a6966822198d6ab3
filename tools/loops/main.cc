// SPDX-License-Identifier: Apache-2.0
// lxd-loop-quality: how good loop detection is on a finished run whose truth is known. Precision and recall over all
// pairs of key frames, the Extended Scan Context beside plain Scan Context; with --finder, the whole loop finder; or,
// with
// --found, the loops that the run itself found, by surfaces and by sight.
// For the desk, not for the rig.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "backend/loops/context_match.hpp"
#include "backend/loops/plain_context.hpp"
#include "tools/loops/curve.hpp"
#include "tools/loops/finder_trial.hpp"
#include "tools/loops/found_loops.hpp"
#include "tools/loops/places.hpp"

namespace lxd {
namespace {

struct Options {
  std::string run, truth;
  PlaceConfig places;
  double same_m = 4, other_m = 10, way_between_m = 60, plain_radius_m = 80, carrier_height_m = 2;
  bool curve = false, finder = false, found = false;
};

struct Detectors {
  std::vector<ScanContext> extended;
  std::vector<PlainContext> plain;
};

Detectors describe(const Places& all, const Options& options) {
  Detectors out;
  for (const Place& place : all.places) {
    const auto view =
        view_from(all.submeshes[static_cast<std::size_t>(place.submesh)], place, options.places.front_deg);
    out.extended.push_back(make_scan_context(view, place.T_submesh_body.p, ContextConfig{}));
    out.plain.push_back(
        make_plain_context(view, place.T_submesh_body.p, options.plain_radius_m, options.carrier_height_m));
  }
  return out;
}

void print(const char* name, const std::vector<ScoredPair>& pairs, bool points) {
  const Curve curve = precision_recall(pairs);
  fmt::print("{:24} {:10.3f} {:16.3f} {:10.4f}\n", name, curve.average_precision, curve.recall_at_full_precision,
             curve.threshold_at_full_precision);
  if (!points) return;
  for (const CurvePoint& p : curve.points) fmt::print("  {:.4f} {:.4f} {:.4f}\n", p.threshold, p.precision, p.recall);
}

int fail(const Error& error) {
  fmt::print(stderr, "lxd-loop-quality: {}\n", error.message);
  return 1;
}

int try_whole_finder(const Options& options) {
  const auto trial =
      try_finder(options.run, options.truth, {.finder = {}, .places = options.places, .same_m = options.same_m});
  if (!trial) return fail(trial.error());
  for (const TrialLoop& l : trial->loops)
    fmt::print("{:6} -> {:6}  {:.3f} m  {:.4f} rad  nees {:.1f}\n", l.loop.to, l.loop.from, l.error_m, l.error_rad,
               l.nees);
  const LoopCounters& c = trial->counters;
  fmt::print("proposed {}, accepted {}, false {}; revisited stretches {}, found {}\n", c.proposed, c.accepted(),
             trial->false_loops, trial->revisits, trial->found);
  fmt::print("rejected: little seen {}, little overlap {}, poor fit {}, moved away {}, ambiguous {}, open {}\n",
             c.verdicts[1], c.verdicts[2], c.verdicts[3], c.verdicts[4], c.verdicts[5], c.verdicts[6]);
  fmt::print("places {}, {:.1f} MB; a sub-mesh {:.1f} ms (max {:.1f}), a call {:.1f} ms (max {:.1f})\n", c.places,
             static_cast<double>(trial->bytes) * 1e-6, trial->add_ms_mean, trial->add_ms_max, trial->find_ms_mean,
             trial->find_ms_max);
  return 0;
}

int judge_run(const Options& options) {
  const auto loops = judge_found_loops(options.run, options.truth);
  if (!loops) return fail(loops.error());
  for (const std::string by : {"surfaces", "sight"}) {
    std::size_t found = 0, accepted = 0, false_found = 0, false_accepted = 0;
    std::vector<double> errors_m;
    for (const FoundLoop& l : *loops) {
      if (l.by != by) continue;
      fmt::print("{:8} {:.2f} -> {:.2f}  {:.3f} m  {:.4f} rad  claims {:.3f} m{}{}\n", by, l.to_s, l.from_s, l.error_m,
                 l.error_rad, l.sigma_m, l.accepted ? "" : "  not accepted", l.is_false() ? "  FALSE" : "");
      ++found;
      accepted += l.accepted ? 1 : 0;
      false_found += l.is_false() ? 1 : 0;
      false_accepted += l.accepted && l.is_false() ? 1 : 0;
      errors_m.push_back(l.error_m);
    }
    std::ranges::sort(errors_m);
    fmt::print("by {}: found {}, false {}; accepted {}, false {}; error median {:.3f} m, worst {:.3f} m\n", by, found,
               false_found, accepted, false_accepted, found > 0 ? errors_m[found / 2] : 0.0,
               found > 0 ? errors_m.back() : 0.0);
  }
  return 0;
}

int evaluate_pairs(const Options& options) {
  const auto all = load_places(options.run, options.truth, options.places);
  if (!all) return fail(all.error());
  const Detectors detectors = describe(*all, options);
  std::vector<ScoredPair> extended, plain;
  std::size_t same_count = 0;
  ContextMatcher matcher{ContextMatchConfig{}};
  for (std::size_t i = 0; i < all->places.size(); ++i) {
    matcher.set_query(detectors.extended[i]);
    for (std::size_t k = 0; k < i; ++k) {
      const Place &a = all->places[i], &b = all->places[k];
      const double apart_m = (a.T_truth_body.p - b.T_truth_body.p).norm();
      const bool same = apart_m < options.same_m;
      if (a.path_m - b.path_m < options.way_between_m || (!same && apart_m < options.other_m)) continue;
      same_count += same ? 1 : 0;
      extended.push_back({matcher.match(detectors.extended[k]).distance, same});
      plain.push_back({match_plain(detectors.plain[i], detectors.plain[k]).distance, same});
    }
  }
  fmt::print("{} key frames, {} pairs, {} of one place\n", all->places.size(), extended.size(), same_count);
  fmt::print("{:24} {:>10} {:>16} {:>10}\n", "", "avg. prec.", "recall at P = 1", "threshold");
  print("Extended Scan Context", extended, options.curve);
  print("Scan Context", plain, options.curve);
  return 0;
}

}  // namespace
}  // namespace lxd

int main(int argc, char** argv) {
  lxd::Options options;
  CLI::App app("Precision and recall of loop detection over all pairs of key frames of a run", "lxd-loop-quality");
  app.add_option("run", options.run, "A run's folder")->required();
  app.add_option("truth", options.truth, "Its recording's truth.tum")->required();
  app.add_option("--front", options.places.front_deg, "Keep so many degrees about the heading")->capture_default_str();
  app.add_option("--spacing", options.places.spacing_m, "Of key frames, m")->capture_default_str();
  app.add_option("--same", options.same_m, "Nearer is one place, m")->capture_default_str();
  app.add_option("--other", options.other_m, "Farther is another, m; between them does not count")
      ->capture_default_str();
  app.add_option("--way", options.way_between_m, "Least way between the two, m")->capture_default_str();
  app.add_option("--plain-radius", options.plain_radius_m, "Of plain Scan Context, m")->capture_default_str();
  app.add_option("--carrier-height", options.carrier_height_m, "Of plain Scan Context, m")->capture_default_str();
  app.add_flag("--finder", options.finder, "Take the run through the loop finder and judge its loops");
  app.add_flag("--found", options.found, "Judge the loops that the run found, by its report");
  app.add_flag("--curve", options.curve, "Print the curves: threshold, precision, recall");
  CLI11_PARSE(app, argc, argv);
  if (options.found) return lxd::judge_run(options);
  return options.finder ? lxd::try_whole_finder(options) : lxd::evaluate_pairs(options);
}
