// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/objects/object_detection.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

class ColorGrid;

struct ObjectDetectorOptions {
  // Largest root mean square distance of a disc's edge points from their cone: a share of the
  // shorter semi-axis, plus an allowance for blur and noise. The points of a square lie 0.075 of it
  // away.
  static constexpr double kOutlineTolerance = 0.03;
  static constexpr double kOutlineTolerance_px = 0.3;
  // As max_gap, for a disc that the image border cuts off; largest share that may be out of view;
  // least share of the rest that must fit. A polygon does not fit at its corners, which lie all
  // around.
  static constexpr double kMaxCutOffGap = 0.1;
  static constexpr double kMaxOutside = 0.5;
  static constexpr double kMinOutlineShare = 0.7;
  // Constant part of the deviation that 'ground_tolerance' allows.
  static constexpr double kGroundTolerance_m = 0.15;
  // Standard deviations of a location: across the line of sight, and of the radius in the image.
  static constexpr double kCenterSigma_px = 0.3;
  static constexpr double kRadiusSigma_px = 0.15;

  int min_pixels = 30;
  double max_roundness_error = 1.2;
  double max_circularity_error = 0.07;
  double max_gap = 0.35;
  double ground_tolerance = 0.22;
  int track_radius_px = 60;

  static void Visit(auto& self, auto&& visit) {
    visit("min_pixels", self.min_pixels, AtLeast(5),
          "[px] size of the smallest segment that is not noise");
    visit("max_roundness_error", self.max_roundness_error, MoreThan(0), "largest |roundness - 1|");
    visit("max_circularity_error", self.max_circularity_error, MoreThan(0),
          "largest |circularity - 1| of a disc");
    visit("max_gap", self.max_gap, Range{0, 1, true, false},
          "share of a disc's outline that may be hidden");
    visit("ground_tolerance", self.ground_tolerance, MoreThan(0),
          "deviation of size and distance from those of an object on the ground, share");
    visit("track_radius_px", self.track_radius_px, AtLeast(0),
          "radius around the last place of a followed object in which it is searched for");
    visit.Gone({"outline_tolerance", "outline_tolerance_px", "max_cut_off_gap", "max_outside",
                "min_outline_share", "ground_tolerance_m", "center_sigma_px", "radius_sigma_px"});
  }
};

// An object to be followed, with its expected position in the image.
struct TrackedObject {
  Eigen::Vector2d expected_px = Eigen::Vector2d::Zero();
  std::size_t class_index = 0;
};

// Prior knowledge about an image. Everything is optional. An object whose size contradicts its
// position on the ground is reported in ObjectReport::elsewhere.
struct ObjectHint {
  // If not empty, mode `track`: only these objects are searched, around their expected positions.
  std::span<const TrackedObject> track;
  std::optional<Eigen::Vector3d> up_in_camera;  // unit vector, upwards
  std::optional<double> camera_height_m;  // above the ground, m; used together with 'up_in_camera'
  // Standard deviations of 'up_in_camera' (rad) and of the height including the ground's unevenness
  // (m). They weigh the distance by height against the distance by size.
  double up_sigma_rad = 0.02;
  double height_sigma_m = 0.1;
};

// Memory of one thread's detections. It keeps its size from frame to frame.
class ObjectWorkspace {
 public:
  ObjectWorkspace();
  ~ObjectWorkspace();
  ObjectWorkspace(ObjectWorkspace&&) noexcept;
  ObjectWorkspace& operator=(ObjectWorkspace&&) noexcept;

  struct Buffers;  // memory of ObjectExaminer

 private:
  friend class ObjectDetector;
  std::unique_ptr<Buffers> buffers_;
};

// Finds the configured objects in a colour image of a camera that looks down (paper, section 3).
// Immutable and thread-safe, with a workspace and a report for each thread.
class ObjectDetector {
 public:
  // Throws InputError when the model or the options are invalid, or the image is too large.
  ObjectDetector(const CameraModel& camera, const ObjectModel& model,
                 const ObjectDetectorOptions& options = {});
  // Uses a grid that may differ from the model's own (edited, or from the authors).
  ObjectDetector(const CameraModel& camera, const ObjectModel& model, const ColorGrid& grid,
                 const ObjectDetectorOptions& options = {});
  ~ObjectDetector();
  ObjectDetector(ObjectDetector&&) noexcept;
  ObjectDetector& operator=(ObjectDetector&&) noexcept;

  // Searches one image. 'image': CV_8UC3 of the camera's size. Overwrites the report. Does not
  // throw, and does not allocate once workspace and report have their size.
  void Detect(const cv::Mat& image, const ObjectHint& hint, ObjectWorkspace& workspace,
              ObjectReport* report) const;

  const CameraModel& camera() const;
  const ObjectModel& model() const;
  const ColorGrid& grid() const;
  const ObjectDetectorOptions& options() const;

  struct Impl;  // what ObjectExaminer reads

 private:
  std::unique_ptr<const Impl> impl_;
};

}  // namespace kestrel
