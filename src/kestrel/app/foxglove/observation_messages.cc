// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/observation_messages.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "kestrel/io/ros_messages/camera_info.h"

namespace kestrel {
namespace {

constexpr foxglove::Color kGreen{.r = 0.2, .g = 0.9, .b = 0.2};
constexpr foxglove::Color kBlue{.r = 0.3, .g = 0.6, .b = 1};
constexpr foxglove::Color kRed{.r = 1, .g = 0.2, .b = 0.2};
constexpr foxglove::Color kWhite{.r = 1, .g = 1, .b = 1};
constexpr foxglove::Color kShade{.a = 0.5};
constexpr foxglove::Color kNoColor{.a = 0};
constexpr double kOpacity = 0.35;  // for uncertainties
constexpr double kLine_px = 2;
constexpr double kText_px = 14;
constexpr double kSigmas = 2;
constexpr Duration kSceneLifetime = std::chrono::seconds(1);

foxglove::Vector3 VectorOf(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

foxglove::Point3 PointOf(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

// In viewers 0 is the corner of the first pixel, in Kestrel it is the centre.
foxglove::Point2 PixelOf(double u_px, double v_px) { return {u_px + 0.5, v_px + 0.5}; }

template <class Matrix>
std::vector<double> RowByRow(const Matrix& matrix) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      numbers.push_back(matrix(row, column));
    }
  }
  return numbers;
}

const foxglove::Color& ColorOf(OverlayLayer layer) {
  switch (layer) {
    case OverlayLayer::kDetection:
      return kGreen;
    case OverlayLayer::kPrediction:
    case OverlayLayer::kTruth:
    case OverlayLayer::kSecond:
      return kBlue;
    case OverlayLayer::kRejected:
      break;
  }
  return kRed;
}

foxglove::PointsAnnotation OutlineMessage(Time time, const OverlayShape& shape) {
  foxglove::PointsAnnotation outline;
  outline.timestamp = time;
  outline.type = shape.outline.size() == 1 ? foxglove::PointsType::kPoints
                 : shape.is_closed         ? foxglove::PointsType::kLineLoop
                                           : foxglove::PointsType::kLineStrip;
  for (const cv::Point2f& point : shape.outline) {
    outline.points.push_back(PixelOf(point.x, point.y));
  }
  outline.outline_color = ColorOf(shape.layer);
  outline.fill_color = kNoColor;
  outline.thickness = kLine_px;
  return outline;
}

foxglove::TextAnnotation LabelMessage(Time time, const OverlayShape& shape) {
  foxglove::TextAnnotation label;
  label.timestamp = time;
  label.position = PixelOf(shape.outline.front().x, shape.outline.front().y);
  label.text = shape.label;
  label.font_size = kText_px;
  label.text_color = ColorOf(shape.layer);
  label.background_color = kShade;
  return label;
}

// Sets the name that the schema uses for the model, and its number of coefficients.
void SetDistortion(const CameraIntrinsics& camera, foxglove::CameraCalibration* message) {
  constexpr std::size_t kPlumbBob = 5;
  message->d = camera.distortion;
  if (camera.distortion_model == DistortionModel::kEquidistant) {
    message->distortion_model = "kannala_brandt";
    return;
  }
  const bool is_rational = camera.distortion.size() > kPlumbBob;
  message->distortion_model = is_rational ? "rational_polynomial" : "plumb_bob";
  if (!is_rational) message->d.resize(kPlumbBob);
}

foxglove::SceneEntity EntityOf(Time time, std::string id) {
  foxglove::SceneEntity entity;
  entity.timestamp = time;
  entity.frame_id = kFoxgloveWorld;
  entity.id = std::move(id);
  entity.lifetime = kSceneLifetime;
  return entity;
}

// An ellipsoid of two standard deviations around the position.
foxglove::SpherePrimitive Ellipsoid(const Eigen::Vector3d& position,
                                    const Eigen::Matrix3d& covariance, foxglove::Color color) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  Eigen::Matrix3d rotation = axes.eigenvectors();
  if (rotation.determinant() < 0) rotation.col(0) *= -1;
  const Eigen::Vector3d sigmas = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  foxglove::SpherePrimitive sphere;
  sphere.pose = FoxglovePose({Eigen::Quaterniond(rotation), position});
  sphere.size = VectorOf(2 * kSigmas * sigmas);
  sphere.color = color;
  sphere.color.a = kOpacity;
  return sphere;
}

