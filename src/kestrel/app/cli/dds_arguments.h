// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/ros/ros_results.h"

namespace kestrel {

// --dds. Must live until the command line is parsed.
struct DdsArguments {
  std::optional<std::string> told;  // the domain; empty: that of ROS

  void AddTo(CLI::App* command);

  bool is_given() const { return told.has_value(); }

  // Also where the option is not given. Throws InputError when it is no domain.
  int Domain() const;

  // Throws InputError when that is not possible.
  std::shared_ptr<Ros2Node> OpenNode(const DdsOptions& options) const;
};

// The frames of results, as the options have them.
RosFrames OwnFrames(const DdsOptions& options, bool has_world);

}  // namespace kestrel
