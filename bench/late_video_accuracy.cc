// SPDX-License-Identifier: BSD-3-Clause
// Lands simulated UAVs through a camera that comes by RTSP, late and with losses, in real time.
// Prints for each flight the delay of the line, what Kestrel measured at the end, how the flight
// ended and the distance from the centre. Usage:
// late_video_accuracy [--flights N] [--first-seed N] [--delay-ms N]... [--loss SHARE] [--guide]
// [--source sim:SCENARIO] [--autopilot NAME] [--set KEY=VALUE]...
#include <atomic>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/onboard/gstreamer_camera.h"
#include "kestrel/flight/onboard/late_video.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/onboard/test_rtsp_server.h"
#include "report_main.h"

namespace kestrel {
namespace {

// Key frames twice a second, also where few images are rendered.
constexpr char kEncoder[] =
    "x264enc tune=zerolatency speed-preset=ultrafast key-int-max=5 bitrate=600 ! "
    "rtph264pay name=pay0 pt=96 config-interval=-1";

struct Arguments {
  std::vector<int> delays_ms = {100, 200, 300};
  int flights = 20;
  std::uint64_t first_seed = 1;
  double loss = 0.02;
  std::string source = "sim:standing";
  std::string autopilot = "sim:ardupilot";
  std::vector<std::string> settings;
  bool guides = false;
  bool is_loud = false;
};

// A camera whose images make a detour over a server.
class Detour : public LiveSource {
 public:
  Detour(std::unique_ptr<LiveSource> source, const CameraIntrinsics& camera,
         const TestVideoLine& line)
      : server_(line), source_(std::move(source)), camera_(camera) {
    sending_ = std::thread([this] {
      while (!is_over_) {
        const auto event = source_->Next(std::chrono::milliseconds(50));
        if (!event || !std::holds_alternative<Frame>(*event)) continue;
        const auto& frame = std::get<Frame>(*event);
        server_.Push(frame.image, frame.time);
      }
    });
  }
  ~Detour() override {
    video_.reset();
    is_over_ = true;
    sending_.join();
  }

  std::optional<Event> Next(Duration timeout) override {
    // The first images come when the autopilot has sent its first poses.
    if (!video_) {
      video_ = std::make_unique<GstreamerCamera>(server_.address(), camera_, PixelFormat::kGray,
                                                 GstreamerCameraOptions());
      is_open_ = true;
    }
    return video_->Next(timeout);
  }
  std::string error() const override { return is_open_ ? video_->error() : ""; }
  CaptureCounters counters() const override {
    return is_open_ ? video_->counters() : CaptureCounters();
  }

 private:
  TestRtspServer server_;
  std::unique_ptr<LiveSource> source_;
  CameraIntrinsics camera_;
  std::unique_ptr<GstreamerCamera> video_;
  std::atomic<bool> is_open_{false};
  std::atomic<bool> is_over_{false};
  std::thread sending_;
};

class Words : public ObservationSink {
 public:
  void Take(const Observation&) override {}
  void Take(const SessionEvent& event) override { std::cerr << event.text + "\n"; }
  bool IsWanted() const override { return false; }
};

// Sends the images over a line.
void MakeLate(const Arguments& arguments, int delay_ms, std::uint64_t seed,
              OpenedLiveSource* live) {
  const TestVideoLine line{.delay = std::chrono::milliseconds(delay_ms),
                           .jitter = std::chrono::milliseconds(20),
                           .loss = arguments.loss,
                           .encoder = kEncoder,
                           .seed = seed};
  auto detour =
      std::make_unique<Detour>(std::move(live->source), live->calibration.intrinsics, line);
  auto video = std::make_unique<LateVideo>(std::move(detour), live->calibration, true);
  live->late = {{.video = video.get()}};
  live->source = std::move(video);
  live->truth = {};  // of the frames before the line
}

void FlyOne(const Arguments& arguments, int delay_ms, std::uint64_t seed) {
  KestrelOptions options = ReadKestrelOptions("", arguments.settings);
  options.fly.sim_seed = static_cast<int>(seed);
  FlySource source(options, {});
  RecordingChoice choice;
  choice.sources = {arguments.source};
  source.Open(choice, false);
  OpenedLiveSource& live = source.live;
  if (delay_ms > 0) MakeLate(arguments, delay_ms, seed, &live);
  FlyAutopilot autopilot =
      MakeFlyAutopilot(arguments.autopilot, options.fly, arguments.guides, &source);
  const auto task = MakeTask("land", options, {});
  const auto session =
      MakeSession(live, *task, SessionOptionsFor(autopilot, options.fly, arguments.guides));
  if (arguments.is_loud) session->sinks().Add(std::make_unique<Words>());
  const Time start = Now();
  autopilot.simulated->Start();
  const FlightEnd end = session->Run([&] { return Now() - start > std::chrono::seconds(150); });
  autopilot.simulated->Stop();
  std::optional<ClockEstimate> offset;
  for (const LateCamera& late : live.late) offset = late.video->offset();
  fmt::print("{},{},{},{},{},{:.1f}\n", delay_ms, seed,
             offset ? fmt::format("{:.0f}", -1e3 * offset->offset_s) : "", ToString(end.outcome),
             end.offset_m ? fmt::format("{:.3f}", *end.offset_m) : "", ToSeconds(Now() - start));
  std::cout << std::flush;
}

void Run(const Arguments& arguments) {
  fmt::print("delay_ms,seed,measured_ms,end,offset_m,time_s\n");
  for (int i = 0; i < arguments.flights; ++i) {
    const std::vector<int>& delays = arguments.delays_ms;
    FlyOne(arguments, delays[i % delays.size()], arguments.first_seed + i);
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app{"Landings through late video"};
  kestrel::Arguments arguments;
  app.add_option("--delay-ms", arguments.delays_ms,
                 "Delay of the line; 0: no line; may be given again")
      ->allow_extra_args(false);
  app.add_option("--flights", arguments.flights, "How many, each with the next seed (20)");
  app.add_option("--first-seed", arguments.first_seed, "Seed of the first flight (1)");
  app.add_option("--loss", arguments.loss, "Share of the packets that are lost (0.02)");
  app.add_option("--source", arguments.source, "sim:standing, sim:figure8, ...");
  app.add_option("--autopilot", arguments.autopilot, "sim:ardupilot or sim:px4");
  app.add_option("--set", arguments.settings, "One option, as key=value; may be given again")
      ->allow_extra_args(false);
  app.add_flag("--guide", arguments.guides, "Kestrel flies by set-points");
  app.add_flag("--loud", arguments.is_loud, "Print what Kestrel reports");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(arguments);
    return 0;
  });
}
