// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"

namespace kestrel {

// What is known about the landing pattern in an image.
enum class PatternTruth {
  kWhole,    // it is there, and its centre is known
  kPartial,  // cut by the border; only a part of its ring is known
  kNone,     // it is not there
  kUnknown,  // not to be scored
};

// One image with its truth.
struct LandingFrame {
  std::string name;
  std::string group;  // sequence or condition
  cv::Mat image;      // CV_8UC1
  PatternTruth truth = PatternTruth::kUnknown;
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  // kWhole: where the arms meet
  double ring_radius_px = 0;     // of the outer edge, half of its largest width in the image
  std::optional<Ellipse> outer;  // annotated outer edge of the ring, pixels
  std::optional<RigidTransform> camera_from_pattern;
  std::optional<Eigen::Vector3d> up_in_camera;  // what the navigation says, unit vector
  double altitude_m = 0;                        // of the camera above the pattern; 0 if not known
  double visible_fraction = 1;                  // of ring and cross, 0 to 1; 1 if not known
};

struct LandingFrameSet {
  std::string name;
  CameraIntrinsics camera;
  std::vector<LandingFrame> frames;
};

// The real frames of 'data_dir'/landing_real, one set per sequence: annotations.csv and the images
// that it names. Empty when there is no such folder; throws InputError when its files are at fault.
std::vector<LandingFrameSet> ReadLandingReal(const std::string& data_dir);

// The independently rendered stills of 'data_dir'/landing_hard, one set per condition (recordings
// in the EuRoC layout). Empty when there is no such folder; throws InputError as above.
std::vector<LandingFrameSet> ReadLandingHard(const std::string& data_dir);

// What a still may have that makes it hard: the groups of rendered stills, a still that has several
// in the last of them.
inline constexpr std::array<const char*, 4> kStillGroups{"whole, no shadow or highlight", "shadow",
                                                         "highlight", "cut off or hidden in part"};

// A rendered still, named after its set and seed.
LandingFrame FrameFromStill(const LandingStill& still, const std::string& set, std::uint64_t seed);
LandingFrame FrameFromStill(const LandingStillMaker& maker, const std::string& set,
                            std::uint64_t seed);
LandingFrame FrameFromLookalikes(const LookalikeStill& still, const std::string& group,
                                 std::uint64_t seed);
LandingFrame FrameFromLookalikes(const LandingStillMaker& maker, const std::string& group,
                                 std::uint64_t seed);

}  // namespace kestrel
