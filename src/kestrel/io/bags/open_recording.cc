// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/open_recording.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/assumed_lens.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/source_calibration.h"

namespace kestrel {
namespace {

constexpr double kUsualFov_deg = 75;

// The size of the images is known with the first of them, which the source then has to give again.
CameraIntrinsics AssumeLens(RecordingChoice choice, std::string* first_image) {
  choice.bag.notify = {};  // the user hears of it when the source is read
  Frame first;
  if (!OpenFrames(choice)->Next(&first)) throw InputError("the source has no images");
  *first_image = first.name;
  const double fov_deg = choice.fov_deg.value_or(kUsualFov_deg);
  return AssumedLens(first.image.cols, first.image.rows, fov_deg);
}

// Reports the assumed lens, and how to calibrate it.
void ReportAssumption(const RecordingChoice& choice) {
  if (!choice.bag.notify) return;
  choice.bag.notify(
      choice.fov_deg
          ? fmt::format("no calibration: distances are as coarse as the {} degrees of --fov; "
                        "`kestrel calibrate lens` measures the lens",
                        *choice.fov_deg)
          : "no calibration: only places in the image, in pixels; --fov DEGREES (as wide as the "
            "lens sees) gives coarse distances, `kestrel calibrate lens` a calibration for "
            "--camera");
}

// 'first_image': see OpenedSource.
CameraCalibration KnownCalibration(const FrameSource& source, const RecordingChoice& choice,
                                   std::string* first_image) {
  if (const auto known = CalibrationOf(source, choice.camera, choice.bag.notify)) return *known;
  if (!choice.may_assume_lens && !choice.fov_deg) {
    throw InputError(
        "no calibration: the source has none, give one (--camera FILE, camera= in Python: EuRoC "
        "sensor.yaml, Kalibr camchain.yaml, ROS camera_info YAML, OpenCV YAML or XML); `kestrel "
        "calibrate lens` makes one");
  }
  ReportAssumption(choice);
  CameraCalibration assumed;
  assumed.intrinsics = AssumeLens(choice, first_image);
  return assumed;
}

CameraCalibration FindCalibration(const FrameSource& source, const RecordingChoice& choice,
                                  std::string* first_image) {
  CameraCalibration calibration = KnownCalibration(source, choice, first_image);
  if (choice.fov_deg && (!choice.camera.empty() || source.calibration()) && choice.bag.notify) {
    choice.bag.notify("--fov is not used: there is a calibration");
  }
  if (!calibration.body_from_camera) {
    const CameraMount own = source.mount();
    calibration.body_from_camera = own.body_from_camera;
    calibration.gimbal = own.gimbal;
    if (!choice.camera.empty() && own.body_from_camera && choice.bag.notify) {
      choice.bag.notify(choice.camera + " has no mount (T_BS): the recording's is used");
    }
    if (!calibration.clock_offset) calibration.clock_offset = own.clock_offset;
  }
  if (choice.clock_offset) calibration.clock_offset = choice.clock_offset;
  if (!calibration.body_from_camera && !source.poses().empty() && choice.bag.notify) {
    choice.bag.notify("the calibration has no mount: no positions in the world");
  }
  return calibration;
}

}  // namespace

std::unique_ptr<FrameSource> OpenFrames(const RecordingChoice& choice) {
  auto source = OpenSourceOrBag(choice.sources, choice.format, choice.bag);
  if (!choice.bag.notify) return source;
  source->set_on_broken(
      [notify = choice.bag.notify, reported = 0](const BrokenImage& broken) mutable {
        constexpr int kMostReported = 3;
        if (reported < kMostReported)
          notify(fmt::format("an image is left out: {}", broken.what()));
        if (reported++ == kMostReported) notify("further images are left out");
      });
  return source;
}

void OpenedSource::RequireSize(const Frame& frame) const {
  const int width_px = frame.image.cols, height_px = frame.image.rows;
  const CameraIntrinsics& camera = calibration.intrinsics;
  if (first_image.empty()) return CheckImageSize(camera, width_px, height_px, frame.name);
  if (width_px == camera.width_px && height_px == camera.height_px) return;
  throw ImageSizeError(fmt::format("{}: the image is {}x{} px, expected {}x{} px as {}", frame.name,
                                   width_px, height_px, camera.width_px, camera.height_px,
                                   first_image));
}

std::vector<PoseSample> RequirePoses(const FrameSource& source, const std::string& name) {
  std::vector<PoseSample> poses = source.poses();
  if (!poses.empty()) return poses;
  throw InputError(name + ": has no poses of the UAV, expected nav0/data.csv or a topic");
}

OpenedSource OpenRecording(const RecordingChoice& choice) {
  OpenedSource opened{OpenFrames(choice), {}};
  opened.is_lens_unknown =
      choice.camera.empty() && !choice.fov_deg && !opened.source->calibration();
  opened.calibration = FindCalibration(*opened.source, choice, &opened.first_image);
  if (opened.is_lens_unknown) opened.calibration.body_from_camera.reset();
  return opened;
}

}  // namespace kestrel
