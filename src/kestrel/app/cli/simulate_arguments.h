// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/app/cli/target_arguments.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/simulation/recordings/scenarios.h"

namespace kestrel {

// Arguments that all kinds of simulations share. Must live until the command line is parsed.
struct SimulateArguments {
  std::string output;
  std::string scenario;
  std::string config;
  std::vector<std::string> settings;
  std::string camera;
  TargetArguments target;  // its AddTo is for simulations of a landing
  std::uint64_t seed = 1;
  bool list = false;
  bool print_config = false;
  bool force = false;

  void AddTo(CLI::App* command);
  // Returns the settings, that of the target among them.
  std::vector<std::string> AllSettings() const;

  // Returns the calibration of the file, with the default's mount if it has none; without a file
  // the default.
  CameraCalibration FindCamera(const CameraCalibration& by_default) const;
};

void PrintScenarios(std::span<const Scenario> scenarios);

}  // namespace kestrel
