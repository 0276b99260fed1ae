// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/video_delay.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>

#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace kestrel {
namespace {

constexpr Duration kGrid = std::chrono::milliseconds(10);
constexpr std::size_t kGridSize = 2400;  // the window, and the range of the offset around it
constexpr std::size_t kPoses = 2048;
constexpr Duration kPoseGap = std::chrono::milliseconds(300);
constexpr std::size_t kFewestTurns = 40;
constexpr double kOffsetStep_s = 0.01;  // of the search
constexpr double kOtherPeak_s = 0.1;  // from the best offset, beyond which another one is no slope
constexpr double kSurer = 8;          // by which the best one's log likelihood must exceed others
constexpr double kFloor_s = 0.004;    // of the error: motion past a near scene explains some of it
constexpr double kLargest_s = 0.02;   // error of an offset that is given out
constexpr double kUnknownSpread_s = 0.01;  // of halves that do not show the offset by themselves
constexpr double kTiny = 1e-12;            // a sum of squares that is 0
constexpr int kAxes = 3;
constexpr int kOffsets = 110;

double OffsetOf(double step) { return -VideoDelay::kLatest_s + step * kOffsetStep_s; }

CameraCalibration WithoutOffset(CameraCalibration calibration) {
  calibration.clock_offset.reset();
  return calibration;
}

using Regressors = Eigen::Matrix<double, Eigen::Dynamic, 5>;

// Residuals of the first columns' best combination.
Eigen::VectorXd ResidualsOf(const Eigen::VectorXd& seen, const Regressors& regressors,
                            int columns) {
  const auto basis = regressors.leftCols(columns);
  const Eigen::MatrixXd gram = basis.transpose() * basis;
  return seen - basis * gram.ldlt().solve(basis.transpose() * seen);
}

// Number of independent ones among residuals that follow each other.
double Independent(const Eigen::VectorXd& residuals) {
  const Eigen::Index n = residuals.size();
  const double own = residuals.squaredNorm();
  if (!(own > 0)) return static_cast<double>(n);
  const double r = std::clamp(residuals.head(n - 1).dot(residuals.tail(n - 1)) / own, 0.0, 0.95);
  return static_cast<double>(n) * (1 - r) / (1 + r);
}

}  // namespace

VideoDelay::VideoDelay(const CameraCalibration& calibration)
    : poses_(WithoutOffset(calibration), kPoses, kPoseGap, Duration::zero(), Duration::zero()),
      has_gimbal_(calibration.gimbal.has_value()) {}

void VideoDelay::Add(const PoseSample& pose) {
  if (poses_.Add(pose) != PoseStatus::kOk) return;
  newest_pose_ = pose.time;
  Sample();
}

void VideoDelay::Add(const GimbalSample& report) {
  if (poses_.Add(report) != PoseStatus::kOk) return;
  newest_report_ = report.time;
  Sample();
}

// The gimbal's reports come later than the poses, and its clock is part of the calibration: the
// grid is behind by as much as that may be.
void VideoDelay::Sample() {
  constexpr Duration kGimbalDelay = std::chrono::milliseconds(300);
  if (!newest_pose_ || (has_gimbal_ && !newest_report_)) return;
  const Time newest =
      has_gimbal_ ? std::min(*newest_pose_, *newest_report_) - kGimbalDelay : *newest_pose_;
  Time next = grid_.empty() ? newest : grid_begin_ + kGrid * static_cast<int>(grid_.size());
  if (newest - next > std::chrono::seconds(1)) {
    grid_.clear();
    next = newest;
  }
  for (; next <= newest; next += kGrid) {
    const auto pose = poses_.At(next);
    if (!pose) {
      grid_.clear();
      continue;
    }
    if (grid_.empty()) {
      grid_begin_ = next;
      grid_.push_back(Path::Zero());
    } else {
      const RigidTransform& before = last_->world_from_camera;
      const Eigen::Quaterniond to_camera = before.rotation.conjugate();
      const Eigen::AngleAxisd turned(to_camera * pose->world_from_camera.rotation);
      Path path = grid_.back();
      path.head<kAxes>() += turned.angle() * turned.axis();
      path.tail<kAxes>() += to_camera * (pose->world_from_camera.translation - before.translation);
      grid_.push_back(path);
    }
    last_ = pose;
    if (grid_.size() > kGridSize) {
      grid_.pop_front();
      grid_begin_ += kGrid;
    }
  }
}

void VideoDelay::Add(Time from, Time to, const Eigen::Vector3d& turn) {
  turns_.push_back({from, to, turn});
  while (to - turns_.front().from > DurationFromSeconds(kWindow_s)) turns_.pop_front();
}

void VideoDelay::ForgetBefore(Time begin) {
  while (!turns_.empty() && turns_.front().from < begin) turns_.pop_front();
}

