// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/camera_file.h"
#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/foxglove/foxglove_recording.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/bags/recording_sink.h"
#include "kestrel/io/bags/source_calibration.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/frame_source.h"
#include "kestrel/io/recording/media/file_kind.h"

namespace kestrel {
namespace {

struct ConvertArguments {
  std::string source;
  std::string destination;
  BagArguments bag;
  std::string camera;
  std::string compression = "none";
  bool for_foxglove = false;
  bool force = false;
};

// The calibration FILE, or the source's; a FILE without a mount gets the source's.
std::optional<CameraCalibration> CalibrationFor(const ConvertArguments& arguments,
                                                const FrameSource& source) {
  std::optional<CameraCalibration> calibration =
      CalibrationOf(source, arguments.camera, PrintUnusedKeys);
  if (calibration && !calibration->body_from_camera) {
    calibration->body_from_camera = source.mount().body_from_camera;
    calibration->gimbal = source.mount().gimbal;
  }
  return calibration;
}

bool HasTruth(const std::string& source) {
  const auto root = FindEurocRoot(source);
  return root && std::filesystem::exists(std::filesystem::path(*root) / euroc::kTruePoses);
}

// Throws InputError for the name of an image or a video, which would become a folder.
void RequireBagOrFolder(const std::string& destination) {
  if (FileKindOf(destination) == FileKind::kOther) return;
  throw InputError(destination +
                   ": expected a bag (.bag, .mcap, .db3) or a folder; `kestrel land --annotate` "
                   "makes videos");
}

// Reports which data of the source the destination cannot hold.
void WarnOfLoss(const ConvertArguments& arguments, const RecordingHead& head) {
  const bool is_bag = IsBagName(arguments.destination);
  if (!head.calibration) fmt::print(stderr, "kestrel: no calibration: the source has none\n");
  if (HasTruth(arguments.source)) {
    fmt::print(stderr,
               "kestrel: the truth of the simulation is left out: keep the recording to evaluate "
               "results\n");
  }
  if (is_bag && head.calibration && head.calibration->clock_offset) {
    fmt::print(stderr,
               "kestrel: a bag cannot hold the clock offset: use it with --clock-offset {}\n",
               ToSeconds(*head.calibration->clock_offset));
  }
  if (is_bag && head.calibration && head.calibration->gimbal) {
    fmt::print(stderr, "kestrel: a bag cannot hold the gimbal: convert to a folder to keep it\n");
  }
  if (is_bag && head.calibration && head.calibration->zoom) {
    fmt::print(stderr, "kestrel: a bag cannot hold the zoom: convert to a folder to keep it\n");
  }
  if ((!is_bag || arguments.for_foxglove) && head.has_motion) {
    fmt::print(stderr, "kestrel: {} velocities: they are left out\n",
               is_bag ? "Foxglove's poses cannot hold" : "a EuRoC folder cannot hold");
  }
}

std::unique_ptr<RecordingSink> OpenDestination(const ConvertArguments& arguments,
                                               const RecordingHead& head) {
  RequireNoSource(arguments.destination, {arguments.source});
  if (arguments.for_foxglove) {
    return std::make_unique<FoxgloveRecording>(arguments.destination, head, arguments.force);
  }
  return NewRecording(arguments.destination, head,
                      CompressionOf(arguments.compression, "--compression"), arguments.force);
}

std::string LeftOutInWords(const FrameSource& source) {
  return source.left_out() == 0 ? "" : fmt::format(", {} images left out", source.left_out());
}

void RunConvert(const ConvertArguments& arguments) {
  RequireBagOrFolder(arguments.destination);
  const auto source = OpenFrames(arguments.bag.Recording({arguments.source}, PixelFormat::kBgr));
  const std::vector<PoseSample> poses = source->poses();
  const RecordingHead head{
      .calibration = CalibrationFor(arguments, *source),
      .rate_hz = source->rate_hz(),
      .has_poses = !poses.empty(),
      .has_motion = std::any_of(poses.begin(), poses.end(),
                                [](const PoseSample& pose) { return pose.motion.has_value(); })};
  const auto recording = OpenDestination(arguments, head);
  WarnOfLoss(arguments, head);
  CatchInterrupts();
  ProgressBar progress(source->frame_count());
  std::size_t frames = 0;
  auto pose = poses.begin();
  for (Frame frame; !WasInterrupted() && source->Next(&frame); progress.Show(++frames)) {
    for (; pose != poses.end() && pose->time <= frame.time; ++pose) recording->AddPose(*pose);
    recording->AddFrame(frame);
  }
  if (WasInterrupted()) {
    throw Interrupted(fmt::format("interrupted after {} frames: {} is not written", frames,
                                  arguments.destination));
  }
  for (; pose != poses.end(); ++pose) recording->AddPose(*pose);
  recording->AddGimbal(source->gimbal());
  recording->AddZoom(source->zoom());
  recording->Close();
  fmt::print(stderr, "{} frames, {} poses{}\n", frames, pose - poses.begin(),
             LeftOutInWords(*source));
}

}  // namespace

void AddConvertCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "convert", "Convert between EuRoC folders, ROS 1 bags and ROS 2 bags (MCAP, sqlite3)");
  const auto arguments = std::make_shared<ConvertArguments>();
  command
      ->add_option("SOURCE", arguments->source,
                   "A recording folder (EuRoC), a ROS bag, a folder of images or a video")
      ->required();
  command
      ->add_option("DESTINATION", arguments->destination,
                   "A bag (.bag: ROS 1; .mcap, .db3: ROS 2), or a folder (EuRoC)")
      ->required();
  arguments->bag.AddTo(command);
  command->add_option("--camera", arguments->camera, "Calibration; overrides the source's")
      ->type_name("FILE");
  CLI::Option* compression =
      command
          ->add_option("--compression", arguments->compression,
                       "Compression of the bag: none; bz2, lz4 (.bag); lz4, zstd (.mcap)")
          ->check(CLI::IsMember({"none", "bz2", "lz4", "zstd"}));
  command
      ->add_flag("--foxglove", arguments->for_foxglove,
                 "Write Foxglove's messages, with JPEG images, into an .mcap, in place of ROS 2's")
      ->excludes(compression);
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunConvert(*arguments); });
}

}  // namespace kestrel
