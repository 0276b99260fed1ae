// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/follow_pipeline.h"

#include <chrono>
#include <cmath>

#include "kestrel/core/base/options.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/pipeline/camera_poses.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/pipeline/standing_thing.h"
#include "kestrel/vision/pipeline/world_location.h"

namespace kestrel {
namespace {

constexpr Duration kPoseGap = std::chrono::milliseconds(500);

// Errors of the place of a box, as shares of its size: from image to image, and those that stay, as
// the tracker leaves out legs, or keeps the form of what has turned.
constexpr double kBoxNoise = 0.03, kBoxDrift = 0.1;
constexpr double kHintNoise = 0.05;  // least error of the place where a box is expected
// Least height of the camera and depression of the sight by which the distance is reckoned.
constexpr double kLeastHeight_m = 0.5, kLeastDepression = 0.02;
// Beyond it (and above the horizon) the errors of a place are not linear any more.
constexpr double kMostOfDepression = 0.3;
// A prediction that is less certain, in sizes of the region, is worth less than the image before.
constexpr double kMostOfSize = 1;

Eigen::Vector2d CenterOf(const cv::Rect2d& box) {
  return {box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)};
}

double SizeOf(const cv::Rect2d& box) { return std::sqrt(box.width * box.height); }

// The place in the image of the foot of a thing, from the middle of its box.
struct FootInImage {
  Eigen::Vector2d from_middle_px = Eigen::Vector2d::Zero();
  double sigma_px = 0;        // along that, by the shape of the thing, which is not known
  double middle_above_m = 0;  // height of its middle above the foot
};

// 'down': the world's down in the image, of any length.
FootInImage FootOf(const cv::Rect2d& box, const Eigen::Vector2d& down, double depression_rad,
                   double m_per_px) {
  constexpr double kLeastLength = 1e-6;
  if (down.norm() < kLeastLength) return {};  // straight below
  const Eigen::Vector2d along = down.normalized(), across(-along.y(), along.x());
  const Eigen::Vector2d size_m = m_per_px * Eigen::Vector2d(box.width, box.height);
  const FootBelow foot = EstimateFoot(size_m.cwiseProduct(across).norm(),
                                      size_m.cwiseProduct(along).norm(), depression_rad);
  constexpr double kLeastCosine = 0.3;
  return {foot.mean_m / m_per_px * along, foot.sigma_m / m_per_px,
          foot.mean_m / std::max(std::cos(depression_rad), kLeastCosine)};
}

}  // namespace

TargetTrackerOptions FollowPipelineOptions::Tracker() const {
  TargetTrackerOptions tracker;
  // People and cars start and stop. Larger noises hide the turn rate, without which a UAV beside a
  // car trails in its curves.
  tracker.acceleration_noise = 0.3;
  tracker.turn_noise = 0.3;
  tracker.sway_sigma_m = 0;
  tracker.max_speed_mps = 30;
  return tracker;
}

std::optional<double> FollowObservation::distance_m() const {
  if (!target || !world_from_camera) return std::nullopt;
  return (target->motion.position() - world_from_camera->translation).norm();
}

class FollowPipeline::Impl {
 public:
  Impl(const CameraCalibration& calibration, const FollowPipelineOptions& options)
      : options_(Checked(options)),
        camera_(calibration.intrinsics),
        poses_(calibration, FollowPipelineOptions::kPoseCapacity, kPoseGap, Duration::zero(),
               DurationFromSeconds(options.pose_extrapolation_s)),
        tracker_(options.Tracker()) {
    RequireFixedLens(calibration, "what is marked");
  }

  PoseStatus AddPose(const PoseSample& sample) { return poses_.Add(sample); }
  PoseStatus AddGimbal(const GimbalSample& sample) { return poses_.Add(sample); }
  void ChangeOptions(const FollowPipelineOptions& options) { options_ = Checked(options); }
  void SetGroundZero(double height_m) { ground_zero_m_ = height_m; }

  FollowObservation Mark(const cv::Mat& image, Time time, const cv::Rect2d& box) {
    const auto start = std::chrono::steady_clock::now();
    region_.Mark(image, time, box);
    is_marked_ = true;
    tracker_ = TargetTracker(options_.Tracker());
    last_.reset();
    FollowObservation seen = Begin(time);
    seen.region = RegionReport{RegionState::kFollowing, box, 1};
    seen.detect_time = std::chrono::steady_clock::now() - start;
    Locate(&seen);
    return seen;
  }

  void Unmark() { is_marked_ = false; }

  FollowObservation Process(const cv::Mat& image, Time time) {
    FollowObservation seen = Begin(time);
    if (!is_marked_) return seen;
    const auto hint = HintFor(seen);
    const auto start = std::chrono::steady_clock::now();
    seen.region = region_.Track(image, time, hint);
    seen.detect_time = std::chrono::steady_clock::now() - start;
    Locate(&seen);
    return seen;
  }