// For all offsets: the number of images must not depend on the offset.
bool VideoDelay::IsCovered(const Turn& turn) const {
  if (grid_.size() < 2) return false;
  const Time end = grid_begin_ + kGrid * static_cast<int>(grid_.size() - 1);
  return turn.from - DurationFromSeconds(kLatest_s) >= grid_begin_ &&
         turn.to + DurationFromSeconds(kEarliest_s) < end;
}

VideoDelay::Path VideoDelay::PathAt(Time time) const {
  const Duration since = time - grid_begin_;
  const auto i = static_cast<std::size_t>(since / kGrid);
  const double share = static_cast<double>((since % kGrid).count()) / kGrid.count();
  return grid_[i] + share * (grid_[i + 1] - grid_[i]);
}

// Log likelihood of each offset of the search, by the rotation alone: reported positions may be
// late by themselves. The noise of each axis is unknown, and independent between the axes.
std::vector<double> VideoDelay::Likelihoods(const std::vector<Turn>& turns) const {
  const auto count = static_cast<Eigen::Index>(turns.size());
  Eigen::MatrixXd seen(count, kAxes);
  for (Eigen::Index i = 0; i < count; ++i) seen.row(i) = turns[i].rotation;
  Eigen::MatrixXd reported(count, 2 * kAxes);
  Regressors regressors(count, 5);  // a constant, the motion, and the rotation of an axis
  regressors.col(0).setOnes();
  // Share of the images' rotation that that of the poses does not explain, a logarithm.
  std::array<std::array<double, kOffsets>, kAxes> logs;
  std::array<double, kAxes> least{};
  std::array<double, kAxes> independent{};
  for (int k = 0; k < kOffsets; ++k) {
    const Duration offset = DurationFromSeconds(OffsetOf(k));
    for (Eigen::Index i = 0; i < count; ++i) {
      reported.row(i) = PathAt(turns[i].to + offset) - PathAt(turns[i].from + offset);
    }
    regressors.middleCols<kAxes>(1) = reported.rightCols<kAxes>();
    for (int axis = 0; axis < kAxes; ++axis) {
      regressors.col(4) = reported.col(axis);
      const Eigen::VectorXd residuals = ResidualsOf(seen.col(axis), regressors, 5);
      const double by_motion = ResidualsOf(seen.col(axis), regressors, 4).squaredNorm();
      logs[axis][k] = std::log((residuals.squaredNorm() + kTiny) / (by_motion + kTiny));
      if (k > 0 && logs[axis][k] >= least[axis]) continue;
      least[axis] = logs[axis][k];
      independent[axis] = Independent(residuals);
    }
  }
  std::vector<double> likelihoods(kOffsets, 0.0);
  for (int k = 0; k < kOffsets; ++k) {
    for (int axis = 0; axis < kAxes; ++axis) {
      likelihoods[k] -= 0.5 * independent[axis] * logs[axis][k];
    }
  }
  return likelihoods;
}

std::optional<ClockEstimate> VideoDelay::Fit(const std::vector<Turn>& turns) const {
  if (turns.size() < kFewestTurns) return std::nullopt;
  const std::vector<double> likelihoods = Likelihoods(turns);
  const auto best = static_cast<int>(std::ranges::max_element(likelihoods) - likelihoods.begin());
  if (best == 0 || best == kOffsets - 1) return std::nullopt;
  for (int k = 0; k < kOffsets; ++k) {
    const bool is_other = std::abs(k - best) * kOffsetStep_s > kOtherPeak_s;
    if (is_other && likelihoods[k] > likelihoods[best] - kSurer) return std::nullopt;
  }
  const double before = likelihoods[best - 1];
  const double after = likelihoods[best + 1];
  const double curvature = 2 * likelihoods[best] - before - after;  // not negative at a maximum
  if (!(curvature > 0)) return std::nullopt;
  return ClockEstimate{OffsetOf(best + 0.5 * (after - before) / curvature),
                       std::hypot(kFloor_s, kOffsetStep_s / std::sqrt(curvature))};
}

std::optional<ClockEstimate> VideoDelay::Estimate(Time begin) const {
  std::vector<Turn> used;
  for (const Turn& turn : turns_) {
    if (turn.from >= begin && IsCovered(turn)) used.push_back(turn);
  }
  auto estimate = Fit(used);
  if (!estimate) return std::nullopt;
  // The two halves differ by errors that the residuals do not show, as of the motion past a near
  // scene.
  const auto middle = used.begin() + static_cast<std::ptrdiff_t>(used.size() / 2);
  const auto first = Fit({used.begin(), middle});
  const auto second = Fit({middle, used.end()});
  const double spread_s =
      first && second ? 0.5 * std::abs(first->offset_s - second->offset_s) : kUnknownSpread_s;
  estimate->sigma_s = std::hypot(estimate->sigma_s, spread_s);
  return estimate->sigma_s > kLargest_s ? std::nullopt : estimate;
}

}  // namespace kestrel
