// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/dds_arguments.h"

#include <fmt/format.h>

#include "kestrel/comms/dds/dds_domain.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/flight/ros/ros2_result_connection.h"

namespace kestrel {

void DdsArguments::AddTo(CLI::App* command) {
  command
      ->add_option_function<std::string>(
          "--dds", [this](const std::string& domain) { given = domain; },
          "Publish the results as messages of ROS 2 in this DDS domain (default: ROS_DOMAIN_ID, "
          "else 0)")
      ->type_name("[DOMAIN]")
      ->expected(0, 1);
}

int DdsArguments::Domain() const {
  if (!given || given->empty()) return DdsDomain(std::nullopt);
  const auto domain = ParseNumber<int>(*given);
  if (!domain) throw InputError(fmt::format("--dds '{}': expected a domain, 0 to 232", *given));
  return DdsDomain(*domain);
}

std::shared_ptr<Ros2Node> DdsArguments::OpenNode(const DdsOptions& options) const {
  return OpenRos2Node(Domain(), options);
}

DdsSource::OpenNode DdsArguments::NodeOpener(const DdsOptions& options) const {
  return [this, options] { return OpenNode(options); };
}

RosFrames OwnFrames(const DdsOptions& options, bool has_world,
                    const std::vector<CameraCalibration>& further) {
  RosFrames frames;
  frames.camera = options.camera_frame;
  if (has_world) frames.world = options.world_frame;
  frames.body = options.body_frame;
  for (const CameraCalibration& camera : further) {
    frames.further.push_back(camera.name + "_optical_frame");
  }
  return frames;
}

std::unique_ptr<RosResults> MakeRos2Results(const std::shared_ptr<Ros2Node>& node,
                                            const KestrelOptions& options, const RosFrames& frames,
                                            const Task& task, const CameraCalibration& calibration,
                                            const std::vector<CameraCalibration>& further,
                                            const ObjectModel& model) {
  const std::string& name = options.dds.node;
  auto results = std::make_unique<RosResults>(
      std::make_shared<Ros2ResultConnection>(node, name, task.topics()), options.dds, frames,
      calibration, options.landing, model);
  for (const CameraCalibration& camera : further) {
    results->AddCamera(std::make_shared<Ros2ResultConnection>(
                           node, fmt::format("{}/{}", name, camera.name), kFurtherCameraTopics),
                       camera);
  }
  return results;
}

}  // namespace kestrel