  const TargetTracker& tracker() const { return tracker_; }
  const FollowPipelineOptions& options() const { return options_; }

 private:
  FollowObservation Begin(Time time);
  std::optional<TargetEstimate> Expected(Time time) const;
  std::optional<RegionHint> HintFor(const FollowObservation& seen) const;
  void Locate(FollowObservation* seen);
  double ground_m() const { return ground_zero_m_ + options_.ground_height_m; }
  struct FootSight {
    Eigen::Vector3d in_world;  // direction, of length 1
    double shape_rad;          // standard deviation by the shape of the thing, which is not known
    double size_rad;           // of the thing
  };
  std::optional<FootSight> SightOfFoot(const RigidTransform& world_from_camera,
                                       const cv::Rect2d& box);
  double AnglePerPixel(const Eigen::Vector2d& pixel) const;
  void Place(const FootSight& foot, FollowObservation* seen);

  FollowPipelineOptions options_;
  CameraModel camera_;
  CameraPoses poses_;
  RegionTracker region_;
  bool is_marked_ = false;
  double ground_zero_m_ = 0;
  PoseUncertainty pose_uncertainty_;  // for the present frame, where it has a pose
  TargetTracker tracker_;
  std::optional<TargetEstimate> last_;  // the newest one, also when the track is lost
  Time last_time_;
  Eigen::Vector2d foot_px_ = Eigen::Vector2d::Zero();  // from the middle of the box, last seen
  double size_px_ = 0;                                 // side of the box when it was last seen
};

FollowObservation FollowPipeline::Impl::Begin(Time time) {
  FollowObservation seen;
  seen.time = time;
  if (const auto camera = poses_.At(time)) {
    seen.world_from_camera = camera->world_from_camera;
    seen.camera_from_body = camera->camera_from_body;
    pose_uncertainty_ = camera->uncertainty;
  }
  return seen;
}

// The target by the track, and where it was last when the track is lost: it may have gone on from
// there, in any direction.
std::optional<TargetEstimate> FollowPipeline::Impl::Expected(Time time) const {
  if (const auto target = tracker_.Predict(time)) return target;
  if (!last_) return std::nullopt;
  constexpr double kWalk_mps = 1;
  TargetEstimate target = *last_;
  const double speed = std::max(kWalk_mps, last_->motion.velocity().head<2>().norm());
  const double gone_m = speed * ToSeconds(time - last_time_);
  target.motion.covariance.topLeftCorner<2, 2>().diagonal().array() += 0.5 * gone_m * gone_m;
  return target;
}

