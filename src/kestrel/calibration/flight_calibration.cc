// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/flight_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/LU>
#include <ceres/ceres.h>
#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/calibration/target_path.h"

namespace kestrel {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::size_t kMinSightings = 20;
constexpr Duration kMaxGap = std::chrono::milliseconds(200);
constexpr int kAngles = 3;
constexpr int kClock = 3;  // index of the clock offset among the parameters

// Roll, pitch, yaw of the mount's error (rad), clock offset (s).
using Parameters = Eigen::Vector4d;
// By how much they are changed for the derivative. The clock's spans several poses, whose noise
// would else be that of the derivative.
const Parameters kSteps(1e-5, 1e-5, 1e-5, 0.01);

Eigen::Quaterniond MountError(const Eigen::Vector3d& angles) {
  return Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX());
}

MountAndClock Applied(const MountAndClock& given, const Parameters& parameters) {
  const RigidTransform& mount = given.body_from_camera;
  return {
      {(MountError(parameters.head<kAngles>()) * mount.rotation).normalized(), mount.translation},
      parameters(kClock)};
}

// Sightings, poses and path as a function of the parameters.
class FlightFit {
 public:
  FlightFit(std::vector<TargetSighting> sightings, const PoseHistory* poses,
            const MountAndClock& given, double knot_spacing_s)
      : sightings_(std::move(sightings)),
        poses_(poses),
        given_(given),
        path_(TimesOf(sightings_), WeightsOf(sightings_), knot_spacing_s) {}

  const std::vector<TargetSighting>& sightings() const { return sightings_; }
  Eigen::Index path_size() const { return path_.size(); }

  // Weighted distances of the positions in the world from the path, a row for each sighting.
  Eigen::MatrixX3d Residuals(const Parameters& parameters) const {
    const MountAndClock applied = Applied(given_, parameters);
    const Duration offset = DurationFromSeconds(applied.clock_offset_s);
    Eigen::MatrixX3d positions(sightings_.size(), 3);
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const auto world_from_body = poses_->Lookup(sightings_[i].time + offset);
      positions.row(static_cast<Eigen::Index>(i)) =
          *world_from_body * (applied.body_from_camera * sightings_[i].center_in_camera);
    }
    return path_.Residuals(positions);
  }

  double Cost(const Parameters& parameters) const { return Residuals(parameters).squaredNorm(); }

  // Distances in metres.
  double RootMeanSquare(const Parameters& parameters) const {
    const Eigen::MatrixX3d residuals =
        WeightsOf(sightings_).cwiseInverse().asDiagonal() * Residuals(parameters);
    return std::sqrt(residuals.squaredNorm() / static_cast<double>(residuals.rows()));
  }

 private:
  static std::vector<Time> TimesOf(const std::vector<TargetSighting>& sightings) {
    std::vector<Time> times;
    for (const TargetSighting& sighting : sightings) times.push_back(sighting.time);
    return times;
  }
  static Eigen::VectorXd WeightsOf(const std::vector<TargetSighting>& sightings) {
    Eigen::VectorXd weights(sightings.size());
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      weights(static_cast<Eigen::Index>(i)) = 1 / sightings[i].sigma_m;
    }
    return weights;
  }

  std::vector<TargetSighting> sightings_;
  const PoseHistory* poses_;
  MountAndClock given_;
  TargetPath path_;
};

Eigen::VectorXd Flat(const Eigen::MatrixX3d& residuals) {
  return Eigen::Map<const Eigen::VectorXd>(residuals.data(), residuals.size());
}

Eigen::MatrixXd Jacobian(const FlightFit& fit, const Parameters& parameters) {
  Eigen::MatrixXd jacobian(3 * fit.sightings().size(), parameters.size());
  for (int k = 0; k < parameters.size(); ++k) {
    Parameters step = Parameters::Zero();
    step(k) = kSteps(k);
    jacobian.col(k) =
        Flat(fit.Residuals(parameters + step) - fit.Residuals(parameters - step)) / (2 * kSteps(k));
  }
  return jacobian;
}

