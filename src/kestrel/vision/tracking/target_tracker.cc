// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tracking/target_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// Sway of the board on the vehicle's springs, see SwayMotion: a body rolls and pitches at 1 to 2
// Hz.
constexpr double kSwayFrequency_hz = 1.4;
constexpr double kSwayDamping = 0.3;
// Standard deviation of the speed of a new track.
constexpr double kStartSpeedSigma_mps = 6;
// Squared Mahalanobis distance beyond which a measurement is not of the target. One true
// measurement in a thousand exceeds it.
constexpr double kGate = 16.3;
// Number of measurements in a row outside of the gate, each within reach of the one before at
// max_speed_mps, after which the track is considered wrong and a new one begins.
constexpr std::size_t kRestartCount = 5;
constexpr int kConfirmCount = 5;  // measurements that confirm a track
// Time without a measurement after which a track is predicted, and standard deviation of the
// position at which it is lost.
constexpr double kPredictAfter_s = 0.15;
constexpr double kLostSigma_m = 3;

constexpr double kMaxCoordinate_m = 1e7;
constexpr double kMaxVariance_m2 = 1e6;

bool IsValid(const TargetMeasurement& measurement) {
  const Eigen::Matrix3d& covariance = measurement.covariance;
  if (!measurement.position_in_world.allFinite() || !covariance.allFinite()) return false;
  if (measurement.position_in_world.cwiseAbs().maxCoeff() > kMaxCoordinate_m) return false;
  if (covariance.cwiseAbs().maxCoeff() > kMaxVariance_m2) return false;
  if (!covariance.isApprox(covariance.transpose(), 1e-6)) return false;
  if (covariance.llt().info() != Eigen::Success) return false;
  if (!(measurement.shared_covariance.cwiseAbs().array() <= kMaxVariance_m2).all()) return false;
  constexpr double kMaxYawVariance = 1e3;
  return !measurement.yaw || (std::isfinite(*measurement.yaw) && measurement.yaw_variance > 0 &&
                              measurement.yaw_variance < kMaxYawVariance &&
                              measurement.yaw_period > 0 && measurement.yaw_period <= kFullTurn);
}

double RootMeanVariance(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, covariance.trace() / 3));
}

}  // namespace

const char* ToString(MeasurementFate fate) {
  switch (fate) {
    case MeasurementFate::kStarted:
      return "started";
    case MeasurementFate::kAccepted:
      return "accepted";
    case MeasurementFate::kInvalid:
      return "invalid";
    case MeasurementFate::kTooOld:
      return "too old";
    case MeasurementFate::kFarFromTrack:
      return "far from the track";
  }
  return "";
}

const char* ToString(TrackState state) {
  switch (state) {
    case TrackState::kSearching:
      return "searching";
    case TrackState::kTracking:
      return "tracking";
    case TrackState::kPredicting:
      return "predicting";
    case TrackState::kLost:
      return "lost";
  }
  return "";
}

double TargetEstimate::heading() const {
  return std::atan2(motion.velocity().y(), motion.velocity().x());
}

double TargetEstimate::speed() const { return motion.velocity().head<2>().norm(); }

double TargetEstimate::position_sigma_m() const {
  return RootMeanVariance(motion.covariance.topLeftCorner<3, 3>());
}

double TargetEstimate::velocity_sigma_mps() const {
  return RootMeanVariance(
      motion.covariance.block<3, 3>(TurnState::kVelocity, TurnState::kVelocity));
}

TurnNoise TargetTrackerOptions::Noise() const {
  return {acceleration_noise,
          climb_noise,
          turn_noise,
          turn_time_s,
          {sway_sigma_m, kSwayFrequency_hz, kSwayDamping}};
}

TargetTracker::TargetTracker(const TargetTrackerOptions& options)
    : options_(Checked(options)), noise_(options.Noise()) {
  entries_.reserve(options_.history + 1);
  outliers_.reserve(kRestartCount);
}

MeasurementFate TargetTracker::Add(const TargetMeasurement& measurement) {
  if (!IsValid(measurement)) return MeasurementFate::kInvalid;
  if (entries_.empty() ||
      ToSeconds(measurement.time - entries_.back().measurement.time) > options_.lost_after_s) {
    outliers_.clear();
    return Start(measurement);
  }
  const std::size_t index = CountUntil(measurement.time);
  if (index == 0) return Reject(measurement, MeasurementFate::kTooOld);
  const TurnState predicted = PredictFrom(entries_[index - 1], measurement.time);
  const double distance =
      SquaredDistance(predicted, measurement.position_in_world, measurement.covariance);
  if (!(distance <= kGate)) return Reject(measurement, MeasurementFate::kFarFromTrack);
  outliers_.clear();
  Insert(index, measurement);
  accepted_ = std::min(accepted_ + 1, kConfirmCount);
  return FilterFrom(index) ? MeasurementFate::kAccepted : Start(measurement);
}

