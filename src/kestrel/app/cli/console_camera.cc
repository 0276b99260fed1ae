// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/console_camera.h"

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/page_links.h"
#include "kestrel/app/console/camera_console.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/flight/onboard/camera_automatics.h"
#include "kestrel/flight/onboard/flight_keeper.h"
#include "kestrel/io/recording/open_source.h"

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

}  // namespace

bool IsLiveSource(const std::string& source) {
  return IsCamera(source) || SimulatedSource::IsNamed(source) || source.starts_with("dds:");
}

void RunCameraConsole(const ConsoleArguments& arguments) {
  CatchInterrupts();
  const KestrelOptions options = arguments.source.options.Read();
  const std::string& name = arguments.source.sources.front();
  RecordingChoice choice = arguments.source.Recording(PixelFormat::kBgr);
  choice.may_assume_lens = true;
  FlySource source(options, arguments.source.dds.NodeOpener(options.dds));
  const std::string folder = arguments.output.empty() ? "." : arguments.output;
  FlightKeeper keeper(folder, /*recording=*/nullptr);
  CameraConsole::Camera camera;
  camera.name = name;
  camera.open = [&] {
    source.live = {};  // a device can be open once only
    source.Open(choice, /*is_looped=*/true);
    if (SimulatedSource::IsNamed(name)) {
      source.live.source =
          std::make_unique<HoveringCamera>(std::move(source.live.source), &source.simulated);
    }
    return source.live.source.get();
  };
  camera.exposure_s = [&] { return ReadCameraAutomatics(name).exposure_s; };
  camera.keep_snapshot = [&](const cv::Mat& image, Time captured) {
    return keeper.KeepSnapshot(image, captured);
  };
  camera.tell = [](const std::string& fault) { fmt::print(stderr, "kestrel: {}\n", fault); };
  CameraConsole console(arguments.PageOptions(options), camera, folder, options.landing.detector);
  PrintLinks(console.urls());
  console.Play(WasInterrupted);
}

}  // namespace kestrel
