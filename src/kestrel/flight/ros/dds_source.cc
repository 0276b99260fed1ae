// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_source.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::string_view kPrefix = "dds:";

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

DdsCameraOptions DdsSource::CameraOptions(const LiveSourceChoice& choice) {
  DdsCameraOptions camera;
  camera.image = choice.uri().substr(kPrefix.size());
  camera.topics = choice.recording.bag.topics;
  camera.format = choice.recording.format;
  camera.body_frame = frames_ ? body_frame_ : options_.body_frame;
  camera.wait_s = options_.wait_s;
  camera.inbox = inboxes_++;
  camera.takes_poses = !frames_;
  if (frames_) camera.from_stamps = -frames_->to_stamps;
  return camera;
}

OpenedLiveSource DdsSource::Open(const LiveSourceChoice& choice) {
  std::optional<CameraCalibration> given;
  if (!choice.recording.camera.empty()) {
    given = ChosenCalibration(choice.recording, choice.camera);
  }
  if (!node_) node_ = open_node_();
  DdsCameraOptions options = CameraOptions(choice);
  if (given) options.camera = given->intrinsics;
  auto camera = std::make_unique<DdsCamera>(node_, options, notify_);
  if (!given) RequireOwnLens(*camera, choice);
  OpenedLiveSource opened;
  opened.calibration = given ? *given : *camera->calibration();
  if (!opened.calibration.body_from_camera) opened.calibration.body_from_camera = camera->mount();
  if (choice.recording.clock_offset) {
    opened.calibration.clock_offset = choice.recording.clock_offset;
  }
  opened.has_poses = camera->has_poses();
  NoteFrames(*camera);
  if (frames_->world && !opened.calibration.body_from_camera) {
    notify_(
        fmt::format("no mount: no positions in the world; expected a static transform from {} to "
                    "{}, or --camera FILE with T_BS",
                    options.body_frame, camera->camera_frame()));
  }
  opened.source = std::move(camera);
  return opened;
}

// The only camera_info of a system goes with any image: not with two.
void DdsSource::RequireOwnLens(const DdsCamera& camera, const LiveSourceChoice& choice) {
  if (used_infos_.insert(camera.camera_info_topic()).second) return;
  throw InputError(
      fmt::format("{}: {} is of another camera, expected a topic of sensor_msgs/CameraInfo beside "
                  "the images; or --camera FILE",
                  choice.uri(), camera.camera_info_topic()));
}

void DdsSource::NoteFrames(const DdsCamera& camera) {
  if (frames_) {
    const std::string frame = camera.camera_frame();
    if (frame == frames_->camera || std::ranges::count(frames_->further, frame) > 0) {
      notify_(fmt::format("two cameras have the frame {}: one mount is taken for both", frame));
    }
    frames_->further.push_back(frame);
    return;
  }
  frames_.emplace();
  frames_->camera = camera.camera_frame();
  if (camera.has_poses()) frames_->world = camera.world_frame();
  frames_->to_stamps = camera.to_stamps();
  body_frame_ = camera.body_frame();
}

}  // namespace kestrel
