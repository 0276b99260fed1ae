// SPDX-License-Identifier: BSD-3-Clause
// Measures the time per point of methods from a pixel to a ray (RayTable) or to the undistorted
// plane (the paper's Algorithms 1 and 2, OpenCV), with one thread, in the counter "ns_per_point".
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include "kestrel/core/camera/fisheye_undistortion.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/camera/test_cameras.h"

namespace kestrel {
namespace {

struct Pixels {
  std::vector<float> u;
  std::vector<float> v;
};

// Pixels all over the image in random order, the worst case for the tables.
Pixels RandomPixels(std::size_t count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> u(0, 751);
  std::uniform_real_distribution<float> v(0, 479);
  Pixels pixels;
  for (std::size_t i = 0; i < count; ++i) {
    pixels.u.push_back(u(generator));
    pixels.v.push_back(v(generator));
  }
  return pixels;
}

void CountPoints(benchmark::State& state) {
  constexpr double kNanosecond = 1e-9;
  state.counters["ns_per_point"] = benchmark::Counter(
      kNanosecond * static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void RaysInBulk(benchmark::State& state, const CameraIntrinsics& camera) {
  const RayTable table{CameraModel(camera)};
  const std::size_t count = static_cast<std::size_t>(state.range(0));
  const Pixels pixels = RandomPixels(count);
  std::vector<float> x(count), y(count), z(count);
  for (auto _ : state) {
    table.Rays(pixels.u.data(), pixels.v.data(), count, x.data(), y.data(), z.data());
    benchmark::ClobberMemory();
  }
  CountPoints(state);
}
BENCHMARK_CAPTURE(RaysInBulk, equidistant, PaperCamera())->Arg(10000)->Arg(100);
BENCHMARK_CAPTURE(RaysInBulk, radial_tangential, EurocCamera())->Arg(10000);

void OneRay(benchmark::State& state, const CameraIntrinsics& camera) {
  const RayTable table{CameraModel(camera)};
  const Pixels pixels = RandomPixels(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    for (std::size_t i = 0; i < pixels.u.size(); ++i) {
      benchmark::DoNotOptimize(table.Ray(pixels.u[i], pixels.v[i]));
    }
  }
  CountPoints(state);
}
BENCHMARK_CAPTURE(OneRay, equidistant, PaperCamera())->Arg(10000);
BENCHMARK_CAPTURE(OneRay, radial_tangential, EurocCamera())->Arg(10000);

void ExactUnproject(benchmark::State& state, const CameraIntrinsics& camera) {
  const CameraModel model(camera);
  const Pixels pixels = RandomPixels(static_cast<std::size_t>(state.range(0)));
  Eigen::Vector3d ray;
  for (auto _ : state) {
    for (std::size_t i = 0; i < pixels.u.size(); ++i) {
      benchmark::DoNotOptimize(model.Unproject({pixels.u[i], pixels.v[i]}, &ray));
    }
  }
  CountPoints(state);
}
BENCHMARK_CAPTURE(ExactUnproject, equidistant, PaperCamera())->Arg(10000);
BENCHMARK_CAPTURE(ExactUnproject, radial_tangential, EurocCamera())->Arg(10000);

void Algorithm2(benchmark::State& state) {
  const FisheyeUndistortionTable table(PaperCamera());
  const Pixels pixels = RandomPixels(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    for (std::size_t i = 0; i < pixels.u.size(); ++i) {
      benchmark::DoNotOptimize(table.Undistort({pixels.u[i], pixels.v[i]}));
    }
  }
  CountPoints(state);
}
BENCHMARK(Algorithm2)->Arg(10000);

void Algorithm1(benchmark::State& state) {
  const CameraIntrinsics camera = PaperCamera();
  const Pixels pixels = RandomPixels(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    for (std::size_t i = 0; i < pixels.u.size(); ++i) {
      benchmark::DoNotOptimize(UndistortIterative(camera, {pixels.u[i], pixels.v[i]}));
    }
  }
  CountPoints(state);
}
BENCHMARK(Algorithm1)->Arg(10000);

void OpenCvFisheye(benchmark::State& state) {
  cv::setNumThreads(1);
  const CameraIntrinsics c = PaperCamera();
  const cv::Matx33d matrix(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  const cv::Vec4d coefficients(c.distortion.data());
  const Pixels pixels = RandomPixels(static_cast<std::size_t>(state.range(0)));
  std::vector<cv::Point2f> points, undistorted;
  for (std::size_t i = 0; i < pixels.u.size(); ++i) {
    points.emplace_back(pixels.u[i], pixels.v[i]);
  }
  for (auto _ : state) {
    cv::fisheye::undistortPoints(points, undistorted, matrix, coefficients);
    benchmark::ClobberMemory();
  }
  CountPoints(state);
}
BENCHMARK(OpenCvFisheye)->Arg(10000);

}  // namespace
}  // namespace kestrel
