// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/ardupilot_target.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Duration kTargetTimeout = std::chrono::seconds(2);
constexpr Duration kSightTimeout = std::chrono::seconds(1);
constexpr Duration kStartPeriod = std::chrono::seconds(2);
constexpr Duration kStartGap = std::chrono::milliseconds(500);
constexpr double kAccelerationNoise = 2.5;  // PLND_ACC_P_NSE, m/s^2
constexpr double kMaxInnovationRatio = 3;
constexpr int kMaxOutliers = 3;

// Rotation from forward-right-down of a level body with that heading to the world. Upstream rotates
// with the wrong sign (AP #31651), and so does this.
Eigen::Quaterniond WrongLocalFrame(const Eigen::Quaterniond& world_from_body) {
  const Vector3d forward = world_from_body * Vector3d::UnitX();
  const double north_from_heading = std::atan2(forward.x(), forward.y());
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi + north_from_heading, Vector3d::UnitZ()));
}

}  // namespace

ArduPilotTarget::ArduPilotTarget(const AutopilotParameters& parameters, Announce announce)
    : parameters_(parameters), announce_(std::move(announce)) {}

void ArduPilotTarget::Handle(const mavlink::LandingTarget& target, const FlightState& state) {
  constexpr int kMavlinkBackend = 1;
  if (parameters_["PLND_ENABLED"] == 0 || parameters_["PLND_TYPE"] != kMavlinkBackend) return;
  const auto sight = LineOfSight(target);
  if (!sight) return;
  sighted_at_ = state.time;
  sighted_in_body_.reset();
  sighted_in_world_.reset();
  if (target.frame == mavlink::kFrameLocalFrd) {
    sighted_in_world_ = WrongLocalFrame(state.pose.world_from_body.rotation) * *sight;
  } else {
    sighted_in_body_ = *sight;
  }
}

// Returns the vector from the body to the target in FLU, m; nothing when the message is not used.
std::optional<Vector3d> ArduPilotTarget::LineOfSight(const mavlink::LandingTarget& target) {
  if (target.frame != mavlink::kFrameBodyFrd && target.frame != mavlink::kFrameLocalFrd) {
    if (!reported_wrong_frame_) announce_(Severity::kInfo, "Plnd: Frame not supported ");
    reported_wrong_frame_ = true;
    return std::nullopt;
  }
  // There is no rangefinder that could measure the distance.
  if (!(target.distance > 0)) return std::nullopt;
  Vector3d in_frd(target.x, target.y, target.z);
  if (target.position_valid != 1) {
    const Vector3d ray(-std::tan(target.angle_y), std::tan(target.angle_x), 1);
    in_frd = target.distance * ray.normalized();
  }
  if (!in_frd.allFinite()) return std::nullopt;
  return FluFromFrd(in_frd);
}

void ArduPilotTarget::Estimate(const FlightState& state) {
  Remember(state);
  CheckTimeout(state.time);
  const auto measurement = TakeMeasurement(state.time, history_.front().world_from_body);
  if (parameters_["PLND_EST_TYPE"] == 0) {
    EstimateRaw(measurement, state.time);
  } else {
    EstimateFiltered(measurement, state.time);
  }
  if (is_acquired_) PredictOutput();
}

void ArduPilotTarget::Remember(const FlightState& state) {
  const Vector3d before = history_.empty() ? state.velocity() : history_.back().velocity;
  history_.push_back({state.time, state.step_s, state.pose.world_from_body.rotation,
                      state.velocity(), state.velocity() - before,
                      state.pose.motion->rate_in_body.norm()});
  const Time oldest = state.time - DurationFromSeconds(parameters_["PLND_LAG"]);
  while (history_.size() > 1 && history_[1].time <= oldest) history_.pop_front();
}

