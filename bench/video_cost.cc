// SPDX-License-Identifier: BSD-3-Clause
// Prints what the video of a flight takes while a client plays it: the processor time of drawing,
// encoding and sending, as a share of a core, and the time from capture until an image is encoded.
// A textured image of 640 x 480 px moves; the camera gives 30 a second, of which 15 are shown. The
// client is another process. Usage: video_cost [SECONDS]
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/onboard/gstreamer_pipeline.h"
#include "kestrel/flight/onboard/video_server.h"
#include "kestrel/flight/onboard/video_sink.h"
#include "kestrel/flight/session/follow_task.h"

namespace kestrel {
namespace {

constexpr int kWidth_px = 640, kHeight_px = 480;
constexpr Duration kFramePeriod = std::chrono::microseconds(33'333);
constexpr char kPlay[] = "--play";

// Receives the video until it is killed.
int Play(const std::string& address) {
  GstreamerPipeline player(
      fmt::format("rtspsrc location={} latency=0 ! rtph264depay ! appsink name=sink", address),
      "client", PixelFormat::kGray);
  player.Start();
  for (;;) player.Pull(std::chrono::seconds(1));
}

double ProcessorTime_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) { return time.tv_sec + 1e-6 * time.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class Camera {
 public:
  explicit Camera(ObservationSink* sink)
      : sink_(*sink), ground_(2 * kHeight_px, 2 * kWidth_px, CV_8UC3) {
    Random random(1);
    cv::Mat noise(ground_.rows / 8, ground_.cols / 8, CV_8UC3);
    for (std::size_t i = 0; i < 3 * noise.total(); ++i) {
      noise.data[i] = static_cast<unsigned char>(random.Integer(40, 210));
    }
    cv::resize(noise, ground_, ground_.size(), 0, 0, cv::INTER_CUBIC);
  }

  // Returns the processor time as a share of a core.
  double Run(double seconds) {
    const Time begin = Now();
    const double before_s = ProcessorTime_s();
    for (Time due = begin; ToSeconds(Now() - begin) < seconds; due += kFramePeriod) {
      std::this_thread::sleep_for(due - Now());
      Give();
    }
    return (ProcessorTime_s() - before_s) / ToSeconds(Now() - begin);
  }

 private:
  void Give() {
    const cv::Point place(count_ * 3 % kWidth_px, count_ * 2 % kHeight_px);
    ++count_;
    if (!sink_.IsWanted()) return;
    FollowObservation seen;
    seen.region = RegionReport{RegionState::kFollowing, {300, 200, 40, 60}, 1};
    const cv::Mat image = ground_(cv::Rect(place, cv::Size(kWidth_px, kHeight_px)));
    sink_.Take(Observation{{"", Now(), image}, seen});
  }

  ObservationSink& sink_;
  cv::Mat ground_;
  int count_ = 0;
};

int Measure(double seconds) {
  VideoServer server({.port = 0});
  SessionCamera camera{.is_live = true};
  camera.calibration.intrinsics = {.width_px = kWidth_px,
                                   .height_px = kHeight_px,
                                   .fx_px = 500,
                                   .fy_px = 500,
                                   .cx_px = 319.5,
                                   .cy_px = 239.5,
                                   .distortion = {}};
  const auto sink =
      MakeVideoSink(&server, FollowTask({}).MakeVision(camera)->MakePainter(),
                    [](const std::string& text) { fmt::print(stderr, "{}\n", text); });
  Camera images(sink.get());
  const double alone = images.Run(2);
  const std::string address = fmt::format("rtsp://127.0.0.1:{}/kestrel", server.port());
  const pid_t client = fork();
  if (client == 0) {
    execl("/proc/self/exe", "video_cost", kPlay, address.c_str(), nullptr);
    _exit(1);
  }
  constexpr double kWarmUp_s = 3;
  images.Run(kWarmUp_s);
  const bool is_watched = server.IsWatched();
  const double watched = images.Run(seconds);
  const double delay_s = ToSeconds(server.delay());
  kill(client, SIGKILL);
  waitpid(client, nullptr, 0);
  sink->Finish();
  fmt::print(
      "{} ({}): {:.3f} of a core while a client plays, {:.3f} without; encoded {:.0f} ms "
      "after capture\n",
      is_watched ? "video" : "NO CLIENT CAME", server.encoder(), watched, alone, 1e3 * delay_s);
  return is_watched ? 0 : 1;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], kestrel::kPlay) == 0) return kestrel::Play(argv[2]);
  return kestrel::Measure(argc > 1 ? std::strtod(argv[1], nullptr) : 20);
}
