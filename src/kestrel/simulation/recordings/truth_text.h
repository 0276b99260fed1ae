// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/scene/world.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Text of state_groundtruth_estimate0/data.csv of a flight: the true pose and velocity at 100 Hz
// from 'begin_s' to 'end_s', and at all image times.
std::string TrueStateText(const Motion& world_from_body, double begin_s, double end_s,
                          const std::vector<double>& image_times_s);

// The same for unrelated poses: without velocities.
std::string TrueStateText(const std::vector<PoseSample>& poses);

// Returns the pad in the image that 'camera' takes at 'time_s', whose stamp is 'stamp'; nothing
// where the camera model does not cover the pad's centre.
std::optional<TruePattern> SeenPattern(Time stamp, double time_s, const FlightCamera& camera,
                                       const TargetPrint& print, const Motion& world_from_pattern);

// Returns lines of text as a part of a YAML map: with two blanks before each.
std::string Indented(const std::string& lines);

}  // namespace kestrel
