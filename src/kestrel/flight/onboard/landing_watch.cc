// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/flight/guidance/since.h"

namespace kestrel {
namespace {

constexpr double kFlownHeight_m = 1;  // a UAV that has risen or sunk by this has flown
// It neither rises nor sinks below this speed, or below this share of the fastest one of the last
// second: on contact a UAV that leans swings upright about its feet, while its velocity still
// falls.
constexpr double kAtRest_mps = 0.2;
constexpr double kAtRestShare = 0.6;
constexpr double kSinkMemory_s = 1;
constexpr double kLargestSigma_m = 0.5;  // a pattern known no better is not known to be below
constexpr double kStandingHeight_m = 0.6;
// A UAV seen so low above the pattern has come down there, if it is on the ground within this time
// (PX4 takes 6 s to find it without a position); by a position that is right it has moved no faster
// than this meanwhile.
constexpr double kSeenHeight_m = 0.5;
constexpr double kFastestSlip_mps = 2;
constexpr double kSeenBefore_s = 8;
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
  has_flown_ = has_flown_ || IsInFlight(input.state);
  if (input.sight) sight_ = input.sight;
  has_body_ = input.body.has_value();
  Remember(input.has_contact || input.state == LandedState::kOnGround, input.now, &on_ground_);
  if (!input.body) return;
  if (!armed_z_m_) armed_z_m_ = input.body->feet.z();
  has_flown_ = has_flown_ || std::abs(input.body->feet.z() - *armed_z_m_) > kFlownHeight_m;
  if (input.has_contact) return;
  const double speed_mps = std::abs(input.body->velocity.z());
  RememberSpeed(input.now, speed_mps);
  if (speed_mps < std::max(kAtRest_mps, kAtRestShare * fastest_mps_)) return;
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

void LandingWatch::RememberSpeed(Time now, double speed_mps) {
  fastest_mps_ *= std::exp(-ToSeconds(now - last_) / kSinkMemory_s);
  fastest_mps_ = std::max(fastest_mps_, speed_mps);
  last_ = now;
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
  const double blind_s = ToSeconds(on_ground_.value_or(*disarmed_) - sight_->time);
  if (offset_m > pattern_radius_m_ || blind_s > kSeenBefore_s) return "";
  if (!has_body_) return "the autopilot had no position";
  const double moved_m = kFastestSlip_mps * std::max(blind_s, 0.0) + kLargestSigma_m;
  const bool is_plausible = by_place.offset_m && *by_place.offset_m - offset_m < moved_m;
  return is_plausible ? "" : "the autopilot's position is wrong";
}

FlightEnd LandingWatch::JudgePlace() const {
  constexpr double kSure = 2;  // standard deviations
  if (!place_ && !seen_) {
    return {FlightOutcome::kDownSomewhere,
            {},
            sight_ && !has_body_
                ? fmt::format("no position, and the pattern was last seen {:.1f} m away",
                              sight_->feet.head<2>().norm())
                : "the pattern was never seen"};
  }
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