// The whole flight as one residual block of Ceres.
class FlightCost : public ceres::CostFunction {
 public:
  explicit FlightCost(const FlightFit* fit) : fit_(fit) {
    set_num_residuals(static_cast<int>(3 * fit->sightings().size()));
    mutable_parameter_block_sizes()->push_back(Parameters::RowsAtCompileTime);
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Parameters> at(parameters[0]);
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = Flat(fit_->Residuals(at));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>>(
          jacobians[0], num_residuals(), 4) = Jacobian(*fit_, at);
    }
    return true;
  }

 private:
  const FlightFit* fit_;
};

std::vector<int> FixedParameters(const FlightCalibrationOptions& options) {
  std::vector<int> fixed;
  if (!options.estimate_mount) fixed = {0, 1, 2};
  if (!options.estimate_clock) fixed.push_back(kClock);
  return fixed;
}

Parameters Refine(const FlightFit& fit, Parameters parameters,
                  const FlightCalibrationOptions& options) {
  ceres::Problem problem;
  problem.AddResidualBlock(new FlightCost(&fit), nullptr, parameters.data());
  const std::vector<int> fixed = FixedParameters(options);
  if (!fixed.empty()) {
    problem.SetManifold(parameters.data(),
                        new ceres::SubsetManifold(Parameters::RowsAtCompileTime, fixed));
  }
  // The offset stays where there are poses.
  problem.SetParameterLowerBound(parameters.data(), kClock,
                                 std::min(options.min_offset_s, parameters(kClock)));
  problem.SetParameterUpperBound(parameters.data(), kClock,
                                 std::max(options.max_offset_s, parameters(kClock)));
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return parameters;
}

// The paper's grid search: offset first, then the angles.
Parameters SearchGrid(const FlightFit& fit, const Parameters& given,
                      const FlightCalibrationOptions& options) {
  Parameters best = given;
  double least = fit.Cost(best);
  const auto offer = [&](const Parameters& candidate) {
    const double cost = fit.Cost(candidate);
    if (cost >= least) return;
    least = cost;
    best = candidate;
  };
  if (options.estimate_clock) {
    Parameters candidate = best;
    for (double offset = options.min_offset_s; offset <= options.max_offset_s + 1e-9;
         offset += options.offset_step_s) {
      candidate(kClock) = offset;
      offer(candidate);
    }
  }
  if (!options.estimate_mount) return best;
  const int reach = static_cast<int>(options.max_angle_deg / options.angle_step_deg);
  Parameters candidate = best;
  for (int roll = -reach; roll <= reach; ++roll) {
    for (int pitch = -reach; pitch <= reach; ++pitch) {
      for (int yaw = -reach; yaw <= reach; ++yaw) {
        candidate.head<kAngles>() =
            options.angle_step_deg * kRadians * Eigen::Vector3d(roll, pitch, yaw);
        offer(candidate);
      }
    }
  }
  return best;
}

// Those sightings whose distance from the path is no more than that of five standard deviations,
// taken from the median.
std::vector<TargetSighting> WithoutOutliers(const FlightFit& fit, const Parameters& parameters) {
  constexpr double kSigmas = 5;
  constexpr double kMedianOfThree = 1.538;  // of a chi variable with 3 degrees of freedom
  const Eigen::VectorXd distances = fit.Residuals(parameters).rowwise().norm();
  std::vector<double> sorted(distances.data(), distances.data() + distances.size());
  std::nth_element(sorted.begin(), sorted.begin() + distances.size() / 2, sorted.end());
  const double limit = kSigmas * sorted[sorted.size() / 2] / kMedianOfThree * std::sqrt(3.0);
  std::vector<TargetSighting> kept;
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (distances(i) <= limit) kept.push_back(fit.sightings()[i]);
  }
  return kept;
}

// Standard deviations of those parameters that were estimated; infinite where nothing is known.
Parameters Sigmas(const FlightFit& fit, const Parameters& parameters,
                  const FlightCalibrationOptions& options) {
  const Eigen::MatrixXd all = Jacobian(fit, parameters);
  const int first = options.estimate_mount ? 0 : kClock;
  const int count = (options.estimate_mount ? kAngles : 0) + (options.estimate_clock ? 1 : 0);
  const Eigen::MatrixXd jacobian = all.middleCols(first, count);
  const double freedom =
      static_cast<double>(jacobian.rows() - 3 * fit.path_size() - jacobian.cols());
  const double variance = fit.Cost(parameters) / std::max(1.0, freedom);
  const Eigen::FullPivLU<Eigen::MatrixXd> information(jacobian.transpose() * jacobian);
  Parameters sigmas = Parameters::Zero();
  sigmas.segment(first, count).setConstant(std::numeric_limits<double>::infinity());
  if (information.isInvertible()) {
    sigmas.segment(first, count) = (variance * information.inverse().diagonal()).cwiseSqrt();
  }
  return sigmas;
}