// The place in the image where the target is expected. The errors that all places share are in its
// covariance, too, though they cancel here: the search becomes wider than it must be.
std::optional<RegionHint> FollowPipeline::Impl::HintFor(const FollowObservation& seen) const {
  const auto target = Expected(seen.time);
  if (!target || !seen.world_from_camera) return std::nullopt;
  const RigidTransform camera_from_world = seen.world_from_camera->Inverse();
  const Eigen::Vector3d in_camera = camera_from_world * target->motion.position();
  Eigen::Vector2d foot;
  Eigen::Matrix<double, 2, 3> by_point;
  if (camera_.Project(in_camera, &foot, &by_point) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const Eigen::Matrix<double, 2, 3> by_world =
      by_point * camera_from_world.rotation.toRotationMatrix();
  RegionHint hint{foot - foot_px_, by_world * target->motion.covariance.topLeftCorner<3, 3>() *
                                       by_world.transpose()};
  hint.covariance_px2.diagonal().array() += kHintNoise * kHintNoise * size_px_ * size_px_;
  const bool is_seen = tracker_.StateAt(seen.time) == TrackState::kTracking;
  const double sigma_px = std::sqrt(0.5 * hint.covariance_px2.trace());
  if (is_seen && sigma_px > kMostOfSize * size_px_) return std::nullopt;
  return hint;
}

void FollowPipeline::Impl::Locate(FollowObservation* seen) {
  const RegionReport& region = *seen->region;
  if (region.state == RegionState::kFollowing && seen->world_from_camera) {
    if (const auto foot = SightOfFoot(*seen->world_from_camera, region.box_px)) {
      seen->bearing = foot->in_world;
      size_px_ = SizeOf(region.box_px);
      Place(*foot, seen);
    }
  }
  seen->track_state = tracker_.StateAt(seen->time);
  seen->target = tracker_.Predict(seen->time);
  if (!seen->target) return;
  last_ = seen->target;
  last_time_ = seen->time;
}

// Returns the line of sight to where the thing in a box stands.
std::optional<FollowPipeline::Impl::FootSight> FollowPipeline::Impl::SightOfFoot(
    const RigidTransform& world_from_camera, const cv::Rect2d& box) {
  const Eigen::Vector2d middle = CenterOf(box);
  Eigen::Vector3d ray;
  if (camera_.Unproject(middle, &ray) == ProjectionStatus::kOutsideModel) return std::nullopt;
  Eigen::Vector2d center;
  Eigen::Matrix<double, 2, 3> by_point;
  if (camera_.Project(ray, &center, &by_point) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const Eigen::Vector3d down = world_from_camera.rotation.conjugate() * -Eigen::Vector3d::UnitZ();
  const double level = ray.cross(down).norm(), angle_per_px = AnglePerPixel(middle);
  const double depression = std::max(std::atan2(ray.dot(down), level), kLeastDepression);
  const double above_m = world_from_camera.translation.z() - ground_m();
  FootInImage foot;
  constexpr int kRounds = 3;  // nearer than the ground behind its middle, it is smaller
  for (int i = 0; i < kRounds; ++i) {
    const double down_m = std::max(above_m - foot.middle_above_m, kLeastHeight_m);
    const double m_per_px = down_m / std::sin(depression) * angle_per_px;
    foot = FootOf(box, by_point * down, depression, m_per_px);
  }
  foot_px_ = foot.from_middle_px;
  if (camera_.Unproject(center + foot_px_, &ray) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  return FootSight{world_from_camera.rotation * ray, foot.sigma_px * angle_per_px,
                   SizeOf(box) * angle_per_px};
}

double FollowPipeline::Impl::AnglePerPixel(const Eigen::Vector2d& pixel) const {
  Eigen::Vector3d ray, beside;
  if (camera_.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel ||
      camera_.Unproject(pixel + Eigen::Vector2d::UnitX(), &beside) ==
          ProjectionStatus::kOutsideModel) {
    return 1 / camera_.intrinsics().fx_px;
  }
  return ray.cross(beside).norm();
}

void FollowPipeline::Impl::Place(const FootSight& foot, FollowObservation* seen) {
  const RigidTransform& world_from_camera = *seen->world_from_camera;
  const auto ground = LocateByAltitude(world_from_camera.rotation.conjugate() * *seen->bearing,
                                       world_from_camera, ground_m());
  if (!ground) return;
  const Eigen::Vector3d sight = *ground - world_from_camera.translation;
  const MeasurementNoise noise = WithPose({}, pose_uncertainty_);
  const double stays_rad = std::hypot(kBoxDrift * foot.size_rad, foot.shape_rad);
  constexpr double kUnevenness_m = 0.05;
  const SightErrors own{std::hypot(Radians(noise.attitude_sigma_deg), kBoxNoise * foot.size_rad),
                        noise.pose_sigma_m, kUnevenness_m};
  const SightErrors shared{std::hypot(Radians(noise.attitude_bias_deg), stays_rad),
                           noise.pose_bias_m, options_.ground_sigma_m};
  const double depression = std::asin(std::abs(seen->bearing->z()));
  if (std::hypot(own.direction_rad, shared.direction_rad) > kMostOfDepression * depression) return;
  const TargetMeasurement measurement{.time = seen->time,
                                      .position_in_world = *ground,
                                      .covariance = GroundCovariance(sight, own),
                                      .shared_covariance = GroundCovariance(sight, shared)};
  seen->place = PlaceOnGround{*ground, measurement.covariance + measurement.shared_covariance};
  seen->fate = tracker_.Add(measurement);
}

FollowPipeline::FollowPipeline(const CameraCalibration& calibration,
                               const FollowPipelineOptions& options)
    : impl_(std::make_unique<Impl>(calibration, options)) {}
FollowPipeline::~FollowPipeline() = default;
FollowPipeline::FollowPipeline(FollowPipeline&&) noexcept = default;
FollowPipeline& FollowPipeline::operator=(FollowPipeline&&) noexcept = default;

PoseStatus FollowPipeline::AddPose(const PoseSample& sample) { return impl_->AddPose(sample); }
PoseStatus FollowPipeline::AddGimbal(const GimbalSample& sample) {
  return impl_->AddGimbal(sample);
}
void FollowPipeline::ChangeOptions(const FollowPipelineOptions& options) {
  impl_->ChangeOptions(options);
}
void FollowPipeline::SetGroundZero(double height_m) { impl_->SetGroundZero(height_m); }
FollowObservation FollowPipeline::Mark(const cv::Mat& image, Time time, const cv::Rect2d& box_px) {
  return impl_->Mark(image, time, box_px);
}
void FollowPipeline::Unmark() { impl_->Unmark(); }
FollowObservation FollowPipeline::Process(const cv::Mat& image, Time time) {
  return impl_->Process(image, time);
}
const TargetTracker& FollowPipeline::tracker() const { return impl_->tracker(); }
const FollowPipelineOptions& FollowPipeline::options() const { return impl_->options(); }

}  // namespace kestrel
