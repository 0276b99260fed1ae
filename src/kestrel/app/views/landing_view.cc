// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/views/landing_view.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/app/views/map_view.h"
#include "kestrel/vision/landing/search/threshold_view.h"
#include "kestrel/vision/target/closed_lines.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kSigmas = 2;

// Projects a point (m) to its pixel; false when the lens does not show it.
using Projection = std::function<bool(const Eigen::Vector3d& point, Eigen::Vector2d* pixel)>;

std::optional<cv::Point2f> PixelOf(const Eigen::Vector3d& point, const Projection& project) {
  Eigen::Vector2d pixel;
  if (!project(point, &pixel) || !pixel.allFinite()) return std::nullopt;
  return cv::Point2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
}

Projection ByPose(const CameraModel& camera, const RigidTransform& camera_from_points) {
  return [&camera, camera_from_points](const Eigen::Vector3d& point, Eigen::Vector2d* pixel) {
    return camera.Project(camera_from_points * point, pixel) != ProjectionStatus::kOutsideModel;
  };
}

Projection AsSeen(const PlaneWarp& warp) {
  return [&](const Eigen::Vector3d& point, Eigen::Vector2d* pixel) {
    return warp.Project(point.head<2>(), pixel);
  };
}

// Adds a closed line in the image, where the lens shows it: nothing is drawn across what it does
// not show. The first piece takes the label.
void AddClosedLine(const std::vector<Eigen::Vector3d>& points, const Projection& project,
                   OverlayLayer layer, std::string* label, std::vector<OverlayShape>* shapes) {
  std::vector<std::optional<cv::Point2f>> line;
  for (const Eigen::Vector3d& point : points) line.push_back(PixelOf(point, project));
  const auto gap = std::find(line.begin(), line.end(), std::nullopt);
  const bool is_closed = gap == line.end();
  // A line with gaps begins after one of them; each piece ends before the next.
  if (!is_closed) std::rotate(line.begin(), gap, line.end());
  std::vector<cv::Point2f> piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) {
      shapes->push_back({layer, std::exchange(piece, {}), std::exchange(*label, {}), is_closed});
    }
    piece.clear();
  };
  for (const auto& point : line) {
    if (point) piece.push_back(*point);
    if (!point) end_piece();
  }
  end_piece();
}

// Adds the outlines of the pad; the first one has the label.
void AddOutlines(const TargetShape& pad, const Projection& project, OverlayLayer layer,
                 std::string label, std::vector<OverlayShape>* shapes) {
  for (const std::vector<Eigen::Vector3d>& line : pad.outlines) {
    AddClosedLine(line, project, layer, &label, shapes);
  }
}

// Returns the ellipse around the track's centre, in the world.
std::vector<Eigen::Vector3d> TrackEllipse(const TurnState& motion) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      motion.covariance.topLeftCorner<2, 2>());
  const Eigen::Matrix2d root =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector3d> ellipse = CircleLine(kSigmas);
  for (Eigen::Vector3d& point : ellipse) {
    const Eigen::Vector2d offset = root * point.head<2>();
    point = motion.position();
    point.head<2>() += offset;
  }
  return ellipse;
}

// The recognised parts of the pattern.
const char* InWords(DetectionMethod method) {
  switch (method) {
    case DetectionMethod::kRing:
      return "whole pattern";
    case DetectionMethod::kPartial:
      return "part of the pattern";
    case DetectionMethod::kTags:
      return "pad, by its tags";
    case DetectionMethod::kLetter:
      return "pad, by its letter";
    case DetectionMethod::kFollowed:
      return "pad, by its appearance";
    case DetectionMethod::kOther:
      return "pad";
  }
  return "";
}

std::string InWords(const TargetDetection& found) {
  return found.id ? fmt::format("{}, id {}", InWords(found.method), *found.id)
                  : InWords(found.method);
}

std::string MisfitInWords(const TargetDetection& detection) {
  if (detection.diagnostics.misfit_px == 0) return "";
  return fmt::format(
      "{:.2f} px{}", detection.diagnostics.misfit_px,
      detection.diagnostics.is_misfit()
          ? fmt::format(", at most {:.2f} expected", detection.diagnostics.misfit_bound_px)
          : "");
}

ViewMapObject MapObject(const std::string& label, const TurnState& motion) {
  return {.label = label,
          .color = "",
          .position = motion.position().head<2>(),
          .covariance = motion.covariance.topLeftCorner<2, 2>()};
}

}  // namespace

LandingView ViewOf(const CameraCalibration& calibration, const LandingPipelineOptions& options) {
  return {CameraModel(calibration.intrinsics), ShapeOfTarget(options.target, options.detector),
          options.tracker.Noise()};
}

std::vector<SeriesDescription> LandingSeries() {
  using enum ValueSource;
  return {{"height", "m", "Camera height", {kFrames, kPose}},
          {"offset", "m", "Camera offset", {kFrames, kPose}},
          {"speed", "m/s", "Target's speed", {kFrames, kPose}},
          {"quality", "", "Quality", {kFrames}},
          {"detect", "ms", "Detection", {kFrames}}};
}

