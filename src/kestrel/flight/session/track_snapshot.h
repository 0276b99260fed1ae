// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/comms/mavlink/target_profile.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_detection.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// The vision's knowledge of the target after a frame. Times are on the navigation's clock.
struct TrackSnapshot {
  Time captured;             // time of the frame's exposure
  std::optional<Time> seen;  // the newest frame that showed the target where the track expects it
  TrackState state = TrackState::kSearching;
  std::optional<TargetEstimate> target;  // at 'captured', in the world
  // The target in this frame alone, seen from the UAV's pose at that time.
  std::optional<TargetState> sighting;
  // The newest frame that showed the target, without any pose: where the UAV's body was then.
  struct Sight {
    Time time;
    RigidTransform target_from_body;
    Eigen::Matrix3d covariance;  // uncertainty of the target's centre in the body, m^2
    double heading_sigma = 0;    // about the target's normal, rad
    int heading_symmetry = 1;    // turns after which the target looks the same; 0: any
  };
  std::optional<Sight> sight;
  // Number of the person's mark, or of the object, that the target is of; 0: of none.
  int mark = 0;
  cv::Rect area = {};  // area of the target in this frame; empty: it was not found
  Duration detect_time{};
  int frames = 0;                          // so far
  int detections = 0;                      // frames that showed the target
  std::optional<OtherTag> other_tag = {};  // as LandingObservation's
  // What a person has marked, in this frame: nothing to land on.
  std::optional<FollowObservation> followed = {};
};

// Returns the sight of a detection at 'time'.
TrackSnapshot::Sight SightOf(const TargetDetection& detection,
                             const RigidTransform& camera_from_body, Time time);

// A pad as guidance and the autopilot's messages know it.
struct PadInSight {
  double size_m = 0;   // outer diameter
  double range_m = 0;  // from which the camera sees it at most
  TargetTrackerOptions tracker;
};

}  // namespace kestrel
