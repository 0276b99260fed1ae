// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// What the vision knows of the target after a frame. Times are those of the navigation's clock.
struct TrackSnapshot {
  Time captured;             // the frame's light
  std::optional<Time> seen;  // of the newest frame that showed the target where the track has it
  TrackState state = TrackState::kSearching;
  std::optional<TargetEstimate> target;  // at 'captured', in the world
  // What this frame alone showed, seen from where the UAV was then.
  std::optional<TargetReport> sighting;
  Duration detect_time{};
  int frames = 0;      // so far
  int detections = 0;  // frames that showed the target
};

struct TargetReporterOptions {
  double max_sigma_m = 0.5;
  double max_pose_age_s = 0.3;
  // Contact: of the body, which is that much above the deck when the legs stand there.
  ContactOptions contact = {.height_m = 0.6, .reach_m = 0.6};
  double contact_below_m = 0.2;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("max_sigma_m", self.max_sigma_m, "m",
            "a target known no better than this, standard deviation per axis, is not sent");
    visitor("max_pose_age_s", self.max_pose_age_s, "s",
            "without a pose for so long nothing is sent");
    visitor.Group("contact", self.contact);
    visitor("contact_below_m", self.contact_below_m, "m",
            "after contact the target is said to be so far below the body");
  }
  std::vector<std::string> Validate() const;
};

// From the track to what the autopilot is told, at any instant: the target predicted to when the
// message is used, seen from where the UAV will be then. After contact the camera sees nothing any
// more and the track fades; the deck is then straight below, and moves as the UAV does: without
// being told so an autopilot brakes, and never disarms on a deck that drives on.
class TargetReporter {
 public:
  // 'tracker': of the track that is predicted. Throws InputError when the options are not valid.
  TargetReporter(const TargetReporterOptions& options, const TargetTrackerOptions& tracker);

  // The target 'until_use' after 'now': after the link's delay, and before now where the autopilot
  // uses a measurement as one of some time ago. 'poses': the newest ones of the UAV. Nothing while
  // the target or the pose is not known well enough. To be called in order of time.
  std::optional<TargetReport> Report(Time now, Duration until_use, const TrackSnapshot& track,
                                     const PoseHistory& poses);

  // Whether it may stand on the deck: who flies it by set-points may know that it hovers there.
  void set_may_stand(bool may_stand) { may_stand_ = may_stand; }

  TargetPhase phase() const { return phase_; }
  // Of the body above the target, by the newest report, m.
  double height_m() const { return height_m_; }

 private:
  bool PredictTarget(const TrackSnapshot& track, TargetReport* report) const;
  TargetReport Below(TargetReport report, const Eigen::Vector3d& body_velocity) const;

  TargetReporterOptions options_;
  TurnNoise noise_;
  TargetPhase phase_ = TargetPhase::kSearching;
  double height_m_ = 0;
  ContactDetector contact_;
  bool may_stand_ = true;
};

}  // namespace kestrel
