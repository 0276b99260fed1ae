// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/examination/object_examiner.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/vision/objects/location/disc_location.h"

namespace kestrel {
namespace {

// Log density of a colour that is none of the model's: uniform over the colours.
constexpr double kBackgroundLogDensity = -8;

// Naive Bayes with equal priors (paper, section 3.6 for scores, 3.2 for colours).
ColorProbabilities ProbabilitiesOf(const ColorModel& model, const Hsv& color) {
  ColorProbabilities probabilities{};
  double best = kBackgroundLogDensity;
  for (const ColorMixture& mixture : model.colors) {
    best = std::max(best, mixture.LogLikelihood(color));
  }
  double total = std::exp(kBackgroundLogDensity - best);
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    probabilities[i] = std::exp(model.colors[i].LogLikelihood(color) - best);
    total += probabilities[i];
  }
  for (double& p : probabilities) p /= total;
  return probabilities;
}

}  // namespace

bool ObjectExaminer::Run(const Segment& segment) {
  const ObjectDetectorOptions& options = detector_.options;
  const auto count = [&](ObjectStage stage) { ++report_->passed[static_cast<int>(stage)]; };
  count(ObjectStage::kSegmented);
  if (static_cast<int>(segment.pixels.size()) < options.min_pixels) return false;
  count(ObjectStage::kSize);
  const SegmentShape shape = MeasureShape(image_, segment);
  ObjectDetection detection;
  detection.ellipse = shape.ellipse;
  detection.roundness = shape.roundness;
  detection.circularity = shape.circularity;
  detection.pixels = static_cast<int>(segment.pixels.size());
  detection.mean_color = shape.mean_color;
  detection.color_probabilities = ProbabilitiesOf(detector_.model.colors, shape.mean_color);
  detection.center_px = shape.moments.centroid;
  detection.bearing = RayAt(detection.center_px);

  ObjectStage furthest = ObjectStage::kSize;
  Outcome outcome = Outcome::kNone;
  ObjectDetection found;
  const auto& classes = detector_.model.classes;
  for (std::size_t i = 0; i < classes.size() && outcome != Outcome::kObject; ++i) {
    if (classes[i].color + 1 != segment.label) continue;
    ObjectStage reached = ObjectStage::kSize;
    ObjectDetection candidate = detection;
    const Outcome tested = TestClass(segment, shape, i, &candidate, &reached);
    furthest = std::max(furthest, reached);
    if (tested <= outcome) continue;
    outcome = tested;
    found = candidate;
  }
  for (int stage = static_cast<int>(ObjectStage::kRoundness); stage <= static_cast<int>(furthest);
       ++stage) {
    ++report_->passed[stage];
  }
  if (outcome == Outcome::kNone && TestMerged(segment, shape, &detection)) {
    outcome = Outcome::kObject;
    found = detection;
  }
  if (outcome == Outcome::kObject) report_->detections.push_back(found);
  if (outcome == Outcome::kElsewhere) report_->elsewhere.push_back(found);
  return outcome == Outcome::kObject;
}

ObjectExaminer::Outcome ObjectExaminer::TestClass(const Segment& segment, const SegmentShape& shape,
                                                  std::size_t class_index,
                                                  ObjectDetection* detection,
                                                  ObjectStage* reached) {
  const ObjectClass& object = detector_.model.classes[class_index];
  detection->class_index = class_index;
  detection->class_probability = ClassProbability(object, detection->color_probabilities);
  detection->completeness = segment.touches_border ? Completeness::kCutOff : Completeness::kWhole;
  const bool is_round = std::abs(shape.roundness - 1) <= detector_.options.max_roundness_error;
  if (object.shape != ObjectShape::kBar && !is_round) return Outcome::kNone;
  *reached = ObjectStage::kRoundness;
  switch (object.shape) {
    case ObjectShape::kDisc:
      return TestDisc(segment, shape, object, detection, reached);
    case ObjectShape::kCuboid:
      return TestCuboid(segment, object, detection, reached);
    case ObjectShape::kBar:
      return TestBar(segment, shape, object, detection, reached);
  }
  return Outcome::kNone;
}

std::optional<ColorLabel> ObjectExaminer::LabelAt(const Eigen::Vector2d& pixel) const {
  const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
  if (!cv::Rect({}, image_.size()).contains(at)) return std::nullopt;
  return detector_.grid.At(image_.ptr(at.y) + 3 * at.x);
}

double ObjectExaminer::ClassProbability(const ObjectClass& object,
                                        const ColorProbabilities& colors) const {
  double all = 1;  // including the probability of background
  for (std::size_t i = 0; i < detector_.model.colors.colors.size(); ++i) {
    const bool has_class = std::ranges::any_of(
        detector_.model.classes,
        [&](const ObjectClass& other) { return other.color == i && other.shape == object.shape; });
    if (!has_class) all -= colors[i];
  }
  return colors[object.color] / all;
}

std::optional<double> ObjectExaminer::DistanceOnGround(const Eigen::Vector3d& position,
                                                       const ObjectClass& object) const {
  const double distance = position.norm();
  return Ground().DistanceNear(position / distance, distance, object.height_m, object.max_height_m);
}

std::optional<bool> ObjectExaminer::IsOnGround(const Eigen::Vector3d& position,
                                               const ObjectClass& object, double tolerance) const {
  if (!Ground().is_known()) return std::nullopt;
  const auto on_ground = DistanceOnGround(position, object);
  return on_ground && std::abs(position.norm() - *on_ground) <=
                          tolerance * *on_ground + ObjectDetectorOptions::kGroundTolerance_m;
}

void ObjectExaminer::SetLocation(const Eigen::Vector3d& by_size, const ObjectClass& object,
                                 double center_sigma_px, double relative_sigma, Outcome outcome,
                                 ObjectDetection* detection) const {
  const Eigen::Vector3d ray = by_size.normalized();
  double distance = by_size.norm();
  double sigma_m = relative_sigma * distance;
  if (hint_.up_in_camera) {
    const double descent = -hint_.up_in_camera->dot(ray);
    detection->height = {
        distance * descent + 0.5 * (object.height_m + object.max_height_m),
        std::hypot(sigma_m * descent, 0.5 * (object.max_height_m - object.height_m))};
  }
  const auto on_ground = DistanceOnGround(by_size, object);
  if (on_ground && outcome == Outcome::kObject) {
    const double ground_sigma_m = Ground().DistanceSigma(ray, *on_ground);
    const double total = std::hypot(sigma_m, ground_sigma_m);
    const double gain = sigma_m * sigma_m / (total * total);
    distance += gain * (*on_ground - distance);
    sigma_m *= ground_sigma_m / total;
  }
  detection->bearing = ray;
  detector_.camera.Project(ray, &detection->center_px);
  detection->location = {
      distance * ray,
      LocationCovariance(distance * ray, center_sigma_px / detector_.focal_px, sigma_m / distance)};
}

Eigen::Vector3d ObjectExaminer::RayAt(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2f at = pixel.cast<float>();
  return detector_.rays.Ray(at.x(), at.y()).cast<double>();
}

}  // namespace kestrel
