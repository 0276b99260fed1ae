// SPDX-License-Identifier: BSD-3-Clause
// Errors of a pad's pose in units of its covariance, on rendered descents: by altitude, and the
// jump of the position where other parts of the pad are seen than in the frame before. Usage:
// pad_pose_accuracy [--target KIND] [--board FILE] [--descents N] [--seed N]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "pad_settings.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::array<double, 6> kBinEdges{0.2, 0.4, 0.8, 1.6, 3.2, 6.4};  // altitude, m
constexpr double kStep = 0.88;  // altitude of a frame, of that of the frame before

struct Sighting {
  double altitude_m = 0;
  double nees = 0;             // six degrees of freedom
  Eigen::Vector3d error;       // error of the position, in the pad's axes, m
  Eigen::Matrix3d covariance;  // its covariance, m^2
  std::uint32_t parts = 0;     // a bit for each
};

struct Descent {
  std::vector<std::optional<Sighting>> frames;  // from high to low; nothing where it is not found
  std::vector<double> altitudes_m;
};

std::uint32_t PartsOf(const TargetDetection& detection) {
  constexpr std::size_t kOther = 31;  // the ring, the H
  std::uint32_t parts = 0;
  for (const SeenPart& part : detection.parts.all()) parts |= 1U << part.tag.value_or(kOther);
  return parts;
}

// Returns the rotation vector from the true to the seen orientation, to the nearest of those under
// which the pad looks the same.
Eigen::Vector3d TurnFrom(const RigidTransform& truth, const TargetDetection& detection) {
  const int headings = std::max(detection.heading_symmetry, 1);
  Eigen::Vector3d best = Eigen::Vector3d::Constant(2 * kPi);
  for (int i = 0; i < headings; ++i) {
    const Eigen::Quaterniond turn = RotationBy({0, 0, i * 2 * kPi / headings});
    const Eigen::Vector3d error =
        RotationVector(detection.camera_from_target.rotation * turn * truth.rotation.conjugate());
    if (error.norm() < best.norm()) best = error;
  }
  return best;
}

Sighting Measure(double altitude_m, const TargetDetection& detection, const RigidTransform& truth) {
  Eigen::Matrix<double, 6, 1> error;
  error << detection.camera_from_target.translation - truth.translation, TurnFrom(truth, detection);
  const Eigen::Matrix3d to_pad = truth.rotation.conjugate().toRotationMatrix();
  return {altitude_m, error.dot(detection.covariance.ldlt().solve(error)), to_pad * error.head<3>(),
          to_pad * detection.covariance.topLeftCorner<3, 3>() * to_pad.transpose(),
          PartsOf(detection)};
}

// Returns the hint of a track for a pad of that pose.
TargetHint HintAt(const RigidTransform& pose, double altitude_m, Random* random) {
  constexpr double kTurn = 0.02;  // rad
  const auto draw = [&](double sigma) {
    const double x = random->Normal();
    const double y = random->Normal();
    const double z = random->Normal();
    return Eigen::Vector3d(sigma * Eigen::Vector3d(x, y, z));
  };
  TargetHint hint;
  hint.center_sigma_m = 0.005 + 0.015 * altitude_m;
  hint.center_in_camera = pose.translation + draw(hint.center_sigma_m);
  hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
  hint.rotation_in_camera = RotationBy(draw(kTurn)) * pose.rotation;
  return hint;
}

Descent FlyDown(const TargetDetector& detector, const TargetPrint& print,
                const PadRenderer& renderer, std::uint64_t seed) {
  Random random(seed);
  const PadImageOptions taken = RandomPadImage(&random);
  const auto workspace = detector.MakeWorkspace();
  Descent descent;
  const double first = kBinEdges.back() * std::pow(kStep, random.Uniform());
  for (double altitude = first; altitude > kBinEdges.front(); altitude *= kStep) {
    const RigidTransform pose = RandomPadBelow(altitude, &random);
    const TargetHint hint = HintAt(pose, altitude, &random);
    const cv::Mat image = renderer.Render(print, pose, taken, random.Bits());
    const TargetReport report = detector.Detect(image, hint, *workspace);
    descent.altitudes_m.push_back(altitude);
    descent.frames.emplace_back();
    if (report.detection) descent.frames.back() = Measure(altitude, *report.detection, pose);
  }
  return descent;
}

