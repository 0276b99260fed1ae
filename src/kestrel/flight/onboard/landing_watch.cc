// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_watch.h"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr double kFlownHeight_m = 1;     // a UAV that has risen or sunk by this has flown
constexpr double kAtRest_mps = 0.2;      // it neither rises nor sinks
constexpr double kLargestSigma_m = 0.5;  // a pattern known no better is not known to be below
constexpr double kStandingHeight_m = 0.6;
// A UAV seen so low above the pattern has come down there, if it moves no faster than this until
// touch-down, and is disarmed within this time where its position is not known.
constexpr double kSeenHeight_m = 0.5;
constexpr double kFastestSlip_mps = 2;
constexpr double kSeenBefore_s = 20;
constexpr Duration kShortestProof = std::chrono::milliseconds(500);
constexpr Duration kLongestProof = std::chrono::seconds(10);

}  // namespace

void LandingWatch::Observe(const LandingWatchInput& input) {
  if (end_) return;
  if (has_flown_ && input.reboots > reboots_) {
    end_ = FlightEnd{FlightOutcome::kRestarted};
    return;
  }
  if (input.is_armed) {
    disarmed_.reset();
    Fly(input);
  } else if (has_flown_) {
    if (!disarmed_) disarmed_ = input.now;
    if (IsCertain(input)) end_ = Judge(input);
  } else {
    armed_z_m_.reset();
    reboots_ = input.reboots;
  }
}

void LandingWatch::Fly(const LandingWatchInput& input) {
  has_flown_ =
      has_flown_ || input.state == LandedState::kInAir || input.state == LandedState::kLanding;
  if (input.sight) sight_ = input.sight;
  has_body_ = input.body.has_value();
  if (!input.body) return;
  if (!armed_z_m_) armed_z_m_ = input.body->feet.z();
  has_flown_ = has_flown_ || std::abs(input.body->feet.z() - *armed_z_m_) > kFlownHeight_m;
  const bool is_at_rest = input.has_contact || std::abs(input.body->velocity.z()) < kAtRest_mps;
  if (is_at_rest) return;
  touched_down_ = input.now;
  place_.reset();
  if (!input.pattern) return;
  const Eigen::Vector3d from_pattern = input.body->feet - input.pattern->position;
  const Eigen::Matrix3d& covariance = input.pattern->covariance;
  place_ = Place{from_pattern.head<2>().norm(), from_pattern.z(),
                 std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2),
                 std::sqrt(covariance(2, 2)), input.heading_error};
  if (place_->offset_sigma_m > kLargestSigma_m) return;
  seen_ = input.now;
  seen_offset_m_ = place_->offset_m;
}

// The first heartbeats of an autopilot that has restarted say "disarmed" as those of one that has
// landed; its time since boot tells them apart.
bool LandingWatch::IsCertain(const LandingWatchInput& input) const {
  const Duration waited = input.now - *disarmed_;
  return input.stamped > *disarmed_ + kShortestProof || waited > kLongestProof;
}

FlightEnd LandingWatch::Judge(const LandingWatchInput& input) const {
  if (pattern_radius_m_ == 0) return {FlightOutcome::kLanded};
  FlightEnd end = JudgePlace();
  if (end.outcome == FlightOutcome::kOnPattern) return end;
  if (const std::string why = WhySightCounts(end); !why.empty()) {
    return {FlightOutcome::kOnPattern, sight_->feet.head<2>().norm(), "by what was seen: " + why};
  }
  if (input.gave_up.empty()) return end;
  end.outcome = FlightOutcome::kGaveUp;
  end.reason = input.gave_up;
  return end;
}

// Returns why the newest frame that showed the pattern counts more than the position, by which the
// UAV is not on it; empty: it does not.
std::string LandingWatch::WhySightCounts(const FlightEnd& by_place) const {
  if (!sight_ || sight_->feet.z() > kSeenHeight_m) return "";
  const double offset_m = sight_->feet.head<2>().norm();
  if (offset_m > pattern_radius_m_) return "";
  if (!has_body_) {
    return ToSeconds(*disarmed_ - sight_->time) < kSeenBefore_s ? "the autopilot had no position"
                                                                : "";
  }
  if (!by_place.offset_m) return "";
  const double moved_m =
      kFastestSlip_mps * std::max(ToSeconds(touched_down_ - sight_->time), 0.0) + kLargestSigma_m;
  return *by_place.offset_m - offset_m > moved_m ? "the autopilot's position is wrong" : "";
}

FlightEnd LandingWatch::JudgePlace() const {
  constexpr double kSure = 2;  // standard deviations
  if (!place_ && !seen_) return {FlightOutcome::kDownSomewhere, {}, "the pattern was never seen"};
  if (!place_) {
    return {FlightOutcome::kDownSomewhere,
            {},
            fmt::format("{:.0f} s before touch-down the pattern was {:.1f} m away, and then lost",
                        ToSeconds(touched_down_ - *seen_), seen_offset_m_)};
  }
  const double sigma_m = place_->offset_sigma_m;
  if (place_->offset_m - kSure * sigma_m > pattern_radius_m_) {
    return {FlightOutcome::kBesidePattern, place_->offset_m};
  }
  if (place_->offset_m > pattern_radius_m_ || sigma_m > kLargestSigma_m) {
    return {FlightOutcome::kDownSomewhere,
            {},
            fmt::format("the pattern's place is known to {:.1f} m only", kSure * sigma_m)};
  }
  if (std::abs(place_->height_m) > kStandingHeight_m + kSure * place_->height_sigma_m) {
    return {FlightOutcome::kDownSomewhere,
            {},
            fmt::format("disarmed {:.1f} m {} the pattern", std::abs(place_->height_m),
                        place_->height_m > 0 ? "above" : "below")};
  }
  return {FlightOutcome::kOnPattern, place_->offset_m, {}, place_->heading_error};
}

}  // namespace kestrel
