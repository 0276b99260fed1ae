// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// A point in the middle of an edge between black and white, on the pad.
struct PadEdge {
  Eigen::Vector2d place;
  Eigen::Vector2d to_white;  // unit vector across the edge
  double stroke_m;           // stroke width of its part
  bool fine;                 // useful only where strokes are wide in the image
};

// A part of a flat pad, as a tag, a letter or the line around it, by its edges.
struct PadPart {
  static constexpr double kLeastStrokePx = 1;  // narrower strokes in the image are not looked at

  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // on the pad
  double stroke_m = 0;  // width of its thinnest strokes: of a tag, the side of its cells
  std::vector<PadEdge> edges{};

  // Returns the width of a stroke in the image across its shorter direction, px, by distance
  // and slant. 0 when the face is turned away.
  double StrokePx(const CameraModel& camera, const RigidTransform& camera_from_pad) const;
};

// Knowledge of the pad's tilt: its face looks up.
struct LevelPrior {
  std::optional<Eigen::Vector3d> up_in_camera;
  double sigma = 0.05;  // rad
};

struct AlignedPad {
  RigidTransform camera_from_pad;
  Eigen::Matrix<double, 6, 6> covariance;  // as TargetDetection's
  double rms_px = 0;      // distance of the edges from where the pose predicts them
  double prior_cost = 0;  // half of the prior's squared deviation, in standard deviations
  int edges = 0;          // number of edge points that the pose explains
};

// Returns how much less likely than 'best' another alignment of the same edges is: half of the
// difference of their squared deviations, in standard deviations. Negative when it is likelier.
double CostAbove(const AlignedPad& best, const AlignedPad& other);

// Memory of one thread's alignments.
struct PadAlignmentBuffers {
  std::vector<const PadEdge*> edges;
  std::vector<float> x, y, z, u, v;  // edges in the camera frame (m) and in the image (px)
  std::array<std::vector<float>, 6> derivative;  // derivative of the place in the image
  std::vector<float> profile_u, profile_v, gray;
  struct Equation {
    Eigen::Matrix<double, 1, 6> derivative;  // derivative of the edge's place along its normal, px
    float reach_px;                          // how far from its place the edge is searched
    double residual_px;                      // where it was found
  };
  std::vector<Equation> equations;
  std::vector<double> magnitudes;
};

// Moves a pad so that all edges of its parts lie where the image shows them: each is searched along
// its normal in the raw image, and Gauss-Newton minimises the distances (px). The lens is part of
// the model, so nothing is undistorted.
class PadAlignment {
 public:
  // 'parts': a range of PadPart. Keeps both by reference.
  template <class Parts>
  PadAlignment(const CameraModel& camera, const Parts& parts) : camera_(camera) {
    for (const PadPart& part : parts) parts_.push_back(&part);
  }

  void Reserve(PadAlignmentBuffers* buffers) const;

  // Aligns from 'start', by the edges of all parts whose strokes are wide enough, or of 'only' one.
  // Nothing when too few edges are found, or no pose brings them together. Does not allocate.
  std::optional<AlignedPad> Align(const cv::Mat& image, const RigidTransform& start,
                                  const LevelPrior& prior, const PadPart* only,
                                  PadAlignmentBuffers* buffers) const;

 private:
  void CollectEdges(const RigidTransform& pose, const PadPart* only,
                    PadAlignmentBuffers* buffers) const;
  void Predict(const RigidTransform& pose, double most_reach_px,
               PadAlignmentBuffers* buffers) const;
  void Measure(const cv::Mat& image, PadAlignmentBuffers* buffers) const;

  const CameraModel& camera_;
  std::vector<const PadPart*> parts_;
};

}  // namespace kestrel
