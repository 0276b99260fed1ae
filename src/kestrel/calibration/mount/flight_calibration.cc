// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/flight_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/LU>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/calibration/mount/pose_smoothing.h"
#include "kestrel/calibration/mount/target_path.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/held_parameters.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr std::size_t kMinSightings = 20;
constexpr int kRounds = 3;  // in which outliers are left out
constexpr Duration kMaxGap = std::chrono::milliseconds(200);
constexpr Duration kSmoothing = std::chrono::milliseconds(100);  // to either side
constexpr int kAngles = 3;
// Indices of the clock offset and the scale among the parameters.
constexpr int kClock = 3;
constexpr int kScale = 4;
constexpr int kParameters = 5;
constexpr double kScaleSigma = 0.005;
// A mount is known better from how it is screwed on, a clock from when its images arrive.
constexpr double kUselessAngleSigma = Radians(3.0);
constexpr double kUselessClockSigma_s = 0.1;
constexpr const char* kMountAdvice =
    "fly slowly around a standing pattern, at several heights and headings";
constexpr const char* kClockAdvice =
    "tilt and turn the UAV quickly, and say so when the pattern moves (--moving)";

// Roll, pitch, yaw of the mount's error (rad), clock offset (s), and the relative amount by which
// all distances are too short: an error of the pattern's size with the standard deviation
// kScaleSigma. Without it a descent would turn such an error into an error of the clock.
using Parameters = Eigen::Vector<double, kParameters>;
// Steps of the parameters for the derivative. The clock's step spans several poses, otherwise their
// noise would be noise of the derivative.
const Parameters kSteps(1e-5, 1e-5, 1e-5, 0.01, 1e-5);

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

// The carrier of the camera over a flight: the body, or a gimbal's platform.
class FlightPoses {
 public:
  FlightPoses(PoseHistory body, const std::optional<FlownGimbal>& gimbal)
      : body_(std::move(body)), reports_(gimbal ? gimbal->reports.size() : 0) {
    if (!gimbal) return;
    pivot_ = gimbal->body_from_pivot;
    image_offset_ = DurationFromSeconds(gimbal->image_clock_offset_s);
    for (const GimbalSample& report : gimbal->reports) reports_.Add(report);
  }

  // Returns its pose in the world at an image's time; 'offset' leads to the clock of the navigation
  // or of the gimbal.
  std::optional<RigidTransform> At(Time image_time, Duration offset) const {
    if (!pivot_) return body_.Lookup(image_time + offset);
    const auto world_from_body = body_.Lookup(image_time + image_offset_);
    const auto attitude = reports_.At(image_time + offset, Duration::zero());
    if (!world_from_body || !attitude) return std::nullopt;
    return WorldFromPlatform(*world_from_body, *pivot_, *attitude);
  }

 private:
  PoseHistory body_;
  GimbalHistory reports_;
  std::optional<RigidTransform> pivot_;  // body from pivot; nothing: no gimbal
  Duration image_offset_{};
};

// The residuals of sightings, poses and path as a function of the parameters.
class FlightFit {
 public:
  FlightFit(std::vector<TargetSighting> sightings, const FlightPoses* poses,
            const MountAndClock& given, double knot_spacing_s)
      : sightings_(std::move(sightings)),
        poses_(poses),
        given_(given),
        path_(TimesOf(sightings_), WeightsOf(sightings_), knot_spacing_s) {}

  const std::vector<TargetSighting>& sightings() const { return sightings_; }
  Eigen::Index path_size() const { return path_.size(); }

  // Weighted vectors from the path to the positions in the world, one row per sighting.
  Eigen::MatrixX3d Residuals(const Parameters& parameters) const {
    const MountAndClock applied = Applied(given_, parameters);
    const Duration offset = DurationFromSeconds(applied.clock_offset_s);
    Eigen::MatrixX3d positions(sightings_.size(), 3);
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const auto world_from_body = poses_->At(sightings_[i].time, offset);
      positions.row(static_cast<Eigen::Index>(i)) =
          *world_from_body * (applied.body_from_camera *
                              ((1 + parameters(kScale)) * sightings_[i].center_in_camera).eval());
    }
    return path_.Residuals(positions);
  }

  // All residuals in one column; last the scale divided by its standard deviation.
  Eigen::VectorXd Errors(const Parameters& parameters) const {
    const Eigen::MatrixX3d residuals = Residuals(parameters);
    Eigen::VectorXd errors(residuals.size() + 1);
    errors << residuals.reshaped(), parameters(kScale) / kScaleSigma;
    return errors;
  }

  // Distance of each sighting from the path, m.
  Eigen::VectorXd Distances(const Parameters& parameters) const {
    return (WeightsOf(sightings_).cwiseInverse().asDiagonal() * Residuals(parameters))
        .rowwise()
        .norm();
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
  const FlightPoses* poses_;
  MountAndClock given_;
  TargetPath path_;
};

