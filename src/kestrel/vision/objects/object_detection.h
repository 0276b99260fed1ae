// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/ellipse.h"
#include "kestrel/vision/objects/color/color_model.h"
#include "kestrel/vision/objects/digit_likelihoods.h"

namespace kestrel {

enum class Completeness {
  kWhole,
  kCutOff,  // by the image border; a disc of which at least half is in view
  kMerged,  // discs of one colour that touch each other
};
const char* ToString(Completeness completeness);  // "whole", "cut off", "merged"

// Probability of each of the model's colours, in their order. The rest to 1 is background.
using ColorProbabilities = std::array<double, ColorModel::kMaxColors>;

// Height of the camera above the ground, from the size of an object on it alone.
struct HeightBySize {
  double camera_height_m = 0;
  double sigma_m = 0;  // standard deviation
};

// Location of a point of an object, camera frame, m.
struct ObjectLocation {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// One object in one image.
struct ObjectDetection {
  std::size_t class_index = 0;  // index in the model's classes
  Completeness completeness = Completeness::kWhole;
  // Image of the object's origin: the centre of a disc or of an upper face (px). For merged discs,
  // the centroid of the segment.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit ray through it, camera frame
  Ellipse ellipse;                                     // from the pixels' moments
  double roundness = 0;                                // see SegmentShape
  double circularity = 0;
  int pixels = 0;
  // Sum of the squared shares of its shape's tolerances that the object uses up. 0 is perfect; 98
  // of 100 objects have less than 0.5. The size does not count.
  double misfit = 0;
  Hsv mean_color;
  ColorProbabilities color_probabilities{};
  double class_probability = 0;            // probability of the class, given colour and shape
  std::optional<DigitLikelihoods> digits;  // for cuboids only
  std::optional<ObjectLocation> location;  // camera frame; not of merged discs
  std::optional<HeightBySize> height;      // where the attitude is known; not of merged discs
};

// The tests of a segment, in order, for which the report counts passes (paper, Table 3).
enum class ObjectStage { kSegmented, kSize, kRoundness, kShape, kOutline, kPosition };
inline constexpr std::size_t kObjectStageCount =
    static_cast<std::size_t>(ObjectStage::kPosition) + 1;
const char* ToString(ObjectStage stage);

// The result of one image.
struct ObjectReport {
  std::vector<ObjectDetection> detections;
  // Objects by their shape that, by their size, are not on the ground as the hint describes it;
  // located by their size alone. Either they are no objects, or the ground is elsewhere.
  std::vector<ObjectDetection> elsewhere;
  // Number of segments that passed each stage; kSegmented counts all segments.
  std::array<int, kObjectStageCount> passed{};
  // Time of search and flood fill, and time of the tests of shape, outline, digit and position.
  Duration segmentation_time{};
  Duration test_time{};
};

}  // namespace kestrel
