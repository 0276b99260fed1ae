// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/target_reporter.h"

#include <cmath>

#include "kestrel/core/base/options.h"

namespace kestrel {

TargetReporter::TargetReporter(const TargetReporterOptions& options,
                               const TargetTrackerOptions& tracker)
    : options_(Checked(options)), noise_(Checked(tracker).Noise()), contact_(options.contact) {}

std::optional<TargetState> TargetReporter::Report(Time now, Duration until_use,
                                                  const TrackSnapshot& track,
                                                  const PoseHistory& poses) {
  const Time time_of_use = now + until_use;
  const auto pose =
      poses.Predict(time_of_use, DurationFromSeconds(TargetReporterOptions::kMaxPoseAge_s), {});
  if (!pose) return std::nullopt;
  TargetState report;
  report.time = time_of_use;
  report.world_from_body = pose->world_from_body;
  const Eigen::Vector3d& body_velocity = pose->motion.velocity_in_world;
  std::optional<ContactDetector::Deck> deck;
  if (PredictTarget(track, &report)) {
    deck = ContactDetector::Deck{report.position_in_world, report.velocity_in_world};
    height_m_ = report.world_from_body.translation.z() - report.position_in_world.z();
  }
  // If a UAV is only held this low in the air, the report is still true: the deck is straight
  // below.
  if (!may_stand_) contact_.Reset();
  if (may_stand_ && contact_.Update(now, report.world_from_body.translation, body_velocity, deck)) {
    phase_ = TargetPhase::kContact;
    return Below(report, body_velocity);
  }
  if (deck) {
    phase_ = TargetPhase::kFound;
    return report;
  }
  if (phase_ != TargetPhase::kSearching) phase_ = TargetPhase::kLost;
  return std::nullopt;
}

bool TargetReporter::PredictTarget(const TrackSnapshot& track, TargetState* report) const {
  if (!track.target || track.state == TrackState::kSearching) return false;
  const double ahead_s = ToSeconds(report->time - track.captured);
  const TurnState target = Propagate(track.target->motion, std::max(ahead_s, 0.0), noise_);
  report->position_in_world = target.position();
  report->velocity_in_world = target.velocity();
  report->covariance = target.covariance.topLeftCorner<3, 3>();
  if (track.target->has_yaw()) {
    report->yaw = target.yaw();
    report->yaw_sigma = std::sqrt(target.covariance(TurnState::kYaw, TurnState::kYaw));
  }
  // Written so that values that are not finite are refused.
  return report->covariance.trace() <= 3 * std::pow(options_.max_sigma_m, 2) &&
         report->position_in_world.allFinite();
}

TargetState TargetReporter::Below(TargetState report, const Eigen::Vector3d& body_velocity) const {
  report.position_in_world = report.world_from_body.translation;
  report.position_in_world.z() -= TargetReporterOptions::kContactBelow_m;
  report.velocity_in_world = body_velocity;
  report.covariance = std::pow(0.1, 2) * Eigen::Matrix3d::Identity();
  return report;
}

}  // namespace kestrel
