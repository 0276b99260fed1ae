// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_source.h"

#include <atomic>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/onboard/several_sources.h"

namespace kestrel {
namespace {

constexpr std::string_view kPrefix = "sim:";

// A live source that renders its images.
class RenderedSource : public LiveSource {
 public:
  RenderedSource(const SimulatedCameraOptions& options, VehicleWorld* world, Time start,
                 std::uint64_t seed, const std::optional<GimbalMount>& gimbal)
      : camera_(options, world, start, seed, gimbal) {}
  RenderedSource(const SimulatedCameraOptions& options, VehicleWorld* world, Time start,
                 std::uint64_t seed, const CameraCalibration& calibration)
      : camera_(options, world, start, seed, calibration) {}

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

// The user's calibration; nothing: there is none.
std::optional<CameraCalibration> GivenCalibration(const RecordingChoice& choice) {
  if (choice.camera.empty()) return std::nullopt;
  return ReadCalibration(choice.camera, "", choice.bag.notify);
}

}  // namespace

bool SimulatedSource::IsNamed(std::string_view uri) { return uri.starts_with(kPrefix); }

SourceScheme SimulatedSource::Scheme() {
  return {std::string(kPrefix), [this](const LiveSourceChoice& choice) { return Open(choice); }};
}

OpenedLiveSource SimulatedSource::Open(const LiveSourceChoice& choice) {
  std::vector<std::string> settings = Split(std::string_view(choice.uri()).substr(kPrefix.size()));
  const std::string scenario = settings.front();
  settings.erase(settings.begin());
  const Time start = Now();
  world_ =
      std::make_unique<VehicleWorld>(ReadVehicleWorld(scenario, settings, target_), start, seed_);
  const auto given = GivenCalibration(choice.recording);
  auto source = std::make_unique<RenderedSource>(options_, world_.get(), start, seed_,
                                                 given ? given->gimbal : std::nullopt);
  const CameraCalibration& own = source->camera().calibration();
  OpenedLiveSource opened;
  opened.calibration = given.value_or(own);
  CheckImageSize(opened.calibration.intrinsics, own.intrinsics.width_px, own.intrinsics.height_px,
                 choice.uri());
  if (!opened.calibration.body_from_camera) {
    opened.calibration.body_from_camera = own.body_from_camera;
  }
  opened.rate_hz = options_.rate_hz;
  cameras_ = {&source->camera()};
  opened.source = std::move(source);
  opened.pose = [this](const PoseSample& pose) { TakePose(pose); };
  opened.true_pose = [this](const PoseSample& pose) { TakeTruePose(pose); };
  if (options_.second.is_there()) {
    AddSecond(start, &opened);
  } else if (!world_->options().thing.is_there() && !world_->options().field.is_there()) {
    opened.truth = [this](const Frame& frame) { return cameras_[0]->Truth(frame); };
  }
  return opened;
}

// Each camera then renders in a thread of its own, and only that one could ask for its truth.
void SimulatedSource::AddSecond(Time start, OpenedLiveSource* opened) {
  auto source =
      std::make_unique<RenderedSource>(options_.OfSecond(), world_.get(), start, seed_ + 1,
                                       SimulatedCamera::CalibrationOfSecond(options_));
  cameras_.push_back(&source->camera());
  opened->calibration.name = "cam0";
  opened->further = {source->camera().calibration()};
  opened->further[0].name = "cam1";
  std::vector<SeveralSources::Camera> sources;
  sources.push_back({"cam0", std::move(opened->source)});
  sources.push_back({"cam1", std::move(source)});
  opened->source = std::make_unique<SeveralSources>(std::move(sources));
}

VehicleWorld* SimulatedSource::World() {
  if (!world_) {
    world_ =
        std::make_unique<VehicleWorld>(ReadVehicleWorld("standing", {}, target_), Now(), seed_);
  }
  return world_.get();
}

void SimulatedSource::TakePose(const PoseSample& pose) {
  if (has_true_poses_) return;
  for (SimulatedCamera* camera : cameras_) camera->AddPose(pose);
}

void SimulatedSource::TakeTruePose(const PoseSample& pose) {
  has_true_poses_ = true;
  for (SimulatedCamera* camera : cameras_) camera->AddPose(pose);
}

AutopilotOptions SimulatedSource::Asking(AutopilotOptions options) const {
  options.wants_true_pose = options.wants_true_pose || !cameras_.empty();
  return options;
}

}  // namespace kestrel
