// SPDX-License-Identifier: BSD-3-Clause
// Speed of the object detector on 1280 x 720 with one thread, compared with other work on all
// pixels: a scalar pass of table look-ups (the first step of the authors' code), and the masks and
// connected components of OpenCV.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_detector.h"

namespace kestrel {
namespace {

constexpr int kDiscRadius_px = 15;

CameraModel Camera(const cv::Size& size) {
  return CameraModel({size.width,
                      size.height,
                      800,
                      800,
                      0.5 * size.width,
                      0.5 * size.height,
                      DistortionModel::kNone,
                      {}});
}

// Asphalt with noise and 'discs' red discs, the first in the middle.
cv::Mat DrawScene(const cv::Size& size, int discs) {
  Random random(1);
  cv::Mat image(size, CV_8UC3);
  cv::RNG noise(1);
  noise.fill(image, cv::RNG::NORMAL, cv::Scalar(95, 100, 105), cv::Scalar(12, 12, 12));
  for (int i = 0; i < discs; ++i) {
    const cv::Point center = i == 0 ? cv::Point(size.width / 2, size.height / 2)
                                    : cv::Point(random.Integer(20, size.width - 20),
                                                random.Integer(20, size.height - 20));
    cv::circle(image, center, kDiscRadius_px, cv::Scalar(45, 40, 200), cv::FILLED, cv::LINE_AA);
  }
  cv::GaussianBlur(image, image, cv::Size(), 0.7);
  return image;
}

void BM_ScalarLookUps(benchmark::State& state) {
  const cv::Mat image = DrawScene({1280, 720}, 5);
  const ColorGrid grid(DefaultObjectModel().colors);
  std::vector<int> labels(image.total());
  for (auto _ : state) {
    for (std::size_t i = 0; i < image.total(); ++i) labels[i] = -grid.At(image.data + 3 * i);
    benchmark::DoNotOptimize(labels.data());
    benchmark::ClobberMemory();
  }
}

void BM_OpenCv(benchmark::State& state) {
  const cv::Mat image = DrawScene({1280, 720}, 5);
  cv::Mat hsv;
  cv::Mat mask;
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat centroids;
  for (auto _ : state) {
    cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
    cv::inRange(hsv, cv::Scalar(170, 120, 60), cv::Scalar(180, 255, 255), mask);
    benchmark::DoNotOptimize(
        cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 4));
  }
}

// 99th percentile of the processor time for frames with 0 to 7 discs, relative to the median.
void BM_FlightP99(benchmark::State& state) {
  constexpr int kFrames = 400;
  const cv::Size size(1280, 720);
  const ObjectDetector detector(Camera(size), DefaultObjectModel());
  ObjectWorkspace workspace;
  ObjectReport report;
  std::vector<cv::Mat> images;
  for (int discs = 0; discs < 8; ++discs) images.push_back(DrawScene(size, discs));
  std::vector<double> times_us(kFrames);
  for (auto _ : state) {
    for (int i = 0; i < kFrames; ++i) {
      const std::clock_t start = std::clock();
      detector.Detect(images[i % images.size()], {}, workspace, &report);
      times_us[i] = 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
  }
  std::sort(times_us.begin(), times_us.end());
  const double median_us = times_us[kFrames / 2];
  state.counters["median_us"] = median_us;
  state.counters["p99_by_median"] = times_us[kFrames * 99 / 100] / median_us;
}

void RunDetector(benchmark::State& state, const cv::Mat& image, const ObjectHint& hint) {
  const ObjectDetector detector(Camera(image.size()), DefaultObjectModel());
  ObjectWorkspace workspace;
  ObjectReport report;
  for (auto _ : state) {
    detector.Detect(image, hint, workspace, &report);
    benchmark::DoNotOptimize(report.detections.data());
  }
  state.counters["found"] = static_cast<double>(report.detections.size());
}

void BM_Complete(benchmark::State& state) {
  RunDetector(state, DrawScene({1280, 720}, static_cast<int>(state.range(0))), {});
}

void BM_CompleteBySize(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0));
  RunDetector(state, DrawScene({width, width * 9 / 16}, 5), {});
}

void BM_Track(benchmark::State& state) {
  const std::vector<TrackedObject> track = {{{643, 358}, 0}};
  RunDetector(state, DrawScene({1280, 720}, 5), {track, Eigen::Vector3d(0, 0, -1), 5.34});
}

BENCHMARK(BM_ScalarLookUps)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_OpenCv)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Complete)->Arg(0)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_CompleteBySize)->Arg(640)->Arg(1280)->Arg(1920)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_FlightP99)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Track)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
