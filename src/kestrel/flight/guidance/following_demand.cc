// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/following_demand.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSmoothing_s = 0.5;   // for the acceleration: a track's turn rate is noisy
constexpr double kDemandMemory_s = 8;  // about a lobe of a figure of eight
// Share of a limit from which the UAV falls behind for sure. The estimates of wind and curve are
// good to some per cent.
constexpr double kBeyond = 1.05;

double Share(double part, double whole) { return whole > 0 ? part / whole : 0; }

// The larger of a value and the fading maximum of those before.
void KeepPeak(double value, double seconds, double* peak) {
  *peak = std::max(value, *peak * std::exp(-seconds / kDemandMemory_s));
}

}  // namespace

double FollowingDemand::lean_share() const {
  return Share(std::tan(Radians(lean_deg)), std::tan(Radians(max_lean_deg)));
}
double FollowingDemand::speed_share() const { return Share(speed_mps, max_speed_mps); }
double FollowingDemand::climb_share() const { return Share(climb_mps, max_climb_mps); }

bool FollowingDemand::is_beyond_limits() const {
  return std::max({lean_share(), speed_share(), climb_share()}) > kBeyond;
}

std::string FollowingDemand::InWords() const {
  std::string words;
  const auto add = [&](double share, double needed, double limit, const char* what) {
    if (share <= kBeyond) return;
    words += fmt::format("{}{:.{}f} {}, the limit is {:g}", words.empty() ? "" : "; ", needed,
                         needed < 20 ? 1 : 0, what, limit);
  };
  add(lean_share(), lean_deg, max_lean_deg, "degrees of lean");
  add(speed_share(), speed_mps, max_speed_mps, "m/s");
  add(climb_share(), climb_mps, max_climb_mps, "m/s of climb");
  return words;
}

const FollowingDemand& DemandWatch::Update(Time now, const Vector3d& velocity,
                                           const Vector3d& acceleration,
                                           const std::optional<AirEstimate>& air) {
  const double seconds = time_ ? std::max(ToSeconds(now - *time_), 0.0) : 0;
  const double part = time_ ? 1 - std::exp(-seconds / kSmoothing_s) : 1;
  time_ = now;
  Vector2d needed = acceleration.head<2>();
  if (air) needed += air->drag * (velocity.head<2>() - air->wind);
  acceleration_ += part * (needed.norm() - acceleration_);
  KeepPeak(acceleration_, seconds, &acceleration_peak_);
  KeepPeak(velocity.head<2>().norm(), seconds, &speed_peak_);
  KeepPeak(std::abs(velocity.z()), seconds, &climb_peak_);
  demand_ = {.lean_deg = Degrees(std::atan(acceleration_peak_ / kGravity)),
             .max_lean_deg = limits_.max_tilt_deg,
             .speed_mps = speed_peak_,
             .max_speed_mps = limits_.max_speed_mps,
             .climb_mps = climb_peak_,
             .max_climb_mps = limits_.max_climb_mps};
  return demand_;
}

void DemandWatch::Reset() {
  time_.reset();
  acceleration_ = acceleration_peak_ = speed_peak_ = climb_peak_ = 0;
  demand_ = {};
}

}  // namespace kestrel
