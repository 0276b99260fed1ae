// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/target_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {

void TargetArguments::AddTo(CLI::App* command, const std::string& size_name) {
  command
      ->add_option(
          "--target", kind,
          fmt::format("The pad: {} (default: as configured)", fmt::join(TargetKinds(), ", ")))
      ->type_name("KIND");
  command->add_option("--target-id", id, "Id of the pad, where that is one tag")->type_name("ID");
  command
      ->add_option(size_name, size_m,
                   "Size of the pad (m), to which all its dimensions are scaled: outer diameter of "
                   "the ring, side of the (largest) tag, size of the helipad's frame")
      ->type_name("M");
}

void TargetArguments::AppendTo(std::vector<std::string>* settings,
                               const std::string& section) const {
  if (!kind.empty()) settings->push_back(fmt::format("{}.kind={}", section, kind));
  if (id) settings->push_back(fmt::format("{}.id={}", section, *id));
  if (size_m) settings->push_back(fmt::format("{}.size_m={}", section, *size_m));
}

}  // namespace kestrel