foxglove::LinePrimitive LineOf(foxglove::LineType type, const foxglove::Color& color) {
  foxglove::LinePrimitive line;
  line.type = type;
  line.thickness = kLine_px;
  line.scale_invariant = true;
  line.color = color;
  return line;
}

foxglove::LinePrimitive RingLine(const Eigen::Vector3d& center, double radius_m) {
  constexpr int kPieces = 48;
  foxglove::LinePrimitive ring = LineOf(foxglove::LineType::kLineLoop, kGreen);
  for (int i = 0; i < kPieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPieces;
    ring.points.push_back(
        PointOf(center + radius_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)));
  }
  return ring;
}

foxglove::LinePrimitive PathLine(const TurnState& motion, const TurnNoise& noise) {
  constexpr double kStep_s = 0.25;
  constexpr int kSteps = 12;
  foxglove::LinePrimitive path = LineOf(foxglove::LineType::kLineStrip, kBlue);
  for (int i = 0; i <= kSteps; ++i) {
    path.points.push_back(PointOf(Propagate(motion, i * kStep_s, noise).position()));
  }
  return path;
}

foxglove::TextPrimitive TextAt(const Eigen::Vector3d& position, std::string text) {
  foxglove::TextPrimitive message;
  message.pose.position = VectorOf(position);
  message.billboard = true;
  message.font_size = kText_px;
  message.scale_invariant = true;
  message.color = kWhite;
  message.text = std::move(text);
  return message;
}

foxglove::Detection DetectionMessage(const TargetDetection& found,
                                     const std::optional<Eigen::Vector3d>& center_in_world) {
  foxglove::Detection message;
  message.name = ToString(found.method);
  message.probability = found.quality;
  message.center = PixelOf(found.center_px.x(), found.center_px.y());
  message.position_in_camera = VectorOf(found.camera_from_target.translation);
  message.covariance_in_camera = RowByRow(found.covariance.topLeftCorner<3, 3>());
  if (center_in_world) message.position_in_world = VectorOf(*center_in_world);
  return message;
}

foxglove::Detection DetectionMessage(const ObjectDetection& found, const ObjectModel& model,
                                     const std::optional<ObjectLocation>& in_world) {
  foxglove::Detection message;
  message.name = model.classes[found.class_index].name;
  message.probability = found.class_probability;
  message.center = PixelOf(found.center_px.x(), found.center_px.y());
  if (found.location) {
    message.position_in_camera = VectorOf(found.location->position);
    message.covariance_in_camera = RowByRow(found.location->covariance);
  }
  if (in_world) {
    message.position_in_world = VectorOf(in_world->position);
    message.covariance_in_world = RowByRow(in_world->covariance);
  }
  return message;
}

foxglove::Target TargetMessage(const TargetEstimate& target) {
  foxglove::Target message;
  message.position = VectorOf(target.motion.position());
  message.velocity = VectorOf(target.motion.velocity());
  message.heading = target.heading();
  message.turn_rate = target.motion.turn_rate();
  message.covariance = RowByRow(target.motion.covariance.topLeftCorner<6, 6>());
  return message;
}

// Returns the part of a result that all tasks have.
template <class Observation>
foxglove::FrameResult ResultOf(const Observation& observation, const ViewStatus& status) {
  foxglove::FrameResult result;
  result.timestamp = observation.time;
  result.detect_ms = 1e3 * ToSeconds(observation.detect_time);
  result.state = status.state;
  result.reason = status.reason;
  return result;
}

// The track of the target: its position, its path, and a text above it.
foxglove::SceneEntity& AddTrack(const TargetEstimate& target, const TurnNoise& noise, Time time,
                                const char* state, foxglove::SceneUpdate* scene) {
  const TurnState& motion = target.motion;
  foxglove::SceneEntity& entity = scene->entities.emplace_back(EntityOf(time, "target"));
  entity.spheres.push_back(
      Ellipsoid(motion.position(), motion.covariance.topLeftCorner<3, 3>(), kGreen));
  entity.lines.push_back(PathLine(motion, noise));
  entity.texts.push_back(
      TextAt(motion.position(), fmt::format("{} {:.1f} m/s", state, target.speed())));
  return entity;
}

}  // namespace

