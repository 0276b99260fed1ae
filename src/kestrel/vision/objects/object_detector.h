// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/vision/objects/color_grid.h"
#include "kestrel/vision/objects/cuboid_face.h"
#include "kestrel/vision/objects/digit_classifier.h"
#include "kestrel/vision/objects/disc_outline.h"
#include "kestrel/vision/objects/object_detection.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/objects/segment_border.h"
#include "kestrel/vision/objects/segmentation.h"

namespace kestrel {

struct ObjectDetectorOptions {
  // Segments of fewer pixels are noise. Sets how closely the image is searched, see SearchStep.
  int min_pixels = 30;
  // Largest |roundness - 1| (paper, eq. 7). An ellipse of axes 3 : 1 that lies oblique has 0.7.
  double max_roundness_error = 1.2;
  // Largest |circularity - 1| of a disc (paper, eq. 12). A square has 0.05, but a disc of 50 px,
  // half of it in a shadow, has as much: squares are told apart by their outline.
  double max_circularity_error = 0.07;
  // How far the edge points of a disc may lie from their cone (root of the mean square): share of
  // the shorter semi-axis, and what blur and noise add. Those of a square lie 0.075 of it away.
  double outline_tolerance = 0.03;
  double outline_tolerance_px = 0.3;
  // Longest part of a disc's outline that something may hide, of a whole disc and of one that the
  // image's border cuts off, the share that may lie outside of the image, and the share of the rest
  // that must fit. A polygon does not fit at its corners, which are all around.
  double max_gap = 0.35;
  double max_cut_off_gap = 0.1;
  double max_outside = 0.5;
  double min_outline_share = 0.7;
  // With known attitude and height: how far an object's distance, and the axes of its image, may be
  // from those of an object on the ground. Shares, and metres that are always forgiven.
  double ground_tolerance = 0.22;
  double ground_tolerance_m = 0.15;
  // Standard deviations of a location: across the line of sight (px), and of the radius seen (px).
  double center_sigma_px = 0.3;
  double radius_sigma_px = 0.15;
  // Mode `track`: how far from its last place an object is looked for.
  int track_radius_px = 60;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("min_pixels", self.min_pixels, "px", "smaller segments are noise");
    visitor("max_roundness_error", self.max_roundness_error, "1", "largest |roundness - 1|");
    visitor("max_circularity_error", self.max_circularity_error, "1",
            "largest |circularity - 1| of a disc");
    visitor("outline_tolerance", self.outline_tolerance, "1",
            "edge of a disc: distance from an ellipse, share of the shorter semi-axis");
    visitor("outline_tolerance_px", self.outline_tolerance_px, "px", "added to that");
    visitor("max_gap", self.max_gap, "1", "share of a disc's outline that may be hidden");
    visitor("max_cut_off_gap", self.max_cut_off_gap, "1",
            "the same where the image's border cuts it off");
    visitor("max_outside", self.max_outside, "1", "share of it that may be outside of the image");
    visitor("min_outline_share", self.min_outline_share, "1",
            "share of the rest of its outline that must fit");
    visitor("ground_tolerance", self.ground_tolerance, "1",
            "how far size and distance may be from those of an object on the ground, share");
    visitor("ground_tolerance_m", self.ground_tolerance_m, "m", "the same, always forgiven");
    visitor("center_sigma_px", self.center_sigma_px, "px", "standard deviation of a centre");
    visitor("radius_sigma_px", self.radius_sigma_px, "px", "standard deviation of a radius");
    visitor("track_radius_px", self.track_radius_px, "px",
            "tracking: how far from its last place an object is looked for");
  }
  std::vector<std::string> Validate() const;
};

// An object to be followed: where it should be in the image.
struct TrackedObject {
  Eigen::Vector2d expected_px = Eigen::Vector2d::Zero();
  std::size_t class_index = 0;
};

// What is known before the image is looked at. Nothing of it is needed. An object whose size says
// that it is not on the ground is reported apart, see ObjectReport::elsewhere.
struct ObjectHint {
  // Mode `track` when there are any: only these are looked for, around where they should be.
  std::span<const TrackedObject> track;
  std::optional<Eigen::Vector3d> up_in_camera;  // unit vector, upwards
  std::optional<double> camera_height_m;        // above the ground; used together with 'up'
  // Standard deviations of 'up' (rad) and of the height with the ground's own unevenness (m): what
  // the height says of an object's distance is weighed against what its size says.
  double up_sigma_rad = 0.02;
  double height_sigma_m = 0.1;
};

// Memory of ObjectDetector::Detect; keeps its size from frame to frame.
struct ObjectWorkspace {
  SegmentationWorkspace segmentation;
  DiscOutlineWorkspace outline;
  CuboidFaceWorkspace face;
  SegmentBorder border;
  std::vector<Eigen::Vector2d> inside;  // of the segment's pixels, on the ground
};

// Finds the configured objects in a colour image of a camera that looks down (paper, section 3).
// Immutable and thread-safe, with a workspace and a report for every thread.
class ObjectDetector {
 public:
  // Throws InputError when the model or the options are not valid, or the image is too large.
  ObjectDetector(const CameraModel& camera, const ObjectModel& model,
                 const ObjectDetectorOptions& options = {});
  // With a grid that need not be the model's own (edited, or the authors').
  ObjectDetector(const CameraModel& camera, const ObjectModel& model, const ColorGrid& grid,
                 const ObjectDetectorOptions& options = {});

  // 'image': CV_8UC3 of the camera's size. Overwrites the report; neither throws nor, once
  // workspace and report have their size, allocates.
  void Detect(const cv::Mat& image, const ObjectHint& hint, ObjectWorkspace& workspace,
              ObjectReport* report) const;

  const CameraModel& camera() const { return camera_; }
  const ObjectModel& model() const { return model_; }
  const ColorGrid& grid() const { return grid_; }
  const ObjectDetectorOptions& options() const { return options_; }

 private:
  friend class ObjectExaminer;

  CameraModel camera_;
  RayTable rays_;
  ObjectModel model_;
  ColorGrid grid_;
  ObjectDetectorOptions options_;
  DigitClassifier digits_;
  double focal_px_;
  int search_step_;
  // By label: whether a class of this colour is a cuboid, whose digit is white.
  std::array<bool, 256> has_digit_{};
};

}  // namespace kestrel
