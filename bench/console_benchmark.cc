// SPDX-License-Identifier: BSD-3-Clause
// Measures the cost of the console for the vision thread: the time of a frame, for the landing
// pipeline and the hand-over to the flight's console, at 30 Hz with no browser, with one, and with
// 20 of which one is stalled. The browsers are threads of this program with a low priority, as if
// they were on another computer. The rounds of all three alternate, so that noise affects all
// alike.
#include <algorithm>
#include <atomic>
#include <memory>
#include <sys/resource.h>
#include <thread>
#include <time.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/console/flight/flight_console.h"
#include "kestrel/app/web_server/test_browser.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

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

// The work of a flight's vision on a frame with a console.
class Vision {
 public:
  explicit Vision(FlightConsole* console)
      : console_(console), pipeline_(Calibration(), StillOptions()), image_(Image()) {}

  void SeeFrame(Times* times) {
    const Frame frame{"", Now(), image_.clone()};  // each has pixels of its own, as of a camera
    const double cpu_begin = ThreadTime_ms();
    const Time start = Now();
    const LandingObservation seen = pipeline_.Process(frame.image, frame.time);
    if (console_->IsWanted()) console_->Take(Observation{frame, seen, Now() - frame.time});
    times->cpu_ms.push_back(ThreadTime_ms() - cpu_begin);
    times->wall_ms.push_back(1e3 * ToSeconds(Now() - start));
  }

  static CameraCalibration Calibration() {
    CameraCalibration calibration;
    calibration.intrinsics = PaperCamera();
    return calibration;
  }
  static LandingPipelineOptions StillOptions() {
    LandingPipelineOptions options;
    options.still = true;
    return options;
  }

 private:
  static cv::Mat Image() { return LandingStillMaker({}).MakePattern(1).image; }

  FlightConsole* console_;
  LandingPipeline pipeline_;
  cv::Mat image_;
};

double Quantile(std::vector<double> values, double part) {
  return QuantileInPlace(values, part, QuantileRank::kLower);
}

void RunRound(Vision* vision, int port, int browsers, Times* times) {
  std::vector<std::unique_ptr<Browser>> all;
  for (int i = 0; i < browsers; ++i) {
    all.push_back(std::make_unique<Browser>(port, browsers > 1 && i == 0));
  }
  for (int i = 0; i < kFramesInRound; ++i) {
    const auto next = std::chrono::steady_clock::now() + kFrameInterval;
    vision->SeeFrame(times);
    std::this_thread::sleep_until(next);
  }
}

void Run() {
  ConsoleOptions options;
  options.port = 0;
  const CameraCalibration calibration = Vision::Calibration();
  FlightConsole console(options, "benchmark",
                        std::vector<TaskView>{ViewOf(calibration, Vision::StillOptions())},
                        FlightExamination(calibration, ".", 0));
  const int port = std::stoi(console.urls().front().substr(console.urls().front().rfind(':') + 1));
  Vision vision(&console);
  Times warm_up;
  RunRound(&vision, port, 0, &warm_up);
  const int counts[] = {0, 1, 20};
  Times times[3];
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < 3; ++i) RunRound(&vision, port, counts[i], &times[i]);
  }
  fmt::print(
      "| browsers | vision, median, ms | 99 %, ms | its CPU time, median, ms | its 99 %, ms |\n"
      "|---|---|---|---|---|\n");
  for (int i = 0; i < 3; ++i) {
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", counts[i],
               Quantile(times[i].wall_ms, 0.5), Quantile(times[i].wall_ms, 0.99),
               Quantile(times[i].cpu_ms, 0.5), Quantile(times[i].cpu_ms, 0.99));
  }
}

}  // namespace
}  // namespace kestrel

int main() { kestrel::Run(); }