MeasurementFate TargetTracker::Start(const TargetMeasurement& measurement) {
  constexpr double kSteepest = 0.1;  // slope of roads
  const double speed = kStartSpeedSigma_mps;
  const TurnState state =
      StartState(measurement.position_in_world, measurement.covariance,
                 {speed, speed, kSteepest * speed}, options_.start_turn_sigma_radps, noise_);
  entries_.clear();
  entries_.push_back({measurement, state});
  UpdateYaw(&entries_.back());
  accepted_ = 1;
  return MeasurementFate::kStarted;
}

// The new track has the velocity of all outliers. From the newest one alone that would be any, and
// a next place that is only a little off would throw the track far ahead.
MeasurementFate TargetTracker::Restart() {
  Start(outliers_.front());
  for (const TargetMeasurement& outlier : std::span(outliers_).subspan(1)) {
    if (const std::size_t index = CountUntil(outlier.time); index > 0) Insert(index, outlier);
  }
  if (!FilterFrom(1)) Start(outliers_.back());
  outliers_.clear();
  return MeasurementFate::kStarted;
}

MeasurementFate TargetTracker::Reject(const TargetMeasurement& measurement, MeasurementFate fate) {
  constexpr double kSigmas = 3;
  const auto agree = [&](const TargetMeasurement& a, const TargetMeasurement& b) {
    const double seconds = std::abs(ToSeconds(b.time - a.time));
    if (seconds > options_.lost_after_s) return false;
    const double noise_m = RootMeanVariance(a.covariance) + RootMeanVariance(b.covariance);
    return (b.position_in_world - a.position_in_world).norm() <=
           options_.max_speed_mps * seconds + kSigmas * noise_m;
  };
  if (!outliers_.empty() && !agree(outliers_.back(), measurement)) outliers_.clear();
  outliers_.push_back(measurement);
  return outliers_.size() >= kRestartCount ? Restart() : fate;
}

void TargetTracker::Insert(std::size_t index, const TargetMeasurement& measurement) {
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(index), {measurement, {}, 0});
}

// Filters the entries from 'index' on, each from the one before. False when a result is not finite.
bool TargetTracker::FilterFrom(std::size_t index) {
  for (std::size_t i = index; i < entries_.size(); ++i) {
    const TargetMeasurement& measurement = entries_[i].measurement;
    const TurnState predicted = PredictFrom(entries_[i - 1], measurement.time);
    entries_[i].filtered =
        UpdateByPosition(predicted, measurement.position_in_world, measurement.covariance);
    entries_[i].yaw_period = entries_[i - 1].yaw_period;
    UpdateYaw(&entries_[i]);
    if (!entries_[i].filtered.mean.allFinite() || !entries_[i].filtered.covariance.allFinite()) {
      return false;
    }
  }
  if (entries_.size() > static_cast<std::size_t>(options_.history)) {
    entries_.erase(entries_.begin());
  }
  return true;
}

void TargetTracker::UpdateYaw(Entry* entry) {
  constexpr double kYawGate = 16;  // four standard deviations; beyond, the yaw was mistaken
  const TargetMeasurement& measurement = entry->measurement;
  if (!measurement.yaw) return;
  // A pad with less symmetry determines which of the turns so far was the right one.
  if (entry->yaw_period > 0 && measurement.yaw_period > entry->yaw_period) {
    double& yaw = entry->filtered.mean(TurnState::kYaw);
    yaw = *measurement.yaw - std::remainder(*measurement.yaw - yaw, entry->yaw_period);
  }
  entry->yaw_period = std::max(entry->yaw_period, measurement.yaw_period);
  entry->filtered = UpdateByYaw(entry->filtered, *measurement.yaw, measurement.yaw_variance,
                                measurement.yaw_period, kYawGate);
}

std::size_t TargetTracker::CountUntil(Time time) const {
  const auto after =
      std::upper_bound(entries_.begin(), entries_.end(), time,
                       [](Time t, const Entry& entry) { return t < entry.measurement.time; });
  return static_cast<std::size_t>(after - entries_.begin());
}

TurnState TargetTracker::PredictFrom(const Entry& entry, Time time) const {
  return Propagate(entry.filtered, ToSeconds(time - entry.measurement.time), noise_);
}

TrackState TargetTracker::StateAt(Time time) const {
  const std::size_t count = CountUntil(time);
  if (count == 0) return TrackState::kSearching;
  if (!Predict(time)) return TrackState::kLost;
  if (accepted_ < kConfirmCount) return TrackState::kSearching;
  const double age_s = ToSeconds(time - entries_[count - 1].measurement.time);
  return age_s <= kPredictAfter_s ? TrackState::kTracking : TrackState::kPredicting;
}

std::optional<TargetEstimate> TargetTracker::Predict(Time time) const {
  const std::size_t count = CountUntil(time);
  if (count == 0) return std::nullopt;
  const Entry& entry = entries_[count - 1];
  if (ToSeconds(time - entry.measurement.time) > options_.lost_after_s) return std::nullopt;
  TargetEstimate estimate{time, PredictFrom(entry, time), entry.yaw_period};
  estimate.motion.covariance.topLeftCorner<3, 3>() += entry.measurement.shared_covariance;
  const bool is_known =
      estimate.motion.mean.allFinite() && estimate.position_sigma_m() <= kLostSigma_m;
  return is_known ? std::optional(estimate) : std::nullopt;
}

}  // namespace kestrel
