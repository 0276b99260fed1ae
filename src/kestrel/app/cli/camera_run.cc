// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/camera_run.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/page_links.h"
#include "kestrel/app/cli/terminal.h"
#include "kestrel/flight/onboard/camera_automatics.h"
#include "kestrel/io/recording/media/video_address.h"

namespace kestrel {
namespace {

// A simulated camera where nothing flies: it hovers over the pad.
class HoveringCamera : public LiveSource {
 public:
  HoveringCamera(std::unique_ptr<LiveSource> source, SimulatedSource* simulated)
      : source_(std::move(source)), simulated_(simulated) {}

  std::optional<Event> Next(Duration timeout) override {
    constexpr double kHeight_m = 4;
    simulated_->TakePose(
        {Now(), {Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, kHeight_m)}});
    return source_->Next(timeout);
  }
  std::string error() const override { return source_->error(); }
  CaptureCounters counters() const override { return source_->counters(); }

 private:
  std::unique_ptr<LiveSource> source_;
  SimulatedSource* simulated_;
};

// A camera whose frames are recorded while a recording is on.
class RecordedCamera : public LiveSource {
 public:
  // 'has_ended' is set at the end of the source.
  RecordedCamera(std::unique_ptr<LiveSource> source, const RecordingSwitch* recording,
                 bool* has_ended)
      : source_(std::move(source)), recording_(recording), has_ended_(has_ended) {}

  std::optional<Event> Next(Duration timeout) override {
    std::optional<Event> event = source_->Next(timeout);
    if (!event) return event;
    if (const Frame* const frame = std::get_if<Frame>(&*event)) {
      if (const auto recorder = recording_->Get()) recorder->AddFrame(*frame);
    }
    *has_ended_ = std::holds_alternative<EndOfStream>(*event);
    return event;
  }
  std::string error() const override { return source_->error(); }
  CaptureCounters counters() const override { return source_->counters(); }

 private:
  std::unique_ptr<LiveSource> source_;
  const RecordingSwitch* recording_;
  bool* has_ended_;
};

}  // namespace

CameraRun::CameraRun(const KestrelOptions& options, CameraRunChoice choice, FlySource* source)
    : options_(options),
      choice_(std::move(choice)),
      source_(source),
      recording_([this](const std::filesystem::path& folder, bool replace) {
        return std::make_unique<FlightRecorder>(
            folder, replace, source_->live.calibration, source_->live.rate_hz,
            options_.fly.recorder,
            [this](const std::string& text) { console_.Report(EventLevel::kWarning, text); },
            source_->live.further);
      }),
      keeper_(choice_.keep_folder, &recording_),
      console_(choice_.page, Camera(), choice_.folder, options.landing.detector) {
  if (!choice_.record.empty()) recording_.Start(choice_.record, choice_.replaces);
  if (choice_.page) PrintLinks(console_.urls());
}

CameraConsole::Camera CameraRun::Camera() {
  const std::string name = choice_.camera.sources.front();
  CameraConsole::Camera camera;
  camera.name = WithoutPassword(name);
  if (source_->live.source) camera.source = Wrap();
  camera.open = [this] { return Open(); };
  camera.exposure_s = [name] { return ReadCameraAutomatics(name).exposure_s; };
  camera.keep_snapshot = [this](const cv::Mat& image, Time captured) {
    return keeper_.KeepSnapshot(image, captured);
  };
  camera.record = [this](bool is_on) {
    return is_on ? keeper_.StartRecording() : keeper_.StopRecording();
  };
  camera.is_recording = [this] { return recording_.Get() != nullptr; };
  camera.notify = [](const std::string& fault) { Print(fmt::format("kestrel: {}\n", fault)); };
  return camera;
}

LiveSource* CameraRun::Open() {
  source_->live = {};  // a device can be open once only
  source_->Open(choice_.camera, choice_.is_looped);
  return Wrap();
}

LiveSource* CameraRun::Wrap() {
  std::unique_ptr<LiveSource>& source = source_->live.source;
  if (SimulatedSource::IsNamed(choice_.camera.sources.front())) {
    source = std::make_unique<HoveringCamera>(std::move(source), &source_->simulated);
  }
  source = std::make_unique<RecordedCamera>(std::move(source), &recording_, &has_ended_);
  return source.get();
}

void CameraRun::Play(const std::function<bool()>& is_stopped) {
  console_.Play([&] { return is_stopped() || (has_ended_ && !choice_.is_looped); });
}

std::string CameraRun::State() const {
  const std::uint64_t images = source_->live.source ? source_->live.source->counters().captured : 0;
  std::string state = fmt::format("{} images", images);
  if (const auto recorder = recording_.Get()) {
    const RecorderCounters counters = recorder->counters();
    state += fmt::format(", {} recorded, {} dropped", counters.images, counters.dropped);
  }
  return state;
}

}  // namespace kestrel
