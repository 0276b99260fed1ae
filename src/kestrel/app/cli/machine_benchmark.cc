// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/machine_benchmark.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/session/land_task.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/objects/object_detector.h"
#include "kestrel/vision/tags/tag_board_detector.h"

namespace kestrel {
namespace {

constexpr double kImagesPerSecond = 30;
constexpr int kImages = 48;
constexpr int kRounds = 5;  // over the images of a step

using Images = std::vector<cv::Mat>;

Images Rendered(const RecordingPlan& plan) {
  Images images(plan.times.size());
  const std::size_t workers = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (std::size_t first = 0; first < workers; ++first) {
    threads.emplace_back([&, first] {
      for (std::size_t i = first; i < images.size(); i += workers) images[i] = plan.render(i);
    });
  }
  threads.clear();  // waits
  return images;
}

Images RenderedLanding(const std::string& target) {
  return Rendered(
      PlanLandingScenario("figure8",
                          {fmt::format("frames={}", kImages), "rate_hz=10", "ground.map_px=256",
                           "shutter.rays_per_pixel=4", "flight.start_altitude_m=9",
                           "flight.end_altitude_m=1", "target.kind=" + target},
                          PaperCalibration(), /*seed=*/7));
}

Images RenderedHunt() {
  return Rendered(PlanHuntScenario("sweep", {"frames=16", "rate_hz=4", "shutter.rays_per_pixel=4"},
                                   HuntCalibration(), /*seed=*/3));
}

double ThreadMs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Calls 'work' with each image, several times; the first round warms up and does not count.
template <class Work>
StepTimes Measure(const std::string& step, const Images& images, Work&& work) {
  StepTimes times{step, {}};
  for (int round = 0; round <= kRounds; ++round) {
    for (const cv::Mat& image : images) {
      const double start = ThreadMs();
      work(image);
      if (round > 0) times.ms.push_back(ThreadMs() - start);
    }
  }
  return times;
}

StepTimes InWholeImages(const std::string& step, const TargetDetector& detector,
                        const Images& images) {
  const std::unique_ptr<TargetWorkspace> workspace = detector.MakeWorkspace();
  return Measure(step, images,
                 [&](const cv::Mat& image) { detector.Detect(image, {}, *workspace); });
}

// The hint is a detection in the same image: a track says it as well.
StepTimes NearItsLastPlace(const std::string& step, const TargetDetector& detector,
                           const Images& images) {
  const std::unique_ptr<TargetWorkspace> workspace = detector.MakeWorkspace();
  std::vector<TargetHint> hints;
  Images seen;
  for (const cv::Mat& image : images) {
    const TargetReport report = detector.Detect(image, {}, *workspace);
    if (!report.detection) continue;
    TargetHint hint;
    hint.center_in_camera = report.detection->camera_from_target.translation;
    hint.center_sigma_m = 0.1;
    seen.push_back(image);
    hints.push_back(hint);
  }
  std::size_t next = 0;
  return Measure(step, seen, [&](const cv::Mat& image) {
    detector.Detect(image, hints[next++ % hints.size()], *workspace);
  });
}

StepTimes Objects(const Images& images) {
  const ObjectDetector detector(CameraModel(HuntCalibration().intrinsics), DefaultObjectModel());
  ObjectWorkspace workspace;
  ObjectReport report;
  return Measure("coloured objects, whole image, 1280 x 720", images,
                 [&](const cv::Mat& image) { detector.Detect(image, {}, workspace, &report); });
}

StepTimes RaysOfAllPixels(const CameraModel& camera, const Images& images) {
  const RayTable table(camera);
  const auto count = static_cast<std::size_t>(camera.width_px());
  std::vector<float> u(count), v(count), x(count), y(count), z(count);
  for (std::size_t i = 0; i < count; ++i) u[i] = static_cast<float>(i);
  return Measure("rays of all pixels, 752 x 480", images, [&](const cv::Mat& image) {
    for (int row = 0; row < image.rows; ++row) {
      std::fill(v.begin(), v.end(), static_cast<float>(row));
      table.Rays(u.data(), v.data(), count, x.data(), y.data(), z.data());
    }
  });
}

// A camera that has the images already.
class ReadyCamera : public LiveSource {
 public:
  explicit ReadyCamera(const Images& images) : images_(images), next_(Clock::now()) {}

  std::optional<Event> Next(Duration /*timeout*/) override {
    constexpr std::uint64_t kSeconds = 5;
    if (captured_ == kSeconds * static_cast<std::uint64_t>(kImagesPerSecond)) return EndOfStream();
    next_ += std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1 / kImagesPerSecond));
    std::this_thread::sleep_until(next_);
    const cv::Mat& image = images_[captured_ % images_.size()];
    return Frame{std::to_string(captured_++), Now(), image};
  }

  CaptureCounters counters() const override { return {.captured = captured_}; }

 private:
  using Clock = std::chrono::steady_clock;

  const Images& images_;
  Clock::time_point next_;
  std::uint64_t captured_ = 0;
};

class Latencies : public ObservationSink {
 public:
  explicit Latencies(std::vector<double>* ms) : ms_(*ms) {}
  void Take(const Observation& observation) override {
    if (observation.latency) ms_.push_back(1e3 * ToSeconds(*observation.latency));
  }

 private:
  std::vector<double>& ms_;
};

StepTimes CaptureToResult(const Images& images) {
  StepTimes times{"capture to result, 30 images/s for 5 s", {}, /*is_work=*/false};
  const OpenedLiveSource camera{.source = std::make_unique<ReadyCamera>(images),
                                .calibration = PaperCalibration(),
                                .rate_hz = kImagesPerSecond};
  const auto session = MakeSession(camera, LandTask({}));
  session->sinks().Add(std::make_unique<Latencies>(&times.ms));
  session->Run();
  return times;
}

}  // namespace

std::vector<StepTimes> MeasureSteps(const std::function<void(const std::string&)>& print) {
  const CameraModel camera(PaperCalibration().intrinsics);
  std::vector<StepTimes> steps;
  print("rendering a flight over the ring");
  const Images ring = RenderedLanding("ring-cross");
  print("rendering a flight over a tag");
  const Images tag = RenderedLanding("apriltag");
  print("rendering a flight over coloured objects");
  const Images objects = RenderedHunt();
  print("measuring");
  const LandingPatternDetector ring_detector(camera, {});
  steps.push_back(InWholeImages("ring, whole image, 752 x 480", ring_detector, ring));
  steps.push_back(NearItsLastPlace("ring, near its last place", ring_detector, ring));
  const TagBoardDetector tag_detector(camera, TagBoard{{BoardTag()}}, {});
  steps.push_back(InWholeImages("AprilTag 36h11, whole image, 752 x 480", tag_detector, tag));
  steps.push_back(Objects(objects));
  steps.push_back(RaysOfAllPixels(camera, ring));
  print("flying for 5 s");
  steps.push_back(CaptureToResult(ring));
  return steps;
}

}  // namespace kestrel
