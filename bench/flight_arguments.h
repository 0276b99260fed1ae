// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace kestrel {

// Arguments of the benchmarks that fly.
struct FlightArguments {
  int flights = 20;
  std::uint64_t first_seed = 1;
  std::string only;

  bool Wants(std::string_view name) const { return name.find(only) != std::string_view::npos; }

  void AddTo(CLI::App* app) {
    app->add_option("--flights", flights, "Of each case, each with the next seed (20)")
        ->check(CLI::Range(1, 1000));
    app->add_option("--first-seed", first_seed, "Seed of the first flight (1)");
    app->add_option("--case", only, "Only the cases with this text in their name");
  }
};

}  // namespace kestrel
