// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/calibration/calibration_tools.h"

#include <filesystem>

#include <fmt/format.h>

#include "kestrel/calibration/lens/even_sample.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/calibration/mount/flight_calibration.h"
#include "kestrel/calibration/mount/flight_sightings.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/calibration_output.h"

namespace kestrel {
namespace {

using GoOn = CalibrationPage::Run::GoOn;

struct Cancelled {};

// Passes all frames to 'add'. Returns their number.
template <class Add>
std::size_t AddFrames(const OpenedSource& opened, const GoOn& go_on, const Add& add) {
  std::size_t done = 0;
  for (Frame frame; opened.source->Next(&frame); ++done) {
    if (!go_on(done)) throw Cancelled();
    opened.RequireSize(frame);
    add(frame);
  }
  return done;
}

CalibrationResult MountAndClockOf(const RecordingChoice& source,
                                  const LandingPipelineOptions& landing,
                                  const CalibrationRequest& request, const GoOn& go_on) {
  const OpenedSource opened = OpenRecording(source);
  const std::string& name = source.sources.front();
  CalibrationResult result{{}, opened.calibration, opened.source->rate_hz()};
  const MountAndClock given = GivenMountAndClock(opened.calibration, name);
  const auto gimbal = FlownGimbalOf(opened.calibration, opened.source->gimbal(), name);
  const std::vector<PoseSample> poses = RequirePoses(*opened.source, name);
  const CameraIntrinsics& camera = opened.calibration.intrinsics;
  FlightSightings flight(camera, landing);
  const std::size_t frames =
      AddFrames(opened, go_on, [&](const Frame& frame) { flight.Add(frame.image, frame.time); });
  if (!go_on(frames)) throw Cancelled();
  result.report = FlightCoverage(flight.places(), frames, {camera.width_px, camera.height_px});
  FlightCalibrationOptions options;
  options.estimate_mount = request.mount;
  options.estimate_clock = request.clock;
  if (request.moving) options.knot_spacing_s = kMovingKnotSpacing_s;
  try {
    const FlightCalibration found =
        CalibrateFlight(flight.sightings(), poses, given, options, gimbal);
    AddFlight(found, options, given, &result.report);
    SetMountAndClock(found.estimate, &result.calibration);
  } catch (const InputError& error) {  // the coverage is shown all the same
    result.report.error = error.what();
  }
  return result;
}

CalibrationResult LensOf(const RecordingChoice& source, const LandingPipelineOptions& landing,
                         const GoOn& go_on) {
  const OpenedSource opened = OpenRecording(source);
  EvenSample sample;
  const std::size_t frames =
      AddFrames(opened, go_on, [&](const Frame& frame) { sample.Add(frame.name, frame.image); });
  LensCalibrationOptions options;
  options.detector = landing.detector;
  if (!source.camera.empty()) options.start = opened.calibration.intrinsics;
  options.before_image = [&] {
    if (!go_on(frames)) throw Cancelled();
  };
  const std::vector<LensImage> images = sample.Take();
  const LensCalibration lens = CalibrateLens(images, options);
  CalibrationResult result{LensReport(lens, opened.calibration.intrinsics, images.size()),
                           opened.calibration, opened.source->rate_hz()};
  result.calibration.intrinsics = lens.intrinsics;
  return result;
}

// Returns the first of name.yaml, name_2.yaml, ... that does not exist.
std::string SaveBeside(const std::string& folder, const std::string& name,
                       const CalibrationResult& result) {
  std::filesystem::path file = std::filesystem::path(folder) / (name + ".yaml");
  for (int i = 2; std::filesystem::exists(file); ++i) {
    file.replace_filename(fmt::format("{}_{}.yaml", name, i));
  }
  WriteCalibration(result.calibration, result.rate_hz, file.string(), /*force=*/false);
  return file.string();
}

}  // namespace

CalibrationPage::Tools CalibrationTools(const RecordingChoice& source,
                                        const LandingPipelineOptions& options,
                                        const std::string& folder) {
  CalibrationPage::Tools tools;
  tools.calibrate = [source, options](const CalibrationRequest& request,
                                      const GoOn& go_on) -> std::optional<CalibrationResult> {
    try {
      if (request.lens) return LensOf(source, options, go_on);
      return MountAndClockOf(source, options, request, go_on);
    } catch (const Cancelled&) {
      return std::nullopt;
    }
  };
  if (folder.empty()) return tools;
  tools.save = [folder](const std::string& name, const CalibrationResult& result) {
    return SaveBeside(folder, name, result);
  };
  return tools;
}

}  // namespace kestrel
