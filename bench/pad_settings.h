// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {

// The pad of a benchmark, the number of its descents or frames, and the seed of the first.
struct PadSettings {
  TargetOptions target;
  int count;
  std::uint64_t seed = 1;
};

// Adds the options of a program to 'app'. 'counted': name of the option of the count, and 'what' it
// counts.
inline void AddOptions(CLI::App* app, const std::string& counted, const std::string& what,
                       PadSettings* settings) {
  app->add_option("--target", settings->target.kind, "Kind of the pad (ring-cross)");
  app->add_option("--board", settings->target.nested.board,
                  "Board of nested and ring-with-tags, as in examples/boards");
  app->add_option("--" + counted, settings->count, fmt::format("{} ({})", what, settings->count))
      ->check(CLI::Range(1, 100000));
  app->add_option("--seed", settings->seed, "Seed of the first (1)");
}

}  // namespace kestrel
