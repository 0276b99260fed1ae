// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/calibration_evidence.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/landing/print_edges.h"
#include "kestrel/vision/landing/print_outline.h"

namespace kestrel {

// Pose of the pattern that explains the image.
struct PatternLocation {
  RigidTransform camera_from_pattern;
  // Of the pose error: translation in the camera frame (m), then rotation vector in the camera
  // frame about the pattern's centre (rad).
  Eigen::Matrix<double, 6, 6> covariance;
  // Root mean square of what the pose leaves unexplained: pixels, of edges; gray values, of a print
  // that was fitted as a whole. The other one is 0.
  double edge_rms_px = 0;
  double gray_rms = 0;
  // Of edges: root mean square of how far they are from where the pose and the camera's own lens
  // have them; the same as edge_rms_px unless the calibration is contradicted.
  double misfit_px = 0;
  // Of edges: where the lens shows the pattern's centre, by what the calibration has to be; and
  // what that is.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  CalibrationEvidence calibration;
};

// What is known of the pattern's plane before the image is looked at. The attitude that tells it
// may be late, or the plane no level one: a direction that is far from it counts less (Cauchy's
// weight), so that an image that contradicts the prior prevails.
struct NormalPrior {
  Eigen::Vector3d normal_in_camera;  // unit vector, out of the print
  double sigma;                      // standard deviation of its direction per axis, rad

  // Adds it to the normal equations of a pose (translation, then rotation about the centre) whose
  // residuals have the given variance.
  template <class Matrix, class Vector>
  void AddTo(const Eigen::Quaterniond& camera_from_pattern, double variance, Matrix* h,
             Vector* g) const {
    const Eigen::Vector3d normal = camera_from_pattern * Eigen::Vector3d::UnitZ();
    constexpr double kFar = 2;  // standard deviations
    const double away = normal.cross(normal_in_camera).norm() / (kFar * sigma);
    const double weight = variance / (sigma * sigma) / (1 + away * away);
    h->template block<3, 3>(3, 3) +=
        weight * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
    g->template segment<3>(3) += weight * normal.cross(normal_in_camera);
  }
};

// Where a ring is seen.
struct RingLocation {
  RigidTransform camera_from_pattern;  // however the cross is turned
  bool is_whole;                       // nearly all of it has its edges in the image
};

// Finds the pose from the edges (model-based pose estimation, after Drummond and Cipolla 2002): the
// one under which the lens shows the outlines of ring and arms nearest to them, by Gauss-Newton
// with robust weights. What is usually not so is found as well where the edges leave no doubt:
// white that has spread over the black (overexposure), or black over the white; a focal length and
// a principal point that are not the calibration's.
class PatternLocator {
 public:
  PatternLocator(const CameraModel& camera, const LandingPattern& pattern);

  const PrintOutline& outline() const { return outline_; }

  // The pose near 'initial' that explains 'edges'. 'prior': what tells the tilt where the image
  // hardly does, of small prints. Nothing when too few edges are near to fix the six parameters.
  // Does not allocate.
  std::optional<PatternLocation> Locate(const PrintEdges& edges, const RigidTransform& initial,
                                        const std::optional<NormalPrior>& prior = {}) const;

  // The pose of the ring near 'initial' by its edges alone, however the cross is turned about its
  // centre: within 'reach_px' the edge nearest to each point of the outline is looked for along the
  // normal, again and again. 'min_step': as in EdgeSearch. Does not allocate.
  std::optional<RingLocation> LocateRing(const cv::Mat& image, const RigidTransform& initial,
                                         double reach_px, double min_step, int iterations,
                                         const std::optional<NormalPrior>& prior = {}) const;

 private:
  struct State;
  struct Equations;
  struct EdgeColumns;
  struct Linearized;
  struct Residuals;
  struct Solution;

  Eigen::Vector2d Principal() const;
  void Linearize(const State& state, double scale_px, int unknowns, Linearized* linearized) const;
  bool Approach(const EdgeColumns& edges, const std::optional<NormalPrior>& prior, State* state,
                double* scale_px) const;
  static Equations WithPrior(const Linearized& linearized, const State& state,
                             const std::optional<NormalPrior>& prior);
  static Solution SolvePose(const Linearized& linearized, const State& state,
                            const std::optional<NormalPrior>& prior, bool has_spread);
  Solution SolveCalibration(const Linearized& linearized, const State& state,
                            const std::optional<NormalPrior>& prior) const;
  void Recalibrate(const EdgeColumns& edges, const std::optional<NormalPrior>& prior, State* state,
                   PatternLocation* location) const;
  void AddInformation(const Linearized& linearized, const Solution& solution, const State& state,
                      CalibrationEvidence* evidence) const;
  CalibrationEvidence Judge(const Linearized& linearized, const Solution& solution,
                            const State& state) const;
  static void Describe(const Linearized& linearized, const Solution& solution,
                       PatternLocation* location);
  static void DoubtCalibration(const Solution& held, const Solution& free,
                               PatternLocation* location);

  CameraModel camera_;
  PrintOutline outline_;
};

}  // namespace kestrel
