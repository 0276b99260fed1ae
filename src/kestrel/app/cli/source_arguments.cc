// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/source_arguments.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {
namespace {

constexpr double kMaxClockOffset = 1e6;

}  // namespace

CLI::Validator InRange(double min, double max, const std::string& words) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto number = ParseNumber<double>(text);
        return number && *number > min && *number < max ? "" : "expected " + words;
      },
      "");
}

void RequireNoSource(const std::string& file, const std::vector<std::string>& sources) {
  std::error_code ignored;
  for (const std::string& source : sources) {
    if (std::filesystem::equivalent(source, file, ignored)) {
      throw InputError(file + ": is the source, expected another file");
    }
  }
}

CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate) {
  return command
      ->add_flag("--annotate{video}", *annotate,
                 "Also write the frames with what was found: a video, or --annotate=images")
      ->check(CLI::IsMember({"video", "images"}));
}

void SourceArguments::AddReadingTo(CLI::App* command) {
  command
      ->add_option("SOURCE", sources,
                   "A recording folder (EuRoC), a ROS bag (.bag, .mcap, .db3 or its folder), a "
                   "folder of images, image files, a video file, a camera (/dev/video0) or a "
                   "GStreamer pipeline")
      ->required();
  bag.AddTo(command);
  command
      ->add_option("--camera", camera,
                   "Calibration: EuRoC sensor.yaml, Kalibr camchain.yaml, ROS camera_info YAML or "
                   "OpenCV YAML; overrides the source's")
      ->type_name("FILE");
  options.AddTo(command);
  command->add_flag("--still", still, "The frames have nothing to do with each other");
  command
      ->add_option("--altitude", altitude_m,
                   "Height of the camera above the pattern or the ground (m), where the source has "
                   "no poses")
      ->type_name("M")
      ->check(InRange(0, 1e5, "a positive height in m"));
  command
      ->add_option("--clock-offset", clock_offset,
                   "Seconds to add to an image's time to get the navigation's")
      ->type_name("S")
      ->check(InRange(-kMaxClockOffset, kMaxClockOffset, "seconds"));
}

void SourceArguments::AddTo(CLI::App* command) {
  AddReadingTo(command);
  CLI::Option* folder =
      command->add_option("--output", output, "Folder for the results (else stdout)")
          ->type_name("DIR");
  AddAnnotateFlag(command, &annotate)->needs(folder);
  command
      ->add_option("--mcap", mcap,
                   "Also write images and results as MCAP, for Foxglove, Lichtblick and Rerun")
      ->type_name("FILE");
  dds.AddTo(command);
  command->add_flag("--force", force, "Replace files that exist");
}

OpenedSource SourceArguments::Open(PixelFormat format) const {
  OpenedSource opened{bag.Open(sources, format), {}};
  opened.calibration = FindCalibration(*opened.source);
  return opened;
}

OutputOptions SourceArguments::Output(const OpenedSource& opened) const {
  return {
      .folder = output, .force = force, .annotate = annotate, .rate_hz = opened.source->rate_hz()};
}

std::unique_ptr<ObservationFile> SourceArguments::OpenMcap(
    const CameraIntrinsics& intrinsics, std::variant<LandingView, HuntView> view) const {
  if (mcap.empty()) return nullptr;
  RequireNoSource(mcap, sources);
  return std::make_unique<ObservationFile>(mcap, force, intrinsics, std::move(view));
}

CameraCalibration SourceArguments::FindCalibration(const FrameSource& source) const {
  CameraCalibration calibration;
  if (camera.empty()) {
    const std::optional<CameraCalibration> own = source.calibration();
    if (!own) {
      throw InputError(
          "no calibration: the source has none, give one by --camera FILE (EuRoC sensor.yaml, "
          "Kalibr camchain.yaml, ROS camera_info YAML or OpenCV YAML)");
    }
    calibration = *own;
  } else {
    calibration = ReadCalibration(camera);
  }
  if (!calibration.body_from_camera) {
    const CameraMount own = source.mount();
    calibration.body_from_camera = own.body_from_camera;
    if (!calibration.clock_offset) calibration.clock_offset = own.clock_offset;
  }
  if (clock_offset) calibration.clock_offset = DurationFromSeconds(*clock_offset);
  if (!calibration.body_from_camera && !source.poses().empty()) {
    fmt::print(stderr, "kestrel: the calibration has no mount: no positions in the world\n");
  }
  return calibration;
}

}  // namespace kestrel