std::vector<std::string> Warnings(const Parameters& sigmas) {
  constexpr double kMaxAngleSigma = 0.1 * kRadians;
  constexpr double kMaxClockSigma_s = 0.005;
  constexpr std::array<const char*, kAngles> kNames = {"roll", "pitch", "yaw"};
  std::vector<std::string> warnings;
  for (int i = 0; i < kAngles; ++i) {
    if (sigmas(i) <= kMaxAngleSigma) continue;
    warnings.push_back(fmt::format(
        "the flight cannot tell the {} of the mount (standard deviation {:.2g} degrees): fly "
        "slowly around a standing pattern, at several heights and headings",
        kNames[i], sigmas(i) / kRadians));
  }
  if (sigmas(kClock) > kMaxClockSigma_s) {
    warnings.push_back(fmt::format(
        "the flight cannot tell the clock offset (standard deviation {:.2g} s): tilt and turn the "
        "UAV quickly",
        sigmas(kClock)));
  }
  return warnings;
}

// Sightings that have a pose whatever the offset within the bounds.
std::vector<TargetSighting> WithPoses(const std::vector<TargetSighting>& sightings,
                                      const PoseHistory& poses, const MountAndClock& given,
                                      const FlightCalibrationOptions& options) {
  const double step = kSteps(kClock);
  const double low = std::min(options.min_offset_s, given.clock_offset_s) - step;
  const double high = std::max(options.max_offset_s, given.clock_offset_s) + step;
  std::vector<TargetSighting> kept;
  for (const TargetSighting& sighting : sightings) {
    bool has_poses = true;
    for (double offset = low; has_poses && offset <= high + step; offset += step) {
      has_poses = poses.Has(sighting.time + DurationFromSeconds(offset));
    }
    if (has_poses) kept.push_back(sighting);
  }
  return kept;
}

PoseHistory HistoryOf(const std::vector<PoseSample>& samples) {
  PoseHistory history(samples.size(), kMaxGap);
  for (const PoseSample& sample : samples) history.Add(sample);
  return history;
}

}  // namespace

FlightCalibration CalibrateFlight(const std::vector<TargetSighting>& sightings,
                                  const std::vector<PoseSample>& poses, const MountAndClock& given,
                                  const FlightCalibrationOptions& options) {
  const PoseHistory history = HistoryOf(poses);
  const auto usable = WithPoses(sightings, history, given, options);
  if (usable.size() < kMinSightings) {
    throw InputError(fmt::format(
        "the pattern was seen in {} images with poses around them, expected at least {}",
        usable.size(), kMinSightings));
  }
  const Parameters start(0, 0, 0, given.clock_offset_s);
  const FlightFit all(usable, &history, given, options.knot_spacing_s);
  const Parameters coarse = Refine(all, SearchGrid(all, start, options), options);
  const FlightFit fit(WithoutOutliers(all, coarse), &history, given, options.knot_spacing_s);
  const Parameters fine = Refine(fit, coarse, options);
  const Parameters sigmas = Sigmas(fit, fine, options);

  FlightCalibration calibration;
  calibration.estimate = Applied(given, fine);
  calibration.angles = fine.head<kAngles>();
  calibration.angle_sigmas = sigmas.head<kAngles>();
  calibration.clock_sigma_s = sigmas(kClock);
  calibration.rms_before_m = fit.RootMeanSquare(start);
  calibration.rms_after_m = fit.RootMeanSquare(fine);
  calibration.sightings = static_cast<int>(fit.sightings().size());
  calibration.outliers = static_cast<int>(usable.size() - fit.sightings().size());
  calibration.warnings = Warnings(sigmas);
  return calibration;
}

}  // namespace kestrel
