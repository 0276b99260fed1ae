// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/onboard/target_reporter.h"

#include <cmath>

#include "kestrel/base/options.h"
#include "kestrel/base/violations.h"

namespace kestrel {

std::vector<std::string> TargetReporterOptions::Validate() const {
  std::vector<std::string> violations;
  RequirePositive(max_sigma_m, "max_sigma_m", &violations);
  RequireIn(max_pose_age_s, 0.01, 5, "max_pose_age_s", &violations);
  RequirePositive(contact_height_m, "contact_height_m", &violations);
  RequirePositive(contact_speed_mps, "contact_speed_mps", &violations);
  RequirePositive(contact_time_s, "contact_time_s", &violations);
  RequirePositive(contact_below_m, "contact_below_m", &violations);
  return violations;
}

const char* ToString(TargetPhase phase) {
  switch (phase) {
    case TargetPhase::kSearching:
      return "searching";
    case TargetPhase::kFound:
      return "found";
    case TargetPhase::kLost:
      return "lost";
    case TargetPhase::kContact:
      return "contact";
  }
  return "";
}

TargetReporter::TargetReporter(const TargetReporterOptions& options,
                               const TargetTrackerOptions& tracker)
    : options_(Checked(options)), noise_(Checked(tracker).Noise()) {}

std::optional<TargetReport> TargetReporter::Report(Time now, Duration until_use,
                                                   const TrackSnapshot& track,
                                                   const PoseHistory& poses) {
  const Time time_of_use = now + until_use;
  const auto pose = poses.Predict(time_of_use, DurationFromSeconds(options_.max_pose_age_s), {});
  if (!pose) return std::nullopt;
  TargetReport report;
  report.time = time_of_use;
  report.world_from_body = pose->world_from_body;
  const Eigen::Vector3d& body_velocity = pose->motion.velocity_in_world;
  if (phase_ == TargetPhase::kContact && StaysInContact(report)) {
    return Below(report, body_velocity);
  }
  if (!PredictTarget(track, &report)) {
    if (phase_ != TargetPhase::kSearching) phase_ = TargetPhase::kLost;
    resting_since_.reset();
    return std::nullopt;
  }
  phase_ = TargetPhase::kFound;
  height_m_ = report.world_from_body.translation.z() - report.position_in_world.z();
  if (!HasContact(now, report, body_velocity)) return report;
  phase_ = TargetPhase::kContact;
  contact_z_m_ = report.world_from_body.translation.z();
  return Below(report, body_velocity);
}

bool TargetReporter::PredictTarget(const TrackSnapshot& track, TargetReport* report) const {
  if (!track.target || track.state == TrackState::kSearching) return false;
  const double ahead_s = ToSeconds(report->time - track.captured);
  const TurnState target = Propagate(track.target->motion, std::max(ahead_s, 0.0), noise_);
  report->position_in_world = target.position();
  report->velocity_in_world = target.velocity();
  report->covariance = target.covariance.topLeftCorner<3, 3>();
  // Written so that what is not finite is refused.
  return report->covariance.trace() <= 3 * std::pow(options_.max_sigma_m, 2) &&
         report->position_in_world.allFinite();
}

// Whether the body has been as near to the deck, and as much at rest against it, as it is when the
// legs stand there. A UAV that is held in the air so low is told the truth all the same: the deck
// is straight below.
bool TargetReporter::HasContact(Time now, const TargetReport& report,
                                const Eigen::Vector3d& body_velocity) {
  const double sink_mps = report.velocity_in_world.z() - body_velocity.z();
  const Eigen::Vector3d offset = report.position_in_world - report.world_from_body.translation;
  const bool rests = height_m_ < options_.contact_height_m &&
                     offset.head<2>().norm() < options_.contact_height_m &&
                     std::abs(sink_mps) < options_.contact_speed_mps;
  if (!rests) {
    resting_since_.reset();
    return false;
  }
  if (!resting_since_) resting_since_ = now;
  return now - *resting_since_ >= DurationFromSeconds(options_.contact_time_s);
}

bool TargetReporter::StaysInContact(const TargetReport& report) const {
  return report.world_from_body.translation.z() < contact_z_m_ + options_.contact_height_m;
}

TargetReport TargetReporter::Below(TargetReport report,
                                   const Eigen::Vector3d& body_velocity) const {
  report.position_in_world = report.world_from_body.translation;
  report.position_in_world.z() -= options_.contact_below_m;
  report.velocity_in_world = body_velocity;
  report.covariance = std::pow(0.1, 2) * Eigen::Matrix3d::Identity();
  return report;
}

}  // namespace kestrel
