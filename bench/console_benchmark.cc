// SPDX-License-Identifier: BSD-3-Clause
// What the console costs the vision thread: the time of a frame, detection and hand-over, at 30 Hz
// with nobody looking, with one browser, and with 20 of which one is stalled. The browsers are
// threads of this program, less urgent than all else, as they would be on another computer. The
// rounds of all three are taken in turn, so that noise hits all alike.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <sys/resource.h>
#include <thread>
#include <time.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/camera/paper_camera.h"
#include "kestrel/console/test_browser.h"
#include "kestrel/console/web_server.h"
#include "kestrel/landing/landing_pattern_detector.h"
#include "kestrel/stills/landing_stills.h"

namespace kestrel {
namespace {

constexpr int kRounds = 4;
constexpr int kFramesInRound = 150;
constexpr std::chrono::microseconds kFrameInterval(33333);

// A browser that looks, or one that has stopped reading.
class Browser {
 public:
  Browser(int port, bool is_stalled) : socket_(port) {
    socket_.Send(R"({"images": true})");
    if (!is_stalled) thread_ = std::thread([this] { Look(); });
  }
  ~Browser() {
    socket_.Shutdown();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void Look() {
    setpriority(PRIO_PROCESS, 0, 19);
    while (const auto image = socket_.Next("image")) {
      socket_.Send(fmt::format(R"({{"ack": {}}})", (*image)["sequence"].get<std::uint64_t>()));
    }
  }

  TestSocket socket_;
  std::thread thread_;
};

struct Times {
  std::vector<double> wall_ms, cpu_ms;  // of each frame
};

double ThreadTime_ms() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * time.tv_sec + 1e-6 * time.tv_nsec;
}

// What the vision does with a frame where there is a console.
class Vision {
 public:
  explicit Vision(ConsoleFeed* feed)
      : feed_(feed), detector_(CameraModel(PaperCamera()), {}), image_(Image()) {}

  void SeeFrame(Times* times) {
    const Time begin = Now();
    const double cpu_begin = ThreadTime_ms();
    const LandingReport report = detector_.Detect(image_, {}, workspace_);
    if (feed_->IsWatched()) Tell(report);
    times->cpu_ms.push_back(ThreadTime_ms() - cpu_begin);
    times->wall_ms.push_back(1e3 * ToSeconds(Now() - begin));
  }

 private:
  static cv::Mat Image() { return LandingStillMaker({}).MakePattern(1).image; }

  void Tell(const LandingReport& report) {
    frame_.captured = Now();
    frame_.image = image_;
    frame_.shapes.clear();
    if (report.detection) frame_.shapes.push_back({OverlayLayer::kDetection, Circle(), "found"});
    feed_->SetFrame(&frame_);
    feed_->Add(ConsoleSample{frame_.captured, {1, 2, 3, 4, 5, 6}});
    feed_->Add(ConsoleStatus{"tracking", "", false});
    feed_->Add(ConsoleMap{});
  }

  static std::vector<cv::Point2f> Circle() {
    std::vector<cv::Point2f> circle;
    for (int i = 0; i < 64; ++i) {
      circle.emplace_back(300 + 90 * std::cos(0.1 * i), 200 + 90 * std::sin(0.1 * i));
    }
    return circle;
  }

  ConsoleFeed* feed_;
  LandingPatternDetector detector_;
  LandingWorkspace workspace_;
  cv::Mat image_;
  ConsoleFrame frame_;
};

double Quantile(std::vector<double> values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * (values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void RunRound(Vision* vision, const WebServer& server, int browsers, Times* times) {
  std::vector<std::unique_ptr<Browser>> all;
  for (int i = 0; i < browsers; ++i) {
    all.push_back(std::make_unique<Browser>(server.port(), browsers > 1 && i == 0));
  }
  for (int i = 0; i < kFramesInRound; ++i) {
    const auto next = std::chrono::steady_clock::now() + kFrameInterval;
    vision->SeeFrame(times);
    std::this_thread::sleep_until(next);
  }
}

void Run() {
  ConsoleFeed feed({.title = "benchmark",
                    .is_live = true,
                    .series = {},
                    .layers = {},
                    .views = {},
                    .offers = {}});
  ConsoleOptions options;
  options.port = 0;
  const WebServer server(options, &feed, {});
  Vision vision(&feed);
  Times warm_up;
  RunRound(&vision, server, 0, &warm_up);
  const int counts[] = {0, 1, 20};
  Times times[3];
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < 3; ++i) RunRound(&vision, server, counts[i], &times[i]);
  }
  fmt::print("{:>9} {:>12} {:>12} {:>12} {:>12}\n", "browsers", "wall p50 ms", "wall p99 ms",
             "cpu p50 ms", "cpu p99 ms");
  for (int i = 0; i < 3; ++i) {
    fmt::print("{:>9} {:>12.3f} {:>12.3f} {:>12.3f} {:>12.3f}\n", counts[i],
               Quantile(times[i].wall_ms, 0.5), Quantile(times[i].wall_ms, 0.99),
               Quantile(times[i].cpu_ms, 0.5), Quantile(times[i].cpu_ms, 0.99));
  }
}

}  // namespace
}  // namespace kestrel

int main() { kestrel::Run(); }
