// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/open_recording.h"

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/bags/bag_source.h"

namespace kestrel {
namespace {

CameraCalibration FindCalibration(const FrameSource& source, const RecordingChoice& choice) {
  CameraCalibration calibration;
  if (choice.camera.empty()) {
    const std::optional<CameraCalibration> own = source.calibration();
    if (!own) {
      throw InputError(
          "no calibration: the source has none, give one by --camera FILE (EuRoC sensor.yaml, "
          "Kalibr camchain.yaml, ROS camera_info YAML or OpenCV YAML)");
    }
    calibration = *own;
  } else {
    calibration = ReadCalibration(choice.camera);
  }
  if (!calibration.body_from_camera) {
    const CameraMount own = source.mount();
    calibration.body_from_camera = own.body_from_camera;
    if (!calibration.clock_offset) calibration.clock_offset = own.clock_offset;
  }
  if (choice.clock_offset) calibration.clock_offset = choice.clock_offset;
  if (!calibration.body_from_camera && !source.poses().empty() && choice.bag.tell) {
    choice.bag.tell("the calibration has no mount: no positions in the world");
  }
  return calibration;
}

}  // namespace

std::unique_ptr<FrameSource> OpenFrames(const RecordingChoice& choice) {
  return OpenSourceOrBag(choice.sources, choice.format, choice.bag);
}

std::vector<PoseSample> RequirePoses(const FrameSource& source, const std::string& name) {
  std::vector<PoseSample> poses = source.poses();
  if (!poses.empty()) return poses;
  throw InputError(name + ": has no poses of the UAV, expected nav0/data.csv or a topic");
}

OpenedSource OpenRecording(const RecordingChoice& choice) {
  OpenedSource opened{OpenFrames(choice), {}};
  opened.calibration = FindCalibration(*opened.source, choice);
  return opened;
}

}  // namespace kestrel
