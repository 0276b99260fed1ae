// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_source.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/flight/ros/dds_camera.h"

namespace kestrel {
namespace {

constexpr std::string_view kPrefix = "dds:";

DdsCameraOptions CameraOptions(const LiveSourceChoice& choice, const DdsOptions& options) {
  DdsCameraOptions camera;
  camera.image = choice.uri().substr(kPrefix.size());
  camera.topics = choice.recording.bag.topics;
  camera.format = choice.recording.format;
  camera.body_frame = options.body_frame;
  camera.wait_s = options.wait_s;
  return camera;
}

RosFrames FramesOf(const DdsCamera& camera) {
  RosFrames frames;
  frames.camera = camera.camera_frame();
  if (camera.has_poses()) frames.world = camera.world_frame();
  frames.to_stamps = camera.to_stamps();
  return frames;
}

}  // namespace

std::shared_ptr<Ros2Node> OpenRos2Node(int domain, const DdsOptions& options) {
  return std::make_shared<Ros2Node>(domain, Ros2NodeOptions{options.node, options.is_humble()});
}

DdsSource::DdsSource(const DdsOptions& options, OpenNode open_node,
                     std::function<void(const std::string&)> notify)
    : options_(options), open_node_(std::move(open_node)), notify_(std::move(notify)) {}

SourceScheme DdsSource::Scheme() {
  return {std::string(kPrefix), [this](const LiveSourceChoice& choice) { return Open(choice); }};
}

OpenedLiveSource DdsSource::Open(const LiveSourceChoice& choice) {
  DdsCameraOptions options = CameraOptions(choice, options_);
  std::optional<CameraCalibration> given;
  if (!choice.recording.camera.empty()) given = ChosenCalibration(choice.recording);
  if (given) options.camera = given->intrinsics;
  node_ = open_node_();
  auto camera = std::make_unique<DdsCamera>(node_, options, notify_);
  OpenedLiveSource opened;
  opened.calibration = given ? *given : *camera->calibration();
  if (!opened.calibration.body_from_camera) opened.calibration.body_from_camera = camera->mount();
  if (choice.recording.clock_offset) {
    opened.calibration.clock_offset = choice.recording.clock_offset;
  }
  opened.has_poses = camera->has_poses();
  if (opened.has_poses && !opened.calibration.body_from_camera) {
    notify_(
        fmt::format("no mount: no positions in the world; expected a static transform from {} to "
                    "{}, or --camera FILE with T_BS",
                    options_.body_frame, camera->camera_frame()));
  }
  frames_ = FramesOf(*camera);
  opened.source = std::move(camera);
  return opened;
}

}  // namespace kestrel
