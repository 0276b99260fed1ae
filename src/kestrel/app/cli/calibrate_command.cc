// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/camera_file.h"
#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/calibration/mount/flight_sightings.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/bags/source_calibration.h"
#include "kestrel/io/recording/euroc/calibration_output.h"

namespace kestrel {
namespace {

struct CalibrateArguments {
  std::string recording;
  BagArguments bag;
  std::string camera;
  std::string output;
  OptionArguments options;
  bool both = false;
  bool moving = false;
  bool force = false;
};

CameraCalibration ReadGiven(const CalibrateArguments& arguments, const FrameSource& source) {
  const std::string& file = arguments.camera.empty() ? arguments.recording : arguments.camera;
  const std::optional<CameraCalibration> calibration =
      CalibrationOf(source, arguments.camera, PrintUnusedKeys);
  if (!calibration) throw InputError(file + ": has no calibration, give one by --camera FILE");
  return *calibration;
}

void PrintResult(const FlightCalibration& result, const FlightCalibrationOptions& options,
                 const std::optional<FlownGimbal>& gimbal) {
  if (options.estimate_mount) {
    const Eigen::Vector3d angles = Degrees(1) * result.angles;
    const Eigen::Vector3d sigmas = Degrees(1) * result.angle_sigmas;
    fmt::print(stderr,
               "mount: turned by roll {:.3f} +- {:.3f}, pitch {:.3f} +- {:.3f}, yaw {:.3f} +- "
               "{:.3f} degrees\n",
               angles.x(), sigmas.x(), angles.y(), sigmas.y(), angles.z(), sigmas.z());
  }
  if (options.estimate_clock && gimbal) {
    fmt::print(stderr, "clock offset of the gimbal: {:.4f} +- {:.4f} s\n",
               gimbal->image_clock_offset_s - result.estimate.clock_offset_s, result.clock_sigma_s);
  } else if (options.estimate_clock) {
    fmt::print(stderr, "clock offset: {:.4f} +- {:.4f} s\n", result.estimate.clock_offset_s,
               result.clock_sigma_s);
  }
  fmt::print(stderr,
             "positions in the world, RMS: {:.3f} m before, {:.3f} m after, in {} images ({} left "
             "out)\n",
             result.rms_before_m, result.rms_after_m, result.sightings, result.outliers);
  for (const std::string& warning : result.warnings) {
    fmt::print(stderr, "kestrel: warning: {}\n", warning);
  }
}

// A calibration that the flight does not determine would be believed by the next flight.
void RequireUse(const FlightCalibration& result, bool force) {
  const std::string why = WhyOfNoUse(result);
  if (why.empty()) return;
  if (!force) throw InputError(why + "; no calibration is written (--force writes it)");
  fmt::print(stderr, "kestrel: warning: {}\n", why);
}

void RunCalibrate(const CalibrateArguments& arguments, FlightCalibrationOptions options) {
  RequireFreeForCalibration(arguments.output, arguments.force);
  const LandingPipelineOptions landing = arguments.options.Read().landing;
  if (arguments.both) options.estimate_mount = options.estimate_clock = true;
  if (arguments.moving) options.knot_spacing_s = kMovingKnotSpacing_s;
  const std::unique_ptr<FrameSource> source =
      OpenFrames(arguments.bag.Recording({arguments.recording}));
  CameraCalibration calibration = ReadGiven(arguments, *source);
  const MountAndClock given = GivenMountAndClock(
      calibration, arguments.camera.empty() ? arguments.recording : arguments.camera);
  const std::vector<PoseSample> poses = RequirePoses(*source, arguments.recording);
  RequireOwnLens(calibration, source->zoom(), arguments.recording);
  FlightSightings flight(calibration.intrinsics, landing);
  CatchInterrupts();
  ProgressBar progress(source->frame_count());
  std::size_t done = 0;
  for (Frame frame; !WasInterrupted() && source->Next(&frame); progress.Show(++done)) {
    const cv::Mat& image = frame.image;
    CheckImageSize(calibration.intrinsics, image.cols, image.rows, frame.name);
    flight.Add(image, frame.time);
  }
  if (WasInterrupted()) {
    throw Interrupted(fmt::format(
        "interrupted after {} images: no calibration is made from a part of a flight", done));
  }
  const auto gimbal = FlownGimbalOf(calibration, source->gimbal(), arguments.recording);
  const FlightCalibration result =
      CalibrateFlight(flight.sightings(), poses, given, options, gimbal);
  PrintResult(result, options, gimbal);
  RequireUse(result, arguments.force);
  SetMountAndClock(result.estimate, &calibration);
  WriteCalibration(calibration, source->rate_hz(), arguments.output, arguments.force);
}

void AddFlightCalibration(CLI::App* parent, const std::string& name, const std::string& meaning,
                          const FlightCalibrationOptions& options) {
  CLI::App* command = parent->add_subcommand(name, meaning);
  const auto arguments = std::make_shared<CalibrateArguments>();
  command
      ->add_option("RECORDING", arguments->recording,
                   "A recording folder or a bag with the poses of the UAV")
      ->required();
  arguments->bag.AddTo(command);
  command
      ->add_option("--camera", arguments->camera,
                   "Calibration to start from, with a mount; overrides the recording's")
      ->type_name("FILE");
  arguments->options.AddTo(command);
  arguments->options.target.AddTo(command);
  command
      ->add_option("--output", arguments->output,
                   "File for the calibration, as --camera reads it (default: stdout)")
      ->type_name("FILE");
  command->add_flag("--both", arguments->both, "Estimate mount and clock together");
  command->add_flag("--moving", arguments->moving, "The pattern moves, on a smooth path");
  command->add_flag("--force", arguments->force,
                    "Replace a file that exists; write also what the flight does not determine");
  command->callback([arguments, options] { RunCalibrate(*arguments, options); });
}

}  // namespace

void AddCalibrateCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("calibrate", "Estimate lens, mount, clock, a map of pads, or colours");
  command->require_subcommand(1);
  AddFlightCalibration(command, "mount",
                       "The camera's angles in the body, from a slow flight over the pattern",
                       {.estimate_mount = true, .estimate_clock = false});
  AddFlightCalibration(command, "clock",
                       "The offset from the images' clock to the navigation's, from a quick flight",
                       {.estimate_mount = false, .estimate_clock = true});
  AddCalibrateLensCommand(command);
  AddCalibratePadsCommand(command);
  AddCalibrateColorsCommand(command);
}

}  // namespace kestrel
