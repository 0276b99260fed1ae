// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/open_recording.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/assumed_lens.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/source_calibration.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/several_cameras.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

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

// 'camera': its name in a file with several; 'first_image': see OpenedSource.
CameraCalibration KnownCalibration(const FrameSource& source, const RecordingChoice& choice,
                                   const std::string& camera, std::string* first_image) {
  const auto known = CalibrationOf(source, choice.camera, choice.bag.notify, camera);
  if (known) return *known;
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
                                  const std::string& camera, std::string* first_image) {
  CameraCalibration calibration = KnownCalibration(source, choice, camera, first_image);
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

void ReportBroken(const RecordingChoice& choice, FrameSource* source) {
  if (!choice.bag.notify) return;
  source->set_on_broken(
      [notify = choice.bag.notify, reported = 0](const BrokenImage& broken) mutable {
        constexpr int kMostReported = 3;
        if (reported < kMostReported)
          notify(fmt::format("an image is left out: {}", broken.what()));
        if (reported++ == kMostReported) notify("further images are left out");
      });
}

// The names of the recording's cameras; empty where the source is none.
std::vector<std::string> CamerasOf(const RecordingChoice& choice) {
  return choice.sources.size() == 1 ? EurocCameras(choice.sources.front())
                                    : std::vector<std::string>();
}

void ReportUnusedCameras(const RecordingChoice& choice) {
  const std::vector<std::string> names = CamerasOf(choice);
  if (names.size() < 2 || choice.all_cameras || !choice.bag.notify) return;
  choice.bag.notify(
      fmt::format("{} has {} cameras: {} is used; give the folder of another one in "
                  "its place, as {}",
                  choice.sources.front(), names.size(), names.front(),
                  (fs::path(*FindEurocRoot(choice.sources.front())) / names.back()).string()));
}

// The name of the camera in a file with several, where the source is not the recording's first.
std::string NameInFile(const RecordingChoice& choice) {
  const std::vector<std::string> names = CamerasOf(choice);
  return names.empty() || names.front() == "cam0" ? "" : names.front();
}

CameraCalibration CalibrationOfOne(const FrameSource& source, const RecordingChoice& choice,
                                   const std::string& camera) {
  std::string unused;
  CameraCalibration calibration = FindCalibration(source, choice, camera, &unused);
  if (!choice.camera.empty() && calibration.name != camera) {
    throw InputError(fmt::format(
        "{}: is of one camera, expected a file with one entry for each, as Kalibr's camchain.yaml, "
        "or as the source the folder of one camera",
        choice.camera));
  }
  calibration.name = camera;
  return calibration;
}

OpenedSource OpenCameras(const RecordingChoice& choice, const std::vector<std::string>& names) {
  if (choice.clock_offset) {
    throw InputError(
        "--clock-offset is of one camera, expected time_offset_s in the calibration of each");
  }
  OpenedSource opened;
  std::vector<CameraCalibration> calibrations;
  std::vector<SeveralCameras::Camera> cameras;
  for (const std::string& name : names) {
    auto source = std::make_unique<ImageSequence>(OpenEurocRecording(choice.sources.front(), name));
    calibrations.push_back(CalibrationOfOne(*source, choice, name));
    cameras.push_back(
        {std::move(source), calibrations.back().clock_offset.value_or(Duration::zero())});
  }
  opened.source = std::make_unique<SeveralCameras>(std::move(cameras));
  opened.source->set_format(choice.format);
  ReportBroken(choice, opened.source.get());
  opened.calibration = calibrations.front();
  opened.further.assign(calibrations.begin() + 1, calibrations.end());
  return opened;
}

// The cameras to open: all, without those that lack a calibration. Fewer than two: the source is
// opened as any other.
std::vector<std::string> ChosenCameras(RecordingChoice* choice) {
  std::vector<std::string> names;
  const BagChoice& bag = choice->bag;
  if (choice->all_cameras && bag.topics.empty() && !bag.use_arrival_times) {
    names = CamerasOf(*choice);
  }
  if (names.size() < 2 || !choice->camera.empty()) return names;
  const fs::path root(*FindEurocRoot(choice->sources.front()));
  const auto first_without = std::stable_partition(
      names.begin(), names.end(),
      [&](const std::string& name) { return fs::exists(root / name / "sensor.yaml"); });
  if (first_without == names.begin()) return {};
  for (auto name = first_without; name != names.end() && choice->bag.notify; ++name) {
    choice->bag.notify(fmt::format("{} has no calibration (sensor.yaml): left out", *name));
  }
  names.erase(first_without, names.end());
  if (names.size() == 1) choice->sources = {(root / names.front()).string()};
  return names;
}

}  // namespace

std::unique_ptr<FrameSource> OpenFrames(const RecordingChoice& choice) {
  auto source = OpenSourceOrBag(choice.sources, choice.format, choice.bag);
  ReportUnusedCameras(choice);
  ReportBroken(choice, source.get());
  return source;
}

void OpenedSource::RequireSize(const Frame& frame) const {
  const int width_px = frame.image.cols, height_px = frame.image.rows;
  const CameraIntrinsics& camera =
      (frame.camera == 0 ? calibration : further[frame.camera - 1]).intrinsics;
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

OpenedSource OpenRecording(const RecordingChoice& wanted) {
  RecordingChoice choice = wanted;
  const std::vector<std::string> cameras = ChosenCameras(&choice);
  if (cameras.size() > 1) return OpenCameras(choice, cameras);
  OpenedSource opened{OpenFrames(choice), {}};
  opened.is_lens_unknown =
      choice.camera.empty() && !choice.fov_deg && !opened.source->calibration();
  opened.calibration =
      FindCalibration(*opened.source, choice, NameInFile(choice), &opened.first_image);
  if (opened.is_lens_unknown) opened.calibration.body_from_camera.reset();
  return opened;
}

}  // namespace kestrel
