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

// The known truth about the landing pattern in an image.
enum class PatternTruth {
  kWhole,    // it is there, with a known centre
  kPartial,  // cut by the border; only a part of its ring is annotated
  kNone,     // it is not there
  kUnknown,  // not to be scored
};

// An image with its truth.
struct LandingFrame {
  std::string name;
  std::string group;  // sequence or condition
  cv::Mat image;      // CV_8UC1
  PatternTruth truth = PatternTruth::kUnknown;
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  // kWhole: point where the arms meet
  double ring_radius_px = 0;     // of the outer edge: half of its largest width in the image
  std::optional<Ellipse> outer;  // annotated outer edge of the ring, pixels
  std::optional<RigidTransform> camera_from_target;
  std::optional<Eigen::Vector3d> up_in_camera;  // by the navigation, unit vector
  double altitude_m = 0;                        // of the camera above the pattern; 0 if unknown
  double visible_fraction = 1;                  // of ring and cross, 0 to 1; 1 if unknown
};

struct LandingFrameSet {
  std::string name;
  CameraIntrinsics camera;
  std::vector<LandingFrame> frames;
};

// Reads the real frames of 'data_dir'/landing_real, one set per sequence: annotations.csv and the
// images that it names. Empty when there is no such folder; throws InputError when its files are
// not valid.
std::vector<LandingFrameSet> ReadLandingReal(const std::string& data_dir);

// Reads the independently rendered stills of 'data_dir'/landing_hard, one set per condition
// (recordings in the EuRoC layout). Empty when there is no such folder; throws InputError as above.
std::vector<LandingFrameSet> ReadLandingHard(const std::string& data_dir);

// Groups of rendered stills, by what makes them hard; a still with several hardships is in the last
// of their groups.
inline constexpr std::array<const char*, 4> kStillGroups{"whole, no shadow or highlight", "shadow",
                                                         "highlight", "cut off or hidden in part"};

// Returns a rendered still with a name made of its set and seed.
LandingFrame FrameFromStill(const LandingStill& still, const std::string& set, std::uint64_t seed);
LandingFrame FrameFromStill(const LandingStillMaker& maker, const std::string& set,
                            std::uint64_t seed);
LandingFrame FrameFromLookalikes(const LookalikeStill& still, const std::string& group,
                                 std::uint64_t seed);
LandingFrame FrameFromLookalikes(const LandingStillMaker& maker, const std::string& group,
                                 std::uint64_t seed);

}  // namespace kestrel