// Returns the newest sighting, once, as a vector in the world by the attitude at its time.
std::optional<Vector3d> ArduPilotTarget::TakeMeasurement(Time now,
                                                         const Eigen::Quaterniond& attitude) {
  const auto in_body = std::exchange(sighted_in_body_, std::nullopt);
  auto in_world = std::exchange(sighted_in_world_, std::nullopt);
  if (now - sighted_at_ > kSightTimeout) return std::nullopt;
  if (in_body) {
    // PLND_YAW_ALIGN is in hundredths of a degree, to the right; PLND_CAM_POS in FRD.
    const double align = -Radians(0.01 * parameters_["PLND_YAW_ALIGN"]);
    const Vector3d camera =
        FluFromFrd({parameters_["PLND_CAM_POS_X"], parameters_["PLND_CAM_POS_Y"],
                    parameters_["PLND_CAM_POS_Z"]});
    in_world = attitude * (Eigen::AngleAxisd(align, Vector3d::UnitZ()) * *in_body + camera);
  }
  if (!in_world || !(in_world->z() < 0)) return std::nullopt;
  depth_ = -in_world->z();
  return in_world;
}

void ArduPilotTarget::EstimateRaw(const std::optional<Vector3d>& measurement, Time now) {
  const InertialSample& then = history_.front();
  if (is_acquired_) {
    raw_position_ -= then.step_s * then.velocity.head<2>();
    raw_velocity_ = -then.velocity.head<2>();
  }
  if (!measurement) return;
  if (!is_started_) announce_(Severity::kInfo, "PrecLand: Target Found");
  is_started_ = true;
  is_acquired_ = true;
  updated_at_ = now;
  raw_position_ = measurement->head<2>();
  raw_velocity_ = -then.velocity.head<2>();
}

void ArduPilotTarget::EstimateFiltered(const std::optional<Vector3d>& measurement, Time now) {
  const InertialSample& then = history_.front();
  if (is_started_) {
    for (int i = 0; i < 2; ++i) {
      filters_[i].Predict(then.step_s, -then.velocity_change[i], kAccelerationNoise * then.step_s);
    }
  }
  if (measurement) {
    const double sigma = -measurement->z() * (0.01 + 0.01 * then.rate) + 0.02;
    if (is_started_) {
      FuseMeasurement(*measurement, sigma * sigma, now);
    } else {
      StartFilter(*measurement, sigma * sigma, now);
    }
  }
  CheckStart(now);
  for (int i = 0; i < 2; ++i) {
    raw_position_[i] = filters_[i].position();
    raw_velocity_[i] = filters_[i].velocity();
  }
}

void ArduPilotTarget::StartFilter(const Vector3d& measurement, double variance, Time now) {
  constexpr double kVelocityVariance = 4;
  announce_(Severity::kInfo, "PrecLand: Target Found");
  is_started_ = true;
  started_at_ = now;
  updated_at_ = now;
  for (int i = 0; i < 2; ++i) {
    filters_[i].Start(measurement[i], variance, -history_.front().velocity[i], kVelocityVariance);
  }
}

void ArduPilotTarget::FuseMeasurement(const Vector3d& measurement, double variance, Time now) {
  const double ratio = std::max(filters_[0].InnovationRatio(measurement.x(), variance),
                                filters_[1].InnovationRatio(measurement.y(), variance));
  if (!(ratio < kMaxInnovationRatio) && outliers_ < kMaxOutliers) {
    ++outliers_;
    return;
  }
  outliers_ = 0;
  updated_at_ = now;
  for (int i = 0; i < 2; ++i) filters_[i].Fuse(measurement[i], variance);
}

// Trusts the target after messages for a while without long gaps.
void ArduPilotTarget::CheckStart(Time now) {
  if (is_acquired_ || !is_started_) return;
  if (now - updated_at_ > kStartGap) {
    is_started_ = false;
    announce_(Severity::kInfo, "PrecLand: Init Failed");
  } else if (now - started_at_ > kStartPeriod) {
    is_acquired_ = true;
    announce_(Severity::kInfo, "PrecLand: Init Complete");
  }
}

void ArduPilotTarget::CheckTimeout(Time now) {
  if (!is_acquired_ || now - updated_at_ <= kTargetTimeout) return;
  is_acquired_ = false;
  is_started_ = false;
  announce_(Severity::kInfo, "PrecLand: Target Lost");
}

// Predicts the output from PLND_LAG ago to now.
void ArduPilotTarget::PredictOutput() {
  position_ = raw_position_;
  velocity_ = raw_velocity_;
  for (std::size_t i = 1; i < history_.size(); ++i) {
    velocity_ -= history_[i].velocity_change.head<2>();
    position_ += history_[i].step_s * velocity_;
  }
}

}  // namespace kestrel