Eigen::MatrixXd Jacobian(const FlightFit& fit, const Parameters& parameters) {
  Eigen::MatrixXd jacobian(3 * fit.sightings().size() + 1, kParameters);
  for (int k = 0; k < kParameters; ++k) {
    Parameters step = Parameters::Zero();
    step(k) = kSteps(k);
    jacobian.col(k) =
        (fit.Errors(parameters + step) - fit.Errors(parameters - step)) / (2 * kSteps(k));
  }
  return jacobian;
}

// The whole flight as one residual block for Ceres.
class FlightCost : public ceres::CostFunction {
 public:
  explicit FlightCost(const FlightFit* fit) : fit_(fit) {
    set_num_residuals(static_cast<int>(3 * fit->sightings().size() + 1));
    mutable_parameter_block_sizes()->push_back(kParameters);
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Parameters> at(parameters[0]);
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = fit_->Errors(at);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kParameters, Eigen::RowMajor>>(
          jacobians[0], num_residuals(), kParameters) = Jacobian(*fit_, at);
    }
    return true;
  }

 private:
  const FlightFit* fit_;
};

bool IsFixed(int parameter, const FlightCalibrationOptions& options) {
  if (parameter < kAngles) return !options.estimate_mount;
  return parameter == kClock && !options.estimate_clock;
}

Parameters Refine(const FlightFit& fit, Parameters parameters,
                  const FlightCalibrationOptions& options) {
  ceres::Problem problem;
  problem.AddResidualBlock(new FlightCost(&fit), nullptr, parameters.data());
  std::vector<int> fixed;
  for (int k = 0; k < kParameters; ++k) {
    if (IsFixed(k, options)) fixed.push_back(k);
  }
  if (!fixed.empty()) HoldParameters(&problem, parameters.data(), kParameters, fixed);
  // Limits the offset to the times that have poses.
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

// The paper's grid search: first the offset, then the angles.
Parameters SearchGrid(const FlightFit& fit, const Parameters& given,
                      const FlightCalibrationOptions& options) {
  Parameters best = given;
  double least = fit.Errors(best).squaredNorm();
  const auto offer = [&](const Parameters& candidate) {
    const double cost = fit.Errors(candidate).squaredNorm();
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
            Radians(options.angle_step_deg) * Eigen::Vector3d(roll, pitch, yaw);
        offer(candidate);
      }
    }
  }
  return best;
}

// Returns the sightings whose distance from the path is at most four standard deviations per axis,
// which are estimated from the median.
std::vector<TargetSighting> WithoutOutliers(const FlightFit& fit, const Parameters& parameters) {
  constexpr double kSigmas = 4;
  constexpr double kMedianOfThree = 1.538;  // median of a chi variable with 3 degrees of freedom
  const Eigen::VectorXd distances = fit.Residuals(parameters).rowwise().norm();
  const double median =
      MedianInPlace(std::vector<double>(distances.data(), distances.data() + distances.size()));
  const double limit = kSigmas * median / kMedianOfThree;
  std::vector<TargetSighting> kept;
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (distances(i) <= limit) kept.push_back(fit.sightings()[i]);
  }
  return kept;
}

// Factor by which the variance of a mean is larger than for independent values, given the
// correlation r of these residuals with their neighbours in time: (1 + r) / (1 - r), as for a
// first-order autoregressive process.
double VarianceInflation(const Eigen::MatrixX3d& residuals) {
  const Eigen::Index pairs = residuals.rows() - 1;
  const double products = residuals.topRows(pairs).cwiseProduct(residuals.bottomRows(pairs)).sum();
  const double correlation = std::clamp(products / residuals.squaredNorm(), 0.0, 0.95);
  return (1 + correlation) / (1 - correlation);
}

