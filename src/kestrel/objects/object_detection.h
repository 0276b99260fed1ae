// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/base/time.h"
#include "kestrel/geometry/ellipse.h"
#include "kestrel/objects/color_model.h"
#include "kestrel/objects/digit_classifier.h"
#include "kestrel/objects/disc_location.h"

namespace kestrel {

enum class Completeness {
  kWhole,
  kCutOff,  // by the image's border
  kMerged,  // several objects of one colour that touch each other
};
const char* ToString(Completeness completeness);  // "whole", "cut off", "merged"

// Probability of each of the model's colours, in their order; the rest to 1 is background.
using ColorProbabilities = std::array<double, ColorModel::kMaxColors>;

// One object in one image.
struct ObjectDetection {
  std::size_t class_index = 0;  // in the model's classes
  Completeness completeness = Completeness::kWhole;
  // Where the object's origin appears: the centre of a disc or of the upper face (px). Of merged
  // objects, and of what is cut off and no disc, the centroid of what is seen.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit ray through it, camera frame
  Ellipse ellipse;                                     // by the pixels' moments
  double roundness = 0;                                // see SegmentShape
  double circularity = 0;
  int pixels = 0;
  Hsv mean_color;
  ColorProbabilities color_probabilities{};
  double class_probability = 0;            // that of the class's colour
  std::optional<DigitLikelihoods> digits;  // of cuboids
  std::optional<ObjectLocation> location;  // camera frame; not of merged objects
};

// Tests that a segment passes one after the other, and that are counted (paper, Table 3).
enum class ObjectStage { kSegmented, kSize, kRoundness, kShape, kOutline, kPosition };
inline constexpr std::size_t kObjectStageCount = 6;
const char* ToString(ObjectStage stage);

// What one image showed.
struct ObjectReport {
  std::vector<ObjectDetection> detections;
  // How many segments passed each stage; kSegmented counts them all.
  std::array<int, kObjectStageCount> passed{};
  // Time of the search and flood fill, and of the tests of shape, outline, digit and position.
  Duration segmentation_time{};
  Duration test_time{};
};

}  // namespace kestrel
