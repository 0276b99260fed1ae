// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_guide.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/calibration/lens/unlike_views.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// Speed of the board in the image below which an exposure of 10 ms blurs it by less than half a
// pixel, in widths of the image per second.
constexpr double kStill = 0.05;
constexpr Duration kLongestGap = std::chrono::seconds(1);  // between two sights of one movement
constexpr double kLeastDifference = 0.12;  // least difference of a view from all others
constexpr double kLeastTilt = Radians(15);
// Share of the image's width or height that the board fills.
constexpr double kNearShare = 0.6;
constexpr double kFarShare = 0.4;
// Numbers of views that are wanted.
constexpr int kOfTilt = 2;
constexpr int kOfDistance = 3;
constexpr std::size_t kOfAll = 20;

struct Bounds {
  Eigen::Vector2d least, most;

  Eigen::Vector2d Middle() const { return 0.5 * (least + most); }
  double ShareOf(const cv::Size& image) const {
    const Eigen::Vector2d size = most - least;
    return std::max(size.x() / image.width, size.y() / image.height);
  }
};

Bounds BoundsOf(const LensView& view) {
  Bounds bounds{view.edges.front().pixel, view.edges.front().pixel};
  for (const LensEdge& edge : view.edges) {
    bounds.least = bounds.least.cwiseMin(edge.pixel);
    bounds.most = bounds.most.cwiseMax(edge.pixel);
  }
  return bounds;
}

}  // namespace

bool LensGuide::IsStill(const LensView& view, Time time) const {
  if (!last_ || time <= last_time_ || time - last_time_ > kLongestGap) return false;
  const Bounds now = BoundsOf(view), before = BoundsOf(*last_);
  const double moved_px =
      std::max((now.least - before.least).norm(), (now.most - before.most).norm());
  return moved_px <= kStill * image_.width * ToSeconds(time - last_time_);
}

bool LensGuide::IsNew(const LensView& view) const {
  return std::all_of(views_.begin(), views_.end(), [&](const LensView& other) {
    return DifferenceOf(view, other, image_.width) > kLeastDifference;
  });
}

bool LensGuide::Look(std::optional<LensView> view, Time time, const CameraIntrinsics& camera) {
  if (!view) {
    sight_ = Sight::kNone;
    last_.reset();
    return false;
  }
  const bool is_still = IsStill(*view, time);
  const bool is_new = is_still && IsNew(*view);
  sight_ = is_new ? Sight::kTaken : is_still ? Sight::kKnown : Sight::kMoves;
  if (is_new) {
    views_.push_back(*view);
    Count(*view, camera);
  }
  last_ = std::move(view);
  last_time_ = time;
  return is_new;
}

void LensGuide::Count(const LensView& view, const CameraIntrinsics& camera) {
  variety_.coverage = CoverageOf(views_, CameraModel(camera));
  const double share = BoundsOf(view).ShareOf(image_);
  variety_.near += share >= kNearShare;
  variety_.far += share <= kFarShare;
  // Points out of the print, to the camera. The side that it turns away from is nearer.
  const Eigen::Vector3d out = view.camera_from_target.rotation * Eigen::Vector3d::UnitZ();
  const double least = std::sin(kLeastTilt);
  variety_.left += out.x() > least;
  variety_.right += out.x() < -least;
  variety_.top += out.y() > least;
  variety_.bottom += out.y() < -least;
}

// Returns the missing view with the most information, first the places in the image; empty when
// none is missing.
std::string LensGuide::Missing() const {
  const std::vector<std::string> empty = variety_.coverage.EmptyParts();
  if (!empty.empty()) return "bring the board to the " + empty.front() + " of the image";
  if (variety_.near < kOfDistance) return "bring it nearer: it should fill most of the image";
  if (variety_.left < kOfTilt) return "tilt it: its left side nearer to the camera";
  if (variety_.right < kOfTilt) return "tilt it: its right side nearer to the camera";
  if (variety_.top < kOfTilt) return "tilt it: its upper side nearer to the camera";
  if (variety_.bottom < kOfTilt) return "tilt it: its lower side nearer to the camera";
  if (variety_.far < kOfDistance) return "take it farther away";
  if (views_.size() < kOfAll) {
    return fmt::format("show it from other sides: {} more views", kOfAll - views_.size());
  }
  return "";
}

std::string LensGuide::Advice() const {
  std::string missing = Missing();
  if (sight_ == Sight::kNone) {
    const std::string show = "the board is not found: show it to the camera";
    return missing.empty() || views_.empty() ? show : show + ", then " + missing;
  }
  if (missing.empty()) return "enough views: save the calibration, or go on to make it better";
  if (sight_ == Sight::kMoves) return "hold it still; " + missing;
  return missing;
}

}  // namespace kestrel