// Standard deviations of the estimated parameters; infinite where nothing is known.
Parameters Sigmas(const FlightFit& fit, const Parameters& parameters,
                  const FlightCalibrationOptions& options) {
  const Eigen::MatrixXd jacobian = Jacobian(fit, parameters);
  const Eigen::MatrixX3d residuals = fit.Residuals(parameters);
  const double freedom = static_cast<double>(residuals.size() - 3 * fit.path_size() - kParameters);
  const double variance =
      VarianceInflation(residuals) * residuals.squaredNorm() / std::max(1.0, freedom);
  Eigen::Matrix<double, kParameters, kParameters> information = jacobian.transpose() * jacobian;
  for (int k = 0; k < kParameters; ++k) {
    if (!IsFixed(k, options)) continue;
    information.row(k).setZero();
    information.col(k).setZero();
    information(k, k) = 1;
  }
  Parameters sigmas = Parameters::Constant(std::numeric_limits<double>::infinity());
  const Eigen::FullPivLU<decltype(information)> decomposition(information);
  if (decomposition.isInvertible()) {
    sigmas = (variance * decomposition.inverse().diagonal()).cwiseSqrt();
  }
  for (int k = 0; k < kParameters; ++k) {
    if (IsFixed(k, options)) sigmas(k) = 0;
  }
  return sigmas;
}

constexpr std::array<const char*, kAngles> kAngleNames = {"roll", "pitch", "yaw"};

std::vector<std::string> Warnings(const Parameters& sigmas) {
  constexpr double kMaxAngleSigma = Radians(0.1);
  constexpr double kMaxClockSigma_s = 0.005;
  std::vector<std::string> warnings;
  for (int i = 0; i < kAngles; ++i) {
    if (sigmas(i) <= kMaxAngleSigma || sigmas(i) > kUselessAngleSigma) continue;
    warnings.push_back(fmt::format(
        "the flight hardly determines the {} of the mount (standard deviation {:.2g} degrees): {}",
        kAngleNames[i], Degrees(sigmas(i)), kMountAdvice));
  }
  if (sigmas(kClock) > kMaxClockSigma_s && sigmas(kClock) <= kUselessClockSigma_s) {
    warnings.push_back(fmt::format(
        "the flight hardly determines the clock offset (standard deviation {:.2g} s): {}",
        sigmas(kClock), kClockAdvice));
  }
  return warnings;
}

// Returns how the UAV moved from sighting to sighting.
FlightMotion MotionOver(const std::vector<TargetSighting>& sightings, const FlightPoses& poses,
                        double clock_offset_s) {
  FlightMotion motion;
  std::optional<RigidTransform> first;
  double least_turn = 0, most_turn = 0;
  double lowest_m = 0, highest_m = 0;
  for (const TargetSighting& sighting : sightings) {
    const auto pose = poses.At(sighting.time, DurationFromSeconds(clock_offset_s));
    if (!first) first = *pose;
    const double turn =
        std::remainder(HeadingOf(pose->rotation) - HeadingOf(first->rotation), 2 * kPi);
    const double height_m = pose->translation.z() - first->translation.z();
    least_turn = std::min(least_turn, turn);
    most_turn = std::max(most_turn, turn);
    lowest_m = std::min(lowest_m, height_m);
    highest_m = std::max(highest_m, height_m);
    const Eigen::Vector3d up = pose->rotation * Eigen::Vector3d::UnitZ();
    motion.tilt = std::max(motion.tilt, std::acos(std::clamp(up.z(), -1.0, 1.0)));
  }
  motion.turn = std::min(most_turn - least_turn, kPi);
  motion.height_span_m = highest_m - lowest_m;
  return motion;
}

