// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/digits/digit_classifier.h"
#include "kestrel/vision/objects/location/ground_plane.h"
#include "kestrel/vision/objects/object_detector.h"
#include "kestrel/vision/objects/segmentation/segment_border.h"
#include "kestrel/vision/objects/segmentation/segment_shape.h"
#include "kestrel/vision/objects/segmentation/segmentation.h"
#include "kestrel/vision/objects/shapes/cuboid_face.h"
#include "kestrel/vision/objects/shapes/disc_outline.h"

namespace kestrel {

struct ObjectWorkspace::Buffers {
  SegmentationWorkspace segmentation;
  DiscOutlineWorkspace outline;
  CuboidFaceWorkspace face;
  SegmentBorder border;
  std::vector<Eigen::Vector2d> inside;  // pixels of the segment, on the ground
};

struct ObjectDetector::Impl {
  CameraModel camera;
  RayTable rays;
  ObjectModel model;
  ColorGrid grid;
  ObjectDetectorOptions options;
  DigitClassifier digits;
  double focal_px;
  int search_step;
  // True for labels of colours that a class of cuboids has: these have a white digit.
  std::array<bool, 256> has_digit{};
};

// Runs the tests that turn a segment of an image into a detection.
class ObjectExaminer {
 public:
  ObjectExaminer(const ObjectDetector::Impl& detector, const cv::Mat& image, const ObjectHint& hint,
                 ObjectWorkspace::Buffers* workspace, ObjectReport* report)
      : detector_(detector), image_(image), hint_(hint), workspace_(workspace), report_(report) {}

  // Adds a detection to the report when the segment is an object of one of the classes. True when
  // the object is on the ground as the hint describes it.
  bool Run(const Segment& segment);

 private:
  // Result of testing a segment for a class.
  enum class Outcome {
    kNone,
    kElsewhere,  // an object by its shape, but not on the ground as the hint describes it
    kObject,
  };

  Outcome TestClass(const Segment& segment, const SegmentShape& shape, std::size_t class_index,
                    ObjectDetection* detection, ObjectStage* reached);
  Outcome TestDisc(const Segment& segment, const SegmentShape& shape, const ObjectClass& object,
                   ObjectDetection* detection, ObjectStage* reached);
  std::optional<Ellipse> StartOfDisc(const Segment& segment, const SegmentShape& shape);
  bool FitsDisc(const DiscOutline& outline, double radius_px, bool is_cut_off) const;
  bool IsFilledDisc(const Segment& segment, const Ellipse& ellipse) const;
  // 'position': by the disc's size.
  Outcome PlaceDisc(const Cone& cone, const Eigen::Vector3d& position,
                    const ObjectClass& object) const;
  Outcome TestCuboid(const Segment& segment, const ObjectClass& object, ObjectDetection* detection,
                     ObjectStage* reached);
  // Tests whether a quadrilateral, right to about 2 px, is the upper face of a cuboid.
  Outcome TestFace(const FaceCorners& found, const ObjectClass& object, ObjectDetection* detection,
                   ObjectStage* reached);
  // The same for the upper face of a cuboid that is fitted to the whole segment. 'up' must be
  // known. With 'camera_height_m' the cuboid is fitted at its size on the ground.
  Outcome TestSilhouette(const Segment& segment, const ObjectClass& object,
                         std::optional<double> camera_height_m, ObjectDetection* detection,
                         ObjectStage* reached);
  Outcome TestBar(const Segment& segment, const SegmentShape& shape, const ObjectClass& object,
                  ObjectDetection* detection, ObjectStage* reached);
  template <class RayTo>
  double EdgeShift(const RayTo& ray_to, const Eigen::Vector2d& side, const Eigen::Vector2d& outward,
                   double reach) const;
  std::array<Eigen::Vector3d, 4> RectangleAround(const Segment& segment,
                                                 const SegmentShape& shape) const;
  // 'rays': through the corners, in order around the face. Adds to the detection's misfit.
  Outcome LocateFace(const std::array<Eigen::Vector3d, 4>& rays, const ObjectClass& object,
                     ObjectDetection* detection) const;
  // True when the colour continues beyond the surroundings of the outline: a hole in something
  // larger, like the inside of a letter on a banner.
  bool IsHole(const Ellipse& outline, ColorLabel label) const;
  // Label of the nearest pixel; nothing outside of the image.
  std::optional<ColorLabel> LabelAt(const Eigen::Vector2d& pixel) const;
  // Share of the pixels within 'reach' (share of the outline) that have the label.
  double ColoredShare(const Ellipse& outline, double reach, ColorLabel label) const;
  double MisfitOfDisc(const DiscOutline& outline, double radius_px, const Segment& segment,
                      const SegmentShape& shape, const Ellipse& ellipse) const;
  // Tests whether the segment consists of touching discs of one class.
  bool TestMerged(const Segment& segment, const SegmentShape& shape, ObjectDetection* detection);
  template <class OnPlane>
  std::optional<double> RadiusOfDiscsIn(const Segment& segment, const OnPlane& on_plane,
                                        double pixel);
  // Radius of a disc on the ground, on the plane at unit distance below the camera. Nothing when
  // the ground is not known.
  std::optional<double> RadiusBelow(const ObjectClass& disc) const;
  // Probability of the class, given its shape and the probabilities of the colours.
  double ClassProbability(const ObjectClass& object, const ColorProbabilities& colors) const;
  // True when an object located by its size at 'position' is on the ground, to a share 'tolerance'
  // of the distance. Nothing when the ground is not known.
  std::optional<bool> IsOnGround(const Eigen::Vector3d& position, const ObjectClass& object,
                                 double tolerance) const;
  std::optional<double> DistanceOnGround(const Eigen::Vector3d& position,
                                         const ObjectClass& object) const;
  // 'by_size': location from the object's size, with 'relative_sigma' of its distance.
  void SetLocation(const Eigen::Vector3d& by_size, const ObjectClass& object,
                   double center_sigma_px, double relative_sigma, Outcome outcome,
                   ObjectDetection* detection) const;
  GroundPlane Ground() const {
    return {hint_.up_in_camera, hint_.camera_height_m, hint_.height_sigma_m, hint_.up_sigma_rad};
  }
  Eigen::Vector3d RayAt(const Eigen::Vector2d& pixel) const;

  const ObjectDetector::Impl& detector_;
  const cv::Mat& image_;
  const ObjectHint& hint_;
  ObjectWorkspace::Buffers* workspace_;
  ObjectReport* report_;
};

}  // namespace kestrel
