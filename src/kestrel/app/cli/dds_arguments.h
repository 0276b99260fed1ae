// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/ros/dds_source.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The option --dds. Must live until the command line is parsed.
struct DdsArguments {
  std::optional<std::string> given;  // the domain; empty: that of ROS; nothing: not given

  void AddTo(CLI::App* command);

  bool is_given() const { return given.has_value(); }

  // Returns a domain also where the option is not given. Throws InputError when the text is not
  // one.
  int Domain() const;

  // Throws InputError when the node cannot be opened.
  std::shared_ptr<Ros2Node> OpenNode(const DdsOptions& options) const;
  // Returns a function that opens it. These arguments outlive it.
  DdsSource::OpenNode NodeOpener(const DdsOptions& options) const;
};

// Returns the names of the frames in results, as the options have them; those of further cameras
// follow from their names.
RosFrames OwnFrames(const DdsOptions& options, bool has_world,
                    const std::vector<CameraCalibration>& further);

// Returns what publishes the results of a task by the node. Topics of further cameras lie below
// their names. Throws InputError where DDS refuses.
std::unique_ptr<RosResults> MakeRos2Results(const std::shared_ptr<Ros2Node>& node,
                                            const KestrelOptions& options, const RosFrames& frames,
                                            const Task& task, const CameraCalibration& calibration,
                                            const std::vector<CameraCalibration>& further,
                                            const ObjectModel& model);

}  // namespace kestrel