double RootMeanSquare(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// Returns the sightings that have a pose for each offset within the bounds.
std::vector<TargetSighting> WithPoses(const std::vector<TargetSighting>& sightings,
                                      const FlightPoses& poses, const MountAndClock& given,
                                      const FlightCalibrationOptions& options) {
  const double step = kSteps(kClock);
  const double low = std::min(options.min_offset_s, given.clock_offset_s) - step;
  const double high = std::max(options.max_offset_s, given.clock_offset_s) + step;
  std::vector<TargetSighting> kept;
  for (const TargetSighting& sighting : sightings) {
    bool has_poses = true;
    for (double offset = low; has_poses && offset <= high + step; offset += step) {
      has_poses = poses.At(sighting.time, DurationFromSeconds(offset)).has_value();
    }
    if (has_poses) kept.push_back(sighting);
  }
  return kept;
}

// The poses that a history accepts, smoothed: a UAV moves more evenly than its navigation reports.
PoseHistory HistoryOf(const std::vector<PoseSample>& samples) {
  PoseHistory history(samples.size(), kMaxGap);
  std::vector<PoseSample> valid;
  for (const PoseSample& sample : samples) {
    if (history.Add(sample) == PoseStatus::kOk) valid.push_back(sample);
  }
  PoseHistory smooth(samples.size(), kMaxGap);
  for (const PoseSample& sample : SmoothPoses(valid, kSmoothing)) smooth.Add(sample);
  return smooth;
}

}  // namespace

FlightCalibration CalibrateFlight(const std::vector<TargetSighting>& sightings,
                                  const std::vector<PoseSample>& poses, const MountAndClock& given,
                                  const FlightCalibrationOptions& options,
                                  const std::optional<FlownGimbal>& gimbal) {
  const FlightPoses history(HistoryOf(poses), gimbal);
  const auto usable = WithPoses(sightings, history, given, options);
  if (usable.size() < kMinSightings) {
    throw InputError(fmt::format(
        "the pattern was seen in {} images with poses around them, expected at least {}",
        usable.size(), kMinSightings));
  }
  Parameters start = Parameters::Zero();
  start(kClock) = given.clock_offset_s;
  const FlightFit all(usable, &history, given, options.knot_spacing_s);
  Parameters fine = Refine(all, SearchGrid(all, start, options), options);
  FlightFit fit = all;
  for (int i = 0; i < kRounds; ++i) {
    fit = FlightFit(WithoutOutliers(all, fine), &history, given, options.knot_spacing_s);
    fine = Refine(fit, fine, options);
  }
  const Parameters sigmas = Sigmas(fit, fine, options);

  FlightCalibration calibration;
  calibration.estimate = Applied(given, fine);
  calibration.angles = fine.head<kAngles>();
  calibration.angle_sigmas = sigmas.head<kAngles>();
  calibration.clock_sigma_s = sigmas(kClock);
  const Eigen::VectorXd before = fit.Distances(start), after = fit.Distances(fine);
  for (Eigen::Index i = 0; i < before.size(); ++i) {
    calibration.residuals.push_back({fit.sightings()[i].time, before(i), after(i)});
  }
  calibration.rms_before_m = RootMeanSquare(before);
  calibration.rms_after_m = RootMeanSquare(after);
  calibration.sightings = static_cast<int>(fit.sightings().size());
  calibration.outliers = static_cast<int>(usable.size() - fit.sightings().size());
  calibration.motion = MotionOver(fit.sightings(), history, calibration.estimate.clock_offset_s);
  calibration.warnings = Warnings(sigmas);
  return calibration;
}

std::string WhyOfNoUse(const FlightCalibration& result) {
  std::vector<std::string> angles;
  for (int i = 0; i < kAngles; ++i) {
    if (result.angle_sigmas(i) <= kUselessAngleSigma) continue;
    angles.push_back(fmt::format("{} (+- {:.1f} degrees)", kAngleNames[i],
                                 std::min(Degrees(result.angle_sigmas(i)), 180.0)));
  }
  const FlightMotion& motion = result.motion;
  std::vector<std::string> reasons;
  if (!angles.empty()) {
    reasons.push_back(fmt::format(
        "the flight does not determine the mount's {}: over the pattern the UAV turned by {:.0f} "
        "degrees and changed its height by {:.1f} m; {}",
        fmt::join(angles, ", "), Degrees(motion.turn), motion.height_span_m, kMountAdvice));
  }
  if (result.clock_sigma_s > kUselessClockSigma_s) {
    reasons.push_back(fmt::format(
        "the flight does not determine the clock offset (+- {:.2g} s): over the pattern the UAV "
        "tilted by {:.0f} degrees at most and turned by {:.0f}; {}",
        result.clock_sigma_s, Degrees(motion.tilt), Degrees(motion.turn), kClockAdvice));
  }
  if (reasons.empty() && result.rms_after_m > 1.01 * result.rms_before_m) {
    reasons.emplace_back("the positions agree less than before");
  }
  return fmt::format("{}", fmt::join(reasons, "; "));
}

}  // namespace kestrel
