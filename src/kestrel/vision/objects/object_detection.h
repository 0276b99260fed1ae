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
#include "kestrel/vision/objects/color_model.h"
#include "kestrel/vision/objects/digit_classifier.h"
#include "kestrel/vision/objects/disc_location.h"

namespace kestrel {

enum class Completeness {
  kWhole,
  kCutOff,  // by the image's border: a disc of which at least a half is in view
  kMerged,  // discs of one colour that touch each other
};
const char* ToString(Completeness completeness);  // "whole", "cut off", "merged"

// Probability of each of the model's colours, in their order; the rest to 1 is background.
using ColorProbabilities = std::array<double, ColorModel::kMaxColors>;

// How high the camera is above the ground, by nothing but the size of an object that lies on it.
struct HeightBySize {
  double camera_height_m = 0;
  double sigma_m = 0;  // standard deviation
};

// One object in one image.
struct ObjectDetection {
  std::size_t class_index = 0;  // in the model's classes
  Completeness completeness = Completeness::kWhole;
  // Where the object's origin appears: the centre of a disc or of the upper face (px). Of merged
  // discs the centroid of what is seen.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit ray through it, camera frame
  Ellipse ellipse;                                     // by the pixels' moments
  double roundness = 0;                                // see SegmentShape
  double circularity = 0;
  int pixels = 0;
  // The shares of the tolerances of its shape that it uses up, squared and added: 0 is perfect, 98
  // of 100 objects have less than 0.5. The size has no part in it.
  double misfit = 0;
  Hsv mean_color;
  ColorProbabilities color_probabilities{};
  double class_probability = 0;            // of the class, given the colour and the shape
  std::optional<DigitLikelihoods> digits;  // of cuboids
  std::optional<ObjectLocation> location;  // camera frame; not of merged discs
  std::optional<HeightBySize> height;      // where the attitude is known; not of merged discs
};

// Tests that a segment passes one after the other, and that are counted (paper, Table 3).
enum class ObjectStage { kSegmented, kSize, kRoundness, kShape, kOutline, kPosition };
inline constexpr std::size_t kObjectStageCount = 6;
const char* ToString(ObjectStage stage);

// What one image showed.
struct ObjectReport {
  std::vector<ObjectDetection> detections;
  // What has the shape of an object but by its size is not on the ground where the hint has it,
  // located by its size alone: it is no object, or the ground is elsewhere.
  std::vector<ObjectDetection> elsewhere;
  // How many segments passed each stage; kSegmented counts them all.
  std::array<int, kObjectStageCount> passed{};
  // Time of the search and flood fill, and of the tests of shape, outline, digit and position.
  Duration segmentation_time{};
  Duration test_time{};
};

}  // namespace kestrel
