// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_source.h"

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/flight/onboard/realtime_replay.h"
#include "kestrel/flight/ros/dds_camera.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {
namespace {

constexpr std::string_view kSimulated = "sim:";
constexpr std::string_view kTopic = "dds:";

// A live source that renders its images.
class SimulatedSource : public LiveSource {
 public:
  SimulatedSource(const SimulatedCameraOptions& options, VehicleWorld* world, Time start,
                  std::uint64_t seed)
      : camera_(options, world, start, seed) {}

  std::optional<Event> Next(Duration timeout) override {
    Frame frame;
    if (!camera_.Next(&frame, timeout)) return std::nullopt;
    ++captured_;
    return Event(std::move(frame));
  }

  CaptureCounters counters() const override {
    return {.captured = captured_, .missed = static_cast<std::uint64_t>(camera_.left_out())};
  }

  SimulatedCamera& camera() { return camera_; }

 private:
  SimulatedCamera camera_;
  std::atomic<std::uint64_t> captured_{0};
};

// Splits "straight,a=1,b=2" into "straight", "a=1", "b=2".
std::vector<std::string> Split(std::string_view text) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

// The simulated camera's calibration, or the one of --camera; a file without a mount gets the
// simulated camera's.
CameraCalibration SimulatedCalibration(const SourceArguments& arguments,
                                       const CameraCalibration& own) {
  if (arguments.camera.empty()) return own;
  CameraCalibration calibration = ReadCalibration(arguments.camera);
  CheckImageSize(calibration.intrinsics, own.intrinsics.width_px, own.intrinsics.height_px,
                 arguments.sources.front());
  if (!calibration.body_from_camera) calibration.body_from_camera = own.body_from_camera;
  return calibration;
}

FlySource OpenSimulated(const SourceArguments& arguments, const FlyOptions& options) {
  const std::string_view scenario =
      std::string_view(arguments.sources.front()).substr(kSimulated.size());
  std::vector<std::string> settings = Split(scenario);
  const std::string name = settings.front();
  settings.erase(settings.begin());
  const auto seed = static_cast<std::uint64_t>(options.sim_seed);
  const Time start = Now();
  FlySource opened;
  opened.world = std::make_unique<VehicleWorld>(ReadVehicleWorld(name, settings), start, seed);
  auto source =
      std::make_unique<SimulatedSource>(options.sim_camera, opened.world.get(), start, seed);
  opened.simulated = &source->camera();
  opened.calibration = SimulatedCalibration(arguments, source->camera().calibration());
  opened.rate_hz = options.sim_camera.rate_hz;
  opened.source = std::move(source);
  return opened;
}

FlySource OpenCamera(const SourceArguments& arguments, PixelFormat format,
                     const FlyOptions& options) {
  if (arguments.camera.empty()) {
    throw InputError(
        "no calibration: a camera needs one, give it by --camera FILE (kestrel calibrate lens "
        "makes one)");
  }
  FlySource opened;
  opened.calibration = ReadCalibration(arguments.camera);
  if (arguments.clock_offset) {
    opened.calibration.clock_offset = DurationFromSeconds(*arguments.clock_offset);
  }
  auto camera = std::make_unique<GstreamerCamera>(
      arguments.sources.front(), opened.calibration.intrinsics, format, options.camera);
  opened.actuator = camera.get();
  opened.rate_hz = kNominalRateHz;
  opened.source = std::move(camera);
  return opened;
}

// Takes calibration and mount from the topics beside the images, unless --camera has them.
FlySource OpenTopic(const SourceArguments& arguments, PixelFormat format,
                    const DdsOptions& options) {
  std::optional<CameraCalibration> told;
  if (!arguments.camera.empty()) told = ReadCalibration(arguments.camera);
  DdsCameraOptions camera_options;
  camera_options.image = arguments.sources.front().substr(kTopic.size());
  camera_options.topics = arguments.bag.topics;
  camera_options.format = format;
  camera_options.body_frame = options.body_frame;
  if (told) camera_options.camera = told->intrinsics;
  camera_options.wait_s = options.wait_s;
  FlySource opened;
  opened.node = arguments.dds.OpenNode(options);
  auto camera = std::make_unique<DdsCamera>(
      opened.node, camera_options,
      [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); });
  opened.calibration = told ? *told : *camera->calibration();
  if (!opened.calibration.body_from_camera) opened.calibration.body_from_camera = camera->mount();
  if (arguments.clock_offset) {
    opened.calibration.clock_offset = DurationFromSeconds(*arguments.clock_offset);
  }
  opened.has_poses = camera->has_poses();
  if (opened.has_poses && !opened.calibration.body_from_camera) {
    fmt::print(stderr,
               "kestrel: no mount: no positions in the world; expected a static transform from {} "
               "to {}, or --camera FILE with T_BS\n",
               options.body_frame, camera->camera_frame());
  }
  opened.rate_hz = kNominalRateHz;
  opened.frames.emplace();
  opened.frames->camera = camera->camera_frame();
  if (opened.has_poses) opened.frames->world = camera->world_frame();
  opened.frames->to_stamps = camera->to_stamps();
  opened.source = std::move(camera);
  return opened;
}

FlySource OpenReplay(const SourceArguments& arguments, PixelFormat format, bool is_looped) {
  OpenedSource recording = arguments.Open(format);
  FlySource opened;
  opened.calibration = recording.calibration;
  opened.rate_hz = recording.source->rate_hz();
  opened.has_poses = !recording.source->poses().empty();
  const auto open = [bag = arguments.bag, sources = arguments.sources, format] {
    return bag.Open(sources, format);
  };
  opened.source = std::make_unique<RealtimeReplay>(
      open, opened.calibration.clock_offset.value_or(Duration::zero()), is_looped);
  return opened;
}

}  // namespace

AutopilotOptions FlySource::Asking(AutopilotOptions options) const {
  options.wants_true_pose = options.wants_true_pose || simulated != nullptr;
  return options;
}

void FlySource::TakePose(const PoseSample& pose) {
  if (simulated != nullptr && !has_true_poses) simulated->AddPose(pose);
}

void FlySource::TakeTruePose(const PoseSample& pose) {
  has_true_poses = true;
  if (simulated != nullptr) simulated->AddPose(pose);
}

FlySource OpenFlySource(const SourceArguments& arguments, PixelFormat format,
                        const KestrelOptions& options, bool is_looped) {
  const std::string& first = arguments.sources.front();
  if (first.starts_with(kTopic)) return OpenTopic(arguments, format, options.dds);
  if (first.starts_with(kSimulated)) return OpenSimulated(arguments, options.fly);
  if (IsCamera(first)) return OpenCamera(arguments, format, options.fly);
  return OpenReplay(arguments, format, is_looped);
}

}  // namespace kestrel
