// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/flight/session/track_snapshot.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

struct TargetReporterOptions {
  // Longest time from the last pose to the time of a report.
  static constexpr double kMaxPoseAge_s = 0.3;
  // Depth below the deck at which a target in contact is reported.
  static constexpr double kContactBelow_m = 0.2;

  double max_sigma_m = 0.5;
  // When the UAV stands on the deck by these limits, the target is reported below it.
  ContactOptions contact = {.height_m = 0.6, .reach_m = 0.6, .speed_mps = 0.1};

  static void Visit(auto& self, auto&& visit) {
    visit("max_sigma_m", self.max_sigma_m, MoreThan(0),
          "largest standard deviation per axis of a target that is sent");
    visit.Gone({"max_pose_age_s", "contact", "contact_below_m"});
  }
};

// Computes the report to the autopilot from the track, at any instant: the target predicted to the
// time at which the message is used, seen from the UAV's pose at that time. After contact the
// camera sees nothing any more and the track fades; the deck is then straight below and moves as
// the UAV does. Without that report an autopilot brakes, and never disarms on a moving deck.
class TargetReporter {
 public:
  // 'tracker': options of the predicted track. Throws InputError when the options are not valid.
  TargetReporter(const TargetReporterOptions& options, const TargetTrackerOptions& tracker);

  // Returns the target 'until_use' after 'now': later by the link's delay, or earlier where the
  // autopilot takes a measurement as one of some time ago. 'poses': the newest poses of the UAV.
  // Nothing while the target or the pose is not known well enough. Call it in order of time.
  std::optional<TargetState> Report(Time now, Duration until_use, const TrackSnapshot& track,
                                    const PoseHistory& poses);

  // Reports whether the UAV may stand on the deck: guidance may know that it hovers there.
  void set_may_stand(bool may_stand) { may_stand_ = may_stand; }

  TargetPhase phase() const { return phase_; }
  // Height of the body above the target in the newest report, m.
  double height_m() const { return height_m_; }

 private:
  bool PredictTarget(const TrackSnapshot& track, TargetState* report) const;
  TargetState Below(TargetState report, const Eigen::Vector3d& body_velocity) const;

  TargetReporterOptions options_;
  TurnNoise noise_;
  TargetPhase phase_ = TargetPhase::kSearching;
  double height_m_ = 0;
  ContactDetector contact_;
  bool may_stand_ = true;
};

}  // namespace kestrel
