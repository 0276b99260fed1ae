// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/open_live_source.h"

#include <utility>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/onboard/realtime_replay.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {
namespace {

// Without a mount nothing is measured in the world.
void MeasureDelay(const GstreamerCameraOptions& options, OpenedLiveSource* opened) {
  if (!opened->calibration.body_from_camera) return;
  const bool corrects = options.measures_delay || !opened->calibration.clock_offset;
  auto video =
      std::make_unique<LateVideo>(std::move(opened->source), opened->calibration, corrects);
  opened->late_video = video.get();
  opened->source = std::move(video);
}

OpenedLiveSource OpenCamera(const RecordingChoice& choice, const GstreamerCameraOptions& options) {
  if (choice.camera.empty() && !choice.may_assume_lens) {
    throw InputError(
        "no calibration: a camera needs one, give it by --camera FILE (kestrel calibrate lens "
        "makes one)");
  }
  OpenedLiveSource opened;
  if (!choice.camera.empty()) opened.calibration = ChosenCalibration(choice);
  auto camera = std::make_unique<GstreamerCamera>(
      choice.sources.front(), opened.calibration.intrinsics, choice.format, options);
  opened.actuator = camera.get();
  opened.source = std::move(camera);
  if (IsNetworkVideo(choice.sources.front()) || options.measures_delay)
    MeasureDelay(options, &opened);
  return opened;
}

OpenedLiveSource OpenReplay(const RecordingChoice& choice, bool is_looped) {
  const OpenedSource recording = OpenRecording(choice);
  OpenedLiveSource opened;
  opened.calibration = recording.calibration;
  opened.rate_hz = recording.source->rate_hz();
  opened.has_poses = !recording.source->poses().empty();
  opened.source = std::make_unique<RealtimeReplay>(
      [choice] { return OpenFrames(choice); },
      opened.calibration.clock_offset.value_or(Duration::zero()), is_looped);
  return opened;
}

}  // namespace

CameraCalibration ChosenCalibration(const RecordingChoice& choice) {
  CameraCalibration calibration = ReadCalibration(choice.camera, "", choice.bag.notify);
  if (choice.clock_offset) calibration.clock_offset = choice.clock_offset;
  return calibration;
}

OpenedLiveSource OpenLiveSource(const LiveSourceChoice& choice,
                                const GstreamerCameraOptions& camera,
                                const std::vector<SourceScheme>& schemes) {
  for (const SourceScheme& scheme : schemes) {
    if (choice.uri().starts_with(scheme.prefix)) return scheme.open(choice);
  }
  if (IsCamera(choice.uri())) return OpenCamera(choice.recording, camera);
  return OpenReplay(choice.recording, choice.is_looped);
}

}  // namespace kestrel
