// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/external_pose.h"
#include "kestrel/flight/session/track_snapshot.h"

namespace kestrel {

// The heading that the autopilot's estimator goes by: the place must be in that frame.
enum class HeadingSource {
  kAutopilot,  // its own, of a compass
  kPad,        // the one that is sent with the place
};

// The UAV's place over a pad that stands, from frames that show the pad and from the autopilot's
// attitude; no position is needed. The frame is level, its origin is the pad's centre, and its axes
// are those of the autopilot's world in the first frame. Of the image only distance, direction and
// heading are used: a pad's tilt is much less certain than the autopilot's.
class PadPlace {
 public:
  // 'world_from_body': the autopilot's attitude at the time of the sight.
  ExternalPose Update(const TrackSnapshot::Sight& sight, const Eigen::Quaterniond& world_from_body,
                      HeadingSource source);

  // Returns by how much the autopilot's heading has left the pad's since the first frame, rad; 0
  // where the pad has no heading.
  double heading_drift() const { return heading_drift_; }
  // Number of jumps: places that no flight connects, as when another pad was put there.
  int resets() const { return resets_; }

 private:
  double HeadingByPad(const TrackSnapshot::Sight& sight, double own);
  void CountJump(const ExternalPose& pose);

  std::optional<double> heading_of_pad_;  // in the frame, rad
  int symmetry_ = 0;                      // with which it was seen then
  double heading_drift_ = 0;
  std::optional<ExternalPose> last_;
  int resets_ = 0;
};

}  // namespace kestrel