ViewSample LandingSample(const LandingObservation& observation) {
  ViewSample sample{observation.time, std::vector<double>(LandingSeries().size(), kUnknown)};
  if (observation.target && observation.world_from_camera) {
    const Eigen::Vector3d offset =
        observation.world_from_camera->translation - observation.target->motion.position();
    sample.values[0] = offset.z();
    sample.values[1] = offset.head<2>().norm();
  }
  if (observation.target) sample.values[2] = observation.target->speed();
  if (observation.report.detection) sample.values[3] = observation.report.detection->quality;
  sample.values[4] = 1e3 * ToSeconds(observation.detect_time);
  return sample;
}

std::vector<OverlayLayer> LandingLayers() {
  return {OverlayLayer::kDetection, OverlayLayer::kPrediction, OverlayLayer::kRejected};
}

std::vector<OverlayShape> LandingShapes(const LandingView& view,
                                        const LandingObservation& observation) {
  std::vector<OverlayShape> shapes;
  const CameraModel& camera = observation.zoomed_lens ? *observation.zoomed_lens : view.camera;
  if (observation.target && observation.world_from_camera && !observation.is_zooming) {
    std::string no_label;
    AddClosedLine(TrackEllipse(observation.target->motion),
                  ByPose(camera, observation.world_from_camera->Inverse()),
                  OverlayLayer::kPrediction, &no_label, &shapes);
  }
  if (!observation.report.detection) return shapes;
  const TargetDetection& found = *observation.report.detection;
  const bool is_rejected = observation.fate == MeasurementFate::kFarFromTrack;
  const OverlayLayer layer = is_rejected ? OverlayLayer::kRejected : OverlayLayer::kDetection;
  const std::string label = fmt::format("{}, {:.0f} %{}", InWords(found), 100 * found.quality,
                                        is_rejected ? ", far from the track" : "");
  const bool is_seen_elsewhere = found.diagnostics.is_misfit() && found.diagnostics.seen;
  if (is_seen_elsewhere) {
    const PlaneWarp warp = found.diagnostics.seen->Warp(camera);
    AddOutlines(view.shape, AsSeen(warp), layer, label + ", as seen", &shapes);
  }
  AddOutlines(view.shape, ByPose(camera, found.camera_from_target),
              is_seen_elsewhere ? OverlayLayer::kRejected : layer,
              is_seen_elsewhere
                  ? fmt::format("by the calibration: {:.1f} px beside", found.diagnostics.misfit_px)
                  : label,
              &shapes);
  shapes.push_back(
      {layer,
       {{static_cast<float>(found.center_px.x()), static_cast<float>(found.center_px.y())}},
       ""});
  return shapes;
}

std::vector<ImageView> LandingImageViews() {
  const auto view = std::make_shared<ThresholdView>();
  std::vector<ImageView> views;
  for (const int level : {3, 2, 1, 0}) {
    views.push_back(
        {fmt::format("threshold 1/{}", 1 << level), [view, level](const cv::Mat& image) {
           cv::Mat gray = image;
           if (image.channels() == 3) cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
           return view->Draw(gray, level);
         }});
  }
  return views;
}

ViewStatus LandingStatus(const LandingObservation& observation) {
  const TargetReport& report = observation.report;
  ViewStatus status;
  status.state = ToString(observation.track_state);
  // One sighting is no track yet.
  if (report.detection && observation.track_state == TrackState::kSearching) status.state = "found";
  if (!report.detection) {
    status.reason = "not found: " + MissInWords(observation);
  } else if (observation.fate == MeasurementFate::kFarFromTrack) {
    status.reason = "found, but far from where the track has it";
  } else if (report.detection->diagnostics.is_misfit()) {
    status.reason =
        fmt::format("found, but {:.1f} px beside where the calibration has it: is it this lens's?",
                    report.detection->diagnostics.misfit_px);
  } else if (!observation.world_from_camera) {
    status.reason = "found, but where the UAV was is not known";
  }
  return status;
}

std::vector<ViewFact> LandingFacts(const LandingObservation& observation) {
  const auto& detection = observation.report.detection;
  if (!detection)
    return {{"found", "no, " + MissInWords(observation)},
            {"method", ""},
            {"quality", ""},
            {"misfit", ""}};
  const bool is_far = observation.fate == MeasurementFate::kFarFromTrack;
  return {{"found", is_far ? "yes, but far from the track" : "yes"},
          {"method", InWords(*detection)},
          {"quality", fmt::format("{:.2f}", detection->quality)},
          {"misfit", MisfitInWords(*detection)}};
}

ViewMap LandingMap(const LandingView& view, const LandingObservation& observation) {
  ViewMap map;
  PlaceUav(observation.world_from_camera, &map);
  if (!observation.target) return map;
  const TurnState& motion = observation.target->motion;
  map.target = MapObject("target", motion);
  map.target_velocity = motion.velocity().head<2>();
  for (const int seconds : {1, 2, 3}) {
    map.prediction.push_back(
        MapObject(fmt::format("+{} s", seconds), Propagate(motion, seconds, view.noise)));
  }
  return map;
}

}  // namespace kestrel