// Returns how far two errors differ: 1 for what their covariances expect of one axis.
double JumpBetween(const Sighting& a, const Sighting& b) {
  const Eigen::Vector3d jump = b.error - a.error;
  const Eigen::Matrix3d covariance = a.covariance + b.covariance;
  return std::sqrt(jump.dot(covariance.ldlt().solve(jump)) / 3);
}

void PrintConsistency(const std::vector<Descent>& descents) {
  fmt::print(
      "| altitude | frames | found | NEES / 6 mean | NEES / 6 median | within 95 % "
      "|\n|---|---|---|---|---|---|\n");
  constexpr double kNinetyFivePercent = 12.592;  // of chi-square with six degrees of freedom
  for (std::size_t bin = 0; bin + 1 < kBinEdges.size(); ++bin) {
    int frames = 0, within = 0;
    double sum = 0;
    std::vector<double> nees;
    for (const Descent& descent : descents) {
      for (std::size_t i = 0; i < descent.frames.size(); ++i) {
        const double altitude_m = descent.altitudes_m[i];
        if (altitude_m < kBinEdges[bin] || altitude_m >= kBinEdges[bin + 1]) continue;
        ++frames;
        if (!descent.frames[i]) continue;
        nees.push_back(descent.frames[i]->nees / 6);
        sum += nees.back();
        within += descent.frames[i]->nees <= kNinetyFivePercent;
      }
    }
    const auto found = static_cast<double>(nees.size());
    fmt::print("| {} to {} m | {} | {} | {:.2f} | {:.2f} | {:.0f} % |\n", kBinEdges[bin],
               kBinEdges[bin + 1], frames, nees.size(), sum / found,
               nees.empty() ? NAN : MedianInPlace(nees), 100 * within / found);
  }
}

void PrintJumps(const std::vector<Descent>& descents) {
  std::array<std::vector<double>, 2> jumps;  // the same parts seen, others
  for (const Descent& descent : descents) {
    for (std::size_t i = 1; i < descent.frames.size(); ++i) {
      const auto& before = descent.frames[i - 1];
      const auto& now = descent.frames[i];
      if (!before || !now) continue;
      jumps[before->parts != now->parts].push_back(JumpBetween(*before, *now));
    }
  }
  fmt::print(
      "\n| parts seen | pairs of frames | jump median, sigma | worst, sigma | within 2 sigma "
      "|\n|---|---|---|---|---|\n");
  for (const bool changed : {false, true}) {
    std::vector<double>& values = jumps[changed];
    const auto within =
        std::count_if(values.begin(), values.end(), [](double jump) { return jump <= 2; });
    const double worst = values.empty() ? NAN : *std::max_element(values.begin(), values.end());
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {} |\n", changed ? "others" : "the same",
               values.size(), values.empty() ? NAN : MedianInPlace(values), worst, within);
  }
}

void Run(const PadSettings& settings) {
  cv::setNumThreads(1);
  const CameraModel camera(PaperCamera());
  const PadRenderer renderer(camera);
  const LandingPatternDetectorOptions ring;
  const auto detector = MakeTargetDetector(camera, settings.target, ring);
  const TargetPrint print = PrintOfTarget(settings.target, ring.pattern);
  std::vector<Descent> descents(settings.count);
  ForEachIndex(descents.size(), [&](std::size_t i) {
    descents[i] = FlyDown(*detector, print, renderer, settings.seed + i);
  });
  fmt::print("{}\n\n", settings.target.kind);
  PrintConsistency(descents);
  PrintJumps(descents);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Errors of a pad's pose in units of its covariance");
  kestrel::PadSettings settings{.target = {}, .count = 10};
  kestrel::AddOptions(&app, "descents", "Number of descents, each with the next seed", &settings);
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(settings);
    return 0;
  });
}
