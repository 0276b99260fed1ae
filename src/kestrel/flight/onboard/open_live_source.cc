// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/open_live_source.h"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/onboard/realtime_replay.h"
#include "kestrel/flight/onboard/several_sources.h"
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
  opened->late = {{.video = video.get()}};
  opened->source = std::move(video);
}

// Returns the scheme of a URI; null: none has its prefix.
const SourceScheme* SchemeOf(const std::string& uri, const std::vector<SourceScheme>& schemes) {
  for (const SourceScheme& scheme : schemes) {
    if (uri.starts_with(scheme.prefix)) return &scheme;
  }
  return nullptr;
}

OpenedLiveSource OpenCamera(const RecordingChoice& choice, const GstreamerCameraOptions& options,
                            const std::string& name = "") {
  if (choice.camera.empty() && !choice.may_assume_lens) {
    throw InputError(
        "no calibration: a camera needs one, give it by --camera FILE (kestrel calibrate lens "
        "makes one)");
  }
  OpenedLiveSource opened;
  if (!choice.camera.empty()) opened.calibration = ChosenCalibration(choice, name);
  auto camera = std::make_unique<GstreamerCamera>(
      choice.sources.front(), opened.calibration.intrinsics, choice.format, options);
  opened.actuator = camera.get();
  opened.source = std::move(camera);
  if (IsNetworkVideo(choice.sources.front()) || options.measures_delay) {
    MeasureDelay(options, &opened);
  }
  return opened;
}

OpenedLiveSource OpenReplay(const RecordingChoice& choice, bool is_looped) {
  const OpenedSource recording = OpenRecording(choice);
  OpenedLiveSource opened;
  opened.calibration = recording.calibration;
  opened.further = recording.further;
  opened.rate_hz = recording.source->rate_hz();
  opened.has_poses = !recording.source->poses().empty();
  std::vector<Duration> further_offsets;
  for (const CameraCalibration& camera : opened.further) {
    further_offsets.push_back(camera.clock_offset.value_or(Duration::zero()));
  }
  opened.source = std::make_unique<RealtimeReplay>(
      [choice, has_several = !recording.further.empty()] {
        return has_several ? OpenRecording(choice).source : OpenFrames(choice);
      },
      opened.calibration.clock_offset.value_or(Duration::zero()), is_looped,
      std::move(further_offsets));
  return opened;
}

// Throws InputError for what cannot be one of several.
void RequireOneKind(const std::vector<RecordingChoice>& cameras, const SourceScheme* scheme) {
  std::set<std::string> names;
  for (const RecordingChoice& camera : cameras) {
    const std::string& uri = camera.sources.front();
    if (scheme != nullptr && !uri.starts_with(scheme->prefix)) {
      throw InputError(fmt::format("{}: expected {}..., as the first one", WithoutPassword(uri),
                                   scheme->prefix));
    }
    if (scheme == nullptr && !IsCamera(uri)) {
      throw InputError(WithoutPassword(uri) +
                       ": expected a camera, as the others (/dev/video0, rtsp://...)");
    }
    if (!names.insert(uri).second) {
      throw InputError(WithoutPassword(uri) + ": is given twice");
    };
  }
}

std::string NameOf(std::size_t camera) { return fmt::format("cam{}", camera); }

// Returns whether one file has the calibrations of all. Throws InputError when it lacks one.
bool HaveOneFile(const std::vector<RecordingChoice>& cameras) {
  const std::string& file = cameras.front().camera;
  if (cameras.size() < 2 || file.empty() || cameras[1].camera != file) return false;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (ReadCalibration(file, NameOf(i)).name == NameOf(i)) continue;
    throw InputError(file +
                     ": is of one camera, expected a --camera FILE for each SOURCE, or one "
                     "with an entry for each, as Kalibr's camchain.yaml");
  }
  return true;
}

// Puts the cameras together; the first one's exposure can be set.
OpenedLiveSource AsOne(std::vector<OpenedLiveSource> cameras) {
  OpenedLiveSource all;
  all.actuator = cameras.front().actuator;
  all.calibration = cameras.front().calibration;
  all.has_poses = cameras.front().has_poses;
  std::vector<SeveralSources::Camera> sources;
  for (OpenedLiveSource& camera : cameras) {
    if (!sources.empty()) all.further.push_back(camera.calibration);
    for (const LateCamera& late : camera.late) {
      all.late.push_back({sources.size(), camera.calibration.name, late.video});
    }
    sources.push_back({camera.calibration.name, std::move(camera.source)});
  }
  all.source = std::make_unique<SeveralSources>(std::move(sources));
  return all;
}

}  // namespace

OpenedLiveSource OpenLiveCameras(const std::vector<RecordingChoice>& cameras,
                                 const GstreamerCameraOptions& options,
                                 const std::function<void(const std::string&)>& notify,
                                 const std::vector<SourceScheme>& schemes) {
  const SourceScheme* const scheme = SchemeOf(cameras.front().sources.front(), schemes);
  RequireOneKind(cameras, scheme);
  const bool is_one_file = HaveOneFile(cameras);
  std::vector<OpenedLiveSource> opened;
  std::string fault;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = NameOf(i);
    try {
      const std::string entry = is_one_file ? name : "";
      opened.push_back(scheme != nullptr ? scheme->open({cameras[i], /*is_looped=*/false, entry})
                                         : OpenCamera(cameras[i], options, entry));
      opened.back().calibration.name = name;
    } catch (const InputError& error) {
      fault = fmt::format("{}: {}", name, error.what());
      notify(fault);
    }
  }
  if (opened.empty()) throw InputError(fault);
  if (opened.size() == 1) return std::move(opened.front());
  return AsOne(std::move(opened));
}

CameraCalibration ChosenCalibration(const RecordingChoice& choice, const std::string& name) {
  CameraCalibration calibration = ReadCalibration(choice.camera, name, choice.bag.notify);
  if (choice.clock_offset) calibration.clock_offset = choice.clock_offset;
  return calibration;
}

OpenedLiveSource OpenLiveSource(const LiveSourceChoice& choice,
                                const GstreamerCameraOptions& camera,
                                const std::vector<SourceScheme>& schemes) {
  if (const SourceScheme* scheme = SchemeOf(choice.uri(), schemes)) return scheme->open(choice);
  if (IsCamera(choice.uri())) return OpenCamera(choice.recording, camera);
  return OpenReplay(choice.recording, choice.is_looped);
}

}  // namespace kestrel
