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
#include "kestrel/vision/tags/board_model.h"

namespace kestrel {

// Knowledge of the board's tilt: its face looks up.
struct LevelPrior {
  std::optional<Eigen::Vector3d> up_in_camera;
  double sigma = 0.05;  // rad
};

struct AlignedBoard {
  RigidTransform camera_from_board;
  Eigen::Matrix<double, 6, 6> covariance;  // as LandingDetection's
  double rms_px = 0;      // distance of the edges from where the pose predicts them
  double prior_cost = 0;  // half of the prior's squared deviation, in standard deviations
  int edges = 0;          // number of edge points that the pose explains
};

// Returns how much less likely than 'best' another alignment of the same edges is: half of the
// difference of their squared deviations, in standard deviations. Negative when it is likelier.
double CostAbove(const AlignedBoard& best, const AlignedBoard& other);

// Memory of one thread's alignments.
struct BoardAlignmentBuffers {
  std::vector<const BoardEdge*> edges;
  std::vector<float> x, y, z, u, v;              // of the edges: camera frame (m) and image (px)
  std::array<std::vector<float>, 6> derivative;  // of the place in the image
  std::vector<float> profile_u, profile_v, gray;
  struct Equation {
    Eigen::Matrix<double, 1, 6> derivative;  // of the edge's place along its normal, px
    float reach_px;                          // how far from its place the edge is searched
    double residual_px;                      // where it was found
  };
  std::vector<Equation> equations;
  std::vector<double> magnitudes;

  void Reserve(const BoardModel& board);
};

// Moves a board so that all edges between its cells lie where the image shows them: each is
// searched along its normal in the raw image, and Gauss-Newton minimises the distances (px). The
// lens is part of the model, so nothing is undistorted.
class BoardAlignment {
 public:
  // Keeps both by reference.
  BoardAlignment(const CameraModel& camera, const BoardModel& board)
      : camera_(camera), board_(board) {}

  // Aligns from 'start', by the edges of all tags whose cells are large enough, or of 'only' one.
  // Nothing when too few edges are found, or no pose brings
  // them together. Does not allocate.
  std::optional<AlignedBoard> Align(const cv::Mat& image, const RigidTransform& start,
                                    const LevelPrior& prior, const TagModel* only,
                                    BoardAlignmentBuffers* buffers) const;

 private:
  void CollectEdges(const RigidTransform& pose, const TagModel* only,
                    BoardAlignmentBuffers* buffers) const;
  void Predict(const RigidTransform& pose, double most_reach_px,
               BoardAlignmentBuffers* buffers) const;
  void Measure(const cv::Mat& image, BoardAlignmentBuffers* buffers) const;

  const CameraModel& camera_;
  const BoardModel& board_;
};

}  // namespace kestrel
