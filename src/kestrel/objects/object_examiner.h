// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/objects/cuboid_face.h"
#include "kestrel/objects/ground_plane.h"
#include "kestrel/objects/object_detector.h"
#include "kestrel/objects/segment_shape.h"

namespace kestrel {

// The tests that a segment of an image goes through on its way to a detection.
class ObjectExaminer {
 public:
  ObjectExaminer(const ObjectDetector& detector, const cv::Mat& image, const ObjectHint& hint,
                 ObjectWorkspace* workspace, ObjectReport* report)
      : detector_(detector), image_(image), hint_(hint), workspace_(workspace), report_(report) {}

  // Adds a detection to the report when the segment is an object of one of the classes; true then.
  bool Run(const Segment& segment);

 private:
  bool TestClass(const Segment& segment, const SegmentShape& shape, std::size_t class_index,
                 ObjectDetection* detection, ObjectStage* reached);
  bool TestDisc(const Segment& segment, const SegmentShape& shape, const ObjectClass& object,
                ObjectDetection* detection, ObjectStage* reached);
  bool TestCuboid(const Segment& segment, const ObjectClass& object, ObjectDetection* detection,
                  ObjectStage* reached);
  // Corners of the upper face, by a cuboid fitted to the whole segment; 'up' must be known.
  std::optional<FaceCorners> FindFaceBySilhouette(const Segment& segment,
                                                  const ObjectClass& object);
  bool TestBar(const Segment& segment, const SegmentShape& shape, const ObjectClass& object,
               ObjectDetection* detection, ObjectStage* reached);
  template <class RayTo>
  double EdgeShift(const RayTo& ray_to, const Eigen::Vector2d& side, const Eigen::Vector2d& outward,
                   double reach) const;
  std::array<Eigen::Vector3d, 4> RectangleAround(const Segment& segment,
                                                 const SegmentShape& shape) const;
  // 'rays': through the corners, in the order of a walk around.
  bool LocateFace(const std::array<Eigen::Vector3d, 4>& rays, const ObjectClass& object,
                  ObjectDetection* detection) const;
  // Whether the colour goes on beyond what surrounds the outline: a hole in something larger, like
  // the inside of a letter on a banner.
  bool IsHole(const Ellipse& outline, ColorLabel label) const;
  // Label of the nearest pixel; nothing outside of the image.
  std::optional<ColorLabel> LabelAt(const Eigen::Vector2d& pixel) const;
  // Whether most of what lies around the centre has another colour.
  bool IsRing(const Ellipse& outline, ColorLabel label) const;
  bool TestMerged(const Segment& segment, const SegmentShape& shape,
                  ObjectDetection* detection) const;
  // Area that a disc on the ground has in the image; nothing when the ground is not known.
  std::optional<double> PixelsOnGround(const Eigen::Vector3d& ray, const ObjectClass& object) const;
  std::optional<double> DistanceOnGround(const Eigen::Vector3d& position,
                                         const ObjectClass& object) const;
  bool IsOnGround(double distance, double on_ground) const;
  // 'by_size': where the object is by its size, with 'relative_sigma' of that distance.
  void SetLocation(const Eigen::Vector3d& by_size, const ObjectClass& object,
                   double center_sigma_px, double relative_sigma, ObjectDetection* detection) const;
  GroundPlane Ground() const {
    return {hint_.up_in_camera, hint_.camera_height_m, hint_.height_sigma_m, hint_.up_sigma_rad};
  }
  Eigen::Vector3d RayAt(const Eigen::Vector2d& pixel) const;

  const ObjectDetector& detector_;
  const cv::Mat& image_;
  const ObjectHint& hint_;
  ObjectWorkspace* workspace_;
  ObjectReport* report_;
};

}  // namespace kestrel
