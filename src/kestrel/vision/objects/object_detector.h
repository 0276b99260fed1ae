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

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/objects/object_detection.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

class ColorGrid;

struct ObjectDetectorOptions {
  // Segments of fewer pixels are noise. Also determines the step of the search, see SearchStep.
  int min_pixels = 30;
  // Largest |roundness - 1| (paper, eq. 7). An oblique ellipse with axes 3 : 1 has 0.7.
  double max_roundness_error = 1.2;
  // Largest |circularity - 1| of a disc (paper, eq. 12). A square has 0.05, and so does a disc of
  // 50 px half in a shadow. Squares are therefore distinguished by their outline.
  double max_circularity_error = 0.07;
  // Largest root mean square distance of a disc's edge points from their cone: a share of the
  // shorter semi-axis, plus an allowance for blur and noise. The points of a square lie 0.075 of it
  // away.
  double outline_tolerance = 0.03;
  double outline_tolerance_px = 0.3;
  // Largest share of a disc's outline that one object may hide, for a whole disc and for one that
  // the image border cuts off; largest share that may be out of view; least share of the rest that
  // must fit. A polygon does not fit at its corners, which lie all around.
  double max_gap = 0.35;
  double max_cut_off_gap = 0.1;
  double max_outside = 0.5;
  double min_outline_share = 0.7;
  // With known attitude and height: tolerance of an object's distance, and of the axes of its
  // image, against those of an object on the ground. A share plus a constant in metres.
  double ground_tolerance = 0.22;
  double ground_tolerance_m = 0.15;
  // Standard deviations of a location: across the line of sight (px), and of the radius in the
  // image (px).
  double center_sigma_px = 0.3;
  double radius_sigma_px = 0.15;
  // Mode `track`: radius of the search around an object's expected position.
  int track_radius_px = 60;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("min_pixels", self.min_pixels, "px", "size of the smallest segment that is not noise");
    visitor("max_roundness_error", self.max_roundness_error, "1", "largest |roundness - 1|");
    visitor("max_circularity_error", self.max_circularity_error, "1",
            "largest |circularity - 1| of a disc");
    visitor("outline_tolerance", self.outline_tolerance, "1",
            "distance of a disc's edge from an ellipse, share of the shorter semi-axis");
    visitor("outline_tolerance_px", self.outline_tolerance_px, "px",
            "constant part of that distance, added to outline_tolerance");
    visitor("max_gap", self.max_gap, "1", "share of a disc's outline that may be hidden");
    visitor("max_cut_off_gap", self.max_cut_off_gap, "1",
            "share of the outline that may be hidden where the image's border cuts the disc off");
    visitor("max_outside", self.max_outside, "1",
            "share of a disc that may be outside of the image");
    visitor("min_outline_share", self.min_outline_share, "1",
            "share of the visible outline that must fit the ellipse");
    visitor("ground_tolerance", self.ground_tolerance, "1",
            "deviation of size and distance from those of an object on the ground, share");
    visitor("ground_tolerance_m", self.ground_tolerance_m, "m",
            "constant part of that deviation, added to ground_tolerance");
    visitor("center_sigma_px", self.center_sigma_px, "px", "standard deviation of a centre");
    visitor("radius_sigma_px", self.radius_sigma_px, "px", "standard deviation of a radius");
    visitor("track_radius_px", self.track_radius_px, "px",
            "radius around the last place of a followed object in which it is searched for");
  }
  std::vector<std::string> Validate() const;
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

  struct Buffers;  // of ObjectExaminer

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
