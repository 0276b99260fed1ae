// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/simulate_arguments.h"

#include <fmt/format.h>

#include "kestrel/app/cli/camera_file.h"

namespace kestrel {

void SimulateArguments::AddTo(CLI::App* command) {
  CLI::Option* output_option =
      command->add_option("--output", output, "Folder for the recording")->type_name("DIR");
  command
      ->add_option("--seed", seed,
                   "Seed of all random numbers; the same seed gives the same recording (default 1)")
      ->type_name("N");
  command->add_option("--scenario", scenario, "A named flight, see --list")->type_name("NAME");
  command
      ->add_option("--config", config,
                   "Options from a YAML file (see --print-config), over the scenario's")
      ->type_name("FILE");
  command->add_option("--set", settings, "One option, as key=value; can be given several times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--camera", camera, "Calibration of the camera to simulate")
      ->type_name("FILE");
  command->add_flag("--force", force, "Replace a recording that exists");
  CLI::Option* list_flag = command->add_flag("--list", list, "Print the scenarios");
  CLI::Option* print_flag = command->add_flag("--print-config", print_config,
                                              "Print all options with their values, as YAML");
  command->parse_complete_callback([=] {
    if (output_option->count() + list_flag->count() + print_flag->count() == 0) {
      throw CLI::RequiredError("--output");
    }
  });
}

std::vector<std::string> SimulateArguments::AllSettings() const {
  std::vector<std::string> all = settings;
  target.AppendTo(&all, "target");
  return all;
}

CameraCalibration SimulateArguments::FindCamera(const CameraCalibration& by_default) const {
  if (camera.empty()) return by_default;
  CameraCalibration calibration = ReadCameraFile(camera);
  if (!calibration.body_from_camera) calibration.body_from_camera = by_default.body_from_camera;
  return calibration;
}

void PrintScenarios(std::span<const Scenario> scenarios) {
  for (const Scenario& scenario : scenarios) {
    fmt::print("{:<12}{}\n", scenario.name, scenario.meaning);
  }
}

}  // namespace kestrel
