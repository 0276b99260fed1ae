// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/follow_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/simulation/rendering/occlusion.h"
#include "kestrel/simulation/scene/motion.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Returns the part of a world that one body is, or all but it.
World PartOf(const World& world, int body, bool is_body) {
  World part;
  part.bodies = world.bodies;
  for (const Surface& surface : world.surfaces) {
    if ((surface.body == body) == is_body) part.surfaces.push_back(surface);
  }
  return part;
}

class RegionSeen {
 public:
  RegionSeen(int thing, const SimulatedFlight& flight)
      : motion_(flight.world().bodies[thing]),
        flight_(flight),
        own_(PartOf(flight.world(), thing, true)),
        others_(PartOf(flight.world(), thing, false)) {}

  TrueRegion At(double time_s) {
    camera_ = flight_.CameraAt(time_s);
    TrueRegion region;
    region.time = TimeOfFlight(time_s);
    region.place_in_world = motion_(time_s).translation;
    region.velocity_in_world = VelocityOf(motion_, time_s);
    region.box_px = BoxAt(time_s);
    if (region.box_px.area() > 0) region.visible_fraction = VisiblePart(region.box_px, time_s);
    return region;
  }

 private:
  std::optional<Vector2d> PixelOf(const Surface& surface, double x, double y, double time_s) const {
    return camera_->Project(time_s, [&](double now_s) {
      return Vector3d(motion_(now_s) * (surface.center + x * surface.right + y * surface.up));
    });
  }

  // Around all corners, as far as they are in the image.
  cv::Rect2d BoxAt(double time_s) const {
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const Surface& surface : own_.surfaces) {
      for (int corner = 0; corner < 4; ++corner) {
        const auto pixel = PixelOf(surface, corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, time_s);
        if (!pixel) return {};
        low = low.min(pixel->array());
        high = high.max(pixel->array());
      }
    }
    const CameraModel& model = camera_->lens().camera();
    low = low.max(0);
    high = high.min(Eigen::Array2d(model.width_px() - 1, model.height_px() - 1));
    if ((high < low).any()) return {};
    return {low.x(), low.y(), high.x() - low.x() + 1, high.y() - low.y() + 1};
  }

  // True if all of what the box is around is in the image. A lens bends edges past their ends, by
  // less than a share of their length.
  bool IsWholeInImage(const cv::Rect2d& box) const {
    const CameraModel& model = camera_->lens().camera();
    const double margin_px = 1 + 0.25 * std::max(box.width, box.height);
    return box.x > margin_px && box.y > margin_px && box.br().x < model.width_px() - margin_px &&
           box.br().y < model.height_px() - margin_px;
  }

  // Counts points on the surfaces that face the camera, each by the solid angle of its part. 'box':
  // see BoxAt.
  double VisiblePart(const cv::Rect2d& box, double time_s) const {
    constexpr int kSteps = 5;
    const bool is_whole = IsWholeInImage(box);
    const Vector3d eye = camera_->WorldFromCamera(time_s).translation;
    const RigidTransform pose = motion_(time_s);
    double all = 0, visible = 0;
    for (const Surface& surface : own_.surfaces) {
      const Vector3d area = pose.rotation * surface.right.cross(surface.up);
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double x = (2.0 * (i % kSteps) + 1) / kSteps - 1;
        const double y = 2.0 * (i / kSteps + 0.5) / kSteps - 1;
        const Vector3d point = pose * (surface.center + x * surface.right + y * surface.up);
        const Vector3d way = eye - point;
        const double weight = area.dot(way) / std::pow(way.norm(), 3);
        if (weight <= 0 || IsHidden(own_, time_s, eye, point)) continue;
        all += weight;
        const bool is_in_image = is_whole || IsInImage(PixelOf(surface, x, y, time_s));
        if (is_in_image && !IsHidden(others_, time_s, eye, point)) visible += weight;
      }
    }
    return all > 0 ? visible / all : 0;
  }

  bool IsInImage(const std::optional<Vector2d>& pixel) const {
    const CameraModel& model = camera_->lens().camera();
    return pixel && pixel->x() > -0.5 && pixel->x() < model.width_px() - 0.5 && pixel->y() > -0.5 &&
           pixel->y() < model.height_px() - 0.5;
  }

  Motion motion_;
  const SimulatedFlight& flight_;
  std::shared_ptr<const FlightCamera> camera_;  // with its lens at the time that is looked at
  World own_, others_;
};

}  // namespace

std::string RegionRowsText(int thing, const SimulatedFlight& flight,
                           const std::vector<double>& image_times_s) {
  RegionSeen seen(thing, flight);
  std::string text = RegionTruthHeader();
  for (const double time_s : image_times_s) text += RegionTruthRow(seen.At(time_s));
  return text;
}

}  // namespace kestrel
