// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/source_arguments.h"

#include <filesystem>
#include <iostream>
#include <limits>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/camera/assumed_lens.h"
#include "kestrel/vision/pipeline/require_altitude.h"

namespace kestrel {
namespace {

constexpr double kMaxClockOffset = 1e6;

CLI::Validator ValidAltitude() {
  return CLI::Validator(
      [](const std::string& text) {
        std::vector<std::string> violations;
        RequireAltitude(ParseNumber<double>(text).value_or(0), "it", &violations);
        return violations.empty() ? "" : violations.front();
      },
      "");
}

}  // namespace

CLI::Validator InRange(double min, double max, const std::string& words) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto number = ParseNumber<double>(text);
        return number && *number > min && *number < max
                   ? ""
                   : "expected " + words + DecimalCommaAdvice(text);
      },
      "");
}

ObjectModel ReadModel(const std::string& file) {
  return file.empty() ? DefaultObjectModel() : ReadObjectModel(file);
}

void RequireNoSource(const std::string& file, const std::vector<std::string>& sources) {
  std::error_code ignored;
  for (const std::string& source : sources) {
    if (std::filesystem::equivalent(source, file, ignored)) {
      throw InputError(file + ": is the source, expected another name");
    }
  }
}

CLI::Option* AddAnnotateFlag(CLI::App* command, std::string* annotate) {
  return command
      ->add_flag("--annotate{video}", *annotate,
                 "Frames with the results drawn on them, too: a video, or --annotate=images")
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
      ->add_option("--camera", cameras,
                   "Calibration: EuRoC sensor.yaml, Kalibr camchain.yaml, ROS camera_info YAML or "
                   "OpenCV YAML or XML, camodocal, ORB-SLAM; overrides the source's")
      ->type_name("FILE")
      ->allow_extra_args(false);  // what follows it is a SOURCE
  command
      ->add_option("--fov", fov_deg,
                   "Field of view of the lens, from the left edge to the right (degrees): a guess "
                   "where there is no calibration")
      ->type_name("DEG")
      ->check(InRange(kMinFov_deg - 1e-9, kMaxFov_deg + 1e-9,
                      fmt::format("{} to {} degrees", kMinFov_deg, kMaxFov_deg)));
  options.AddTo(command);
  command->add_flag("--still", still,
                    "Independent frames: no state is carried from one to the next");
  command
      ->add_option("--altitude", altitude_m,
                   "Height of the camera above the pattern or the ground (m), where the source has "
                   "no poses")
      ->type_name("M")
      ->check(InRange(0, std::numeric_limits<double>::infinity(), "a positive height in m"))
      ->check(ValidAltitude());
  command
      ->add_option("--clock-offset", clock_offset,
                   "Navigation's time minus image's time of the same instant (s)")
      ->type_name("S")
      ->check(InRange(-kMaxClockOffset, kMaxClockOffset, "seconds"));
}

void SourceArguments::AddTo(CLI::App* command) {
  AddReadingTo(command);
  CLI::Option* folder =
      command->add_option("--output", output, "Folder for the results (default: stdout)")
          ->type_name("DIR");
  AddAnnotateFlag(command, &annotate)->needs(folder);
  command
      ->add_option("--mcap", mcap,
                   "MCAP file of images and results, too, for Foxglove, Lichtblick and Rerun")
      ->type_name("FILE")
      ->check(CLI::Validator(
          [](const std::string& file) {
            const bool is_mcap = std::filesystem::path(file).extension() == ".mcap";
            return is_mcap ? std::string() : "'" + file + "': expected a name that ends in .mcap";
          },
          ""));
  dds.AddTo(command);
  command->add_flag("--force", force, "Replace files that exist");
}

std::string SourceArguments::camera() const {
  if (cameras.size() > 1) {
    throw InputError("--camera: expected one FILE; several are for as many cameras of kestrel fly");
  }
  return cameras.empty() ? "" : cameras.front();
}

RecordingChoice SourceArguments::Recording(PixelFormat format) const {
  RecordingChoice choice = bag.Recording(sources, format);
  choice.camera = camera();
  choice.fov_deg = fov_deg;
  if (clock_offset) choice.clock_offset = DurationFromSeconds(*clock_offset);
  return choice;
}

OpenedSource SourceArguments::OpenOrAssume(PixelFormat format, bool all_cameras) const {
  RecordingChoice choice = Recording(format);
  choice.all_cameras = all_cameras;
  choice.may_assume_lens = mcap.empty() && !dds.is_given() && !altitude_m;
  return OpenRecording(choice);
}

SessionOptions SourceArguments::Session() const {
  return {.altitude_m = altitude_m,
          .output = output,
          .replace = force,
          .annotate = annotate,
          .table = &std::cout};
}

}  // namespace kestrel