foxglove::CameraCalibration FoxgloveCalibration(Time time, const CameraIntrinsics& camera) {
  const CameraInfoMessage info = CameraInfoOf(camera);
  foxglove::CameraCalibration message;
  message.timestamp = time;
  message.frame_id = kFoxgloveCamera;
  message.width = info.width;
  message.height = info.height;
  SetDistortion(camera, &message);
  message.k = info.k;
  message.r = info.r;
  message.p = info.p;
  return message;
}

foxglove::FrameTransform FoxgloveTransform(Time time, const char* parent, const char* child,
                                           const RigidTransform& parent_from_child) {
  const foxglove::Pose pose = FoxglovePose(parent_from_child);
  foxglove::FrameTransform message;
  message.timestamp = time;
  message.parent_frame_id = parent;
  message.child_frame_id = child;
  message.translation = pose.position;
  message.rotation = pose.orientation;
  return message;
}

foxglove::Pose FoxglovePose(const RigidTransform& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {VectorOf(pose.translation), {q.x(), q.y(), q.z(), q.w()}};
}

foxglove::ImageAnnotations FoxgloveAnnotations(Time time, const std::vector<OverlayShape>& shapes) {
  foxglove::ImageAnnotations message;
  for (const OverlayShape& shape : shapes) {
    if (shape.outline.empty()) continue;
    message.points.push_back(OutlineMessage(time, shape));
    if (!shape.label.empty()) message.texts.push_back(LabelMessage(time, shape));
  }
  return message;
}

foxglove::SceneUpdate FoxgloveScene(const LandingView& view,
                                    const LandingObservation& observation) {
  foxglove::SceneUpdate scene;
  if (!observation.target) return scene;
  foxglove::SceneEntity& target = AddTrack(*observation.target, view.noise, observation.time,
                                           ToString(observation.track_state), &scene);
  const Eigen::Vector3d center = observation.target->motion.position();
  target.lines.insert(target.lines.begin(), RingLine(center, view.shape.radius_m()));
  return scene;
}

foxglove::SceneUpdate FoxgloveScene(const FollowView& view, const FollowObservation& observation) {
  foxglove::SceneUpdate scene;
  if (!observation.target) return scene;
  AddTrack(*observation.target, view.noise, observation.time, ToString(observation.track_state),
           &scene);
  return scene;
}

foxglove::SceneUpdate FoxgloveScene(const HuntView& view, const HuntObservation& observation) {
  foxglove::SceneUpdate scene;
  for (std::size_t i = 0; i < observation.in_world.size(); ++i) {
    const auto& location = observation.in_world[i];
    if (!location) continue;
    const std::size_t class_index = observation.report.detections[i].class_index;
    foxglove::SceneEntity& object =
        scene.entities.emplace_back(EntityOf(observation.time, fmt::format("in view {}", i)));
    object.spheres.push_back(Ellipsoid(location->position, location->covariance, kGreen));
    object.texts.push_back(TextAt(location->position, view.model.classes[class_index].name));
  }
  return scene;
}

foxglove::FrameResult FoxgloveResult(const LandingObservation& observation) {
  foxglove::FrameResult result = ResultOf(observation, LandingStatus(observation));
  if (const auto& found = observation.report.detection) {
    result.detections.push_back(DetectionMessage(*found, observation.center_in_world));
  }
  if (observation.target) result.target = TargetMessage(*observation.target);
  return result;
}

foxglove::FrameResult FoxgloveResult(const FollowObservation& observation) {
  foxglove::FrameResult result = ResultOf(observation, FollowStatus(observation));
  if (const auto& region = observation.region; region && region->state != RegionState::kLost) {
    const cv::Rect2d& box = region->box_px;
    foxglove::Detection& found = result.detections.emplace_back();
    found.name = ToString(region->state);
    found.probability = region->probability;
    found.center = PixelOf(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
    if (const auto& place = observation.place) {
      found.position_in_world = VectorOf(place->position);
      found.covariance_in_world = RowByRow(place->covariance);
    }
  }
  if (observation.target) result.target = TargetMessage(*observation.target);
  return result;
}

foxglove::FrameResult FoxgloveResult(const HuntView& view, const HuntObservation& observation) {
  foxglove::FrameResult result = ResultOf(observation, HuntStatus(observation));
  const std::vector<ObjectDetection>& detections = observation.report.detections;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const bool has_place = i < observation.in_world.size();
    result.detections.push_back(DetectionMessage(
        detections[i], view.model, has_place ? observation.in_world[i] : std::nullopt));
  }
  return result;
}

}  // namespace kestrel
