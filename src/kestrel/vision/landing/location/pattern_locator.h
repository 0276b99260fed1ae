// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/alignment/print_edges.h"
#include "kestrel/vision/landing/alignment/print_outline.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/target/calibration_evidence.h"

namespace kestrel {

// Order of a pose's unknowns in vectors and covariances: translation in the camera frame, then the
// rotation vector in the camera frame about the pattern's centre.
inline constexpr int kPoseTranslation = 0;
inline constexpr int kPoseRotation = 3;
inline constexpr int kPoseUnknowns = kPoseRotation + 3;

// Pose of the pattern that explains the image best.
struct PatternLocation {
  RigidTransform camera_from_target;
  // Covariance of the pose error, m and rad.
  Eigen::Matrix<double, kPoseUnknowns, kPoseUnknowns> covariance;
  // Root mean square of the residuals: 'edge_rms_px' of edges, 'gray_rms' (gray values) of a print
  // that was fitted as a whole. The other one is 0.
  double edge_rms_px = 0;
  double gray_rms = 0;
  // Edges only: root mean square distance of the edges from where the pose and the camera's own
  // lens predict them. Equal to edge_rms_px unless the edges contradict the calibration.
  double misfit_px = 0;
  // Edges only: image of the pattern's centre through the lens that the edges support, and the
  // evidence about that lens.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  CalibrationEvidence calibration;
};

// Prior of the pattern's normal. It comes from the attitude, which may be late, and from the
// assumption of a level plane, which may be wrong. Its weight therefore falls with the distance
// from the current normal (Cauchy's weight), so that an image that contradicts the prior prevails.
struct NormalPrior {
  Eigen::Vector3d normal_in_camera;  // unit vector, out of the printed face
  double sigma;                      // standard deviation of the direction per axis, rad

  // Adds the prior to the normal equations of a pose (translation, then rotation about the centre)
  // whose residuals have the variance 'variance'.
  template <class Matrix, class Vector>
  void AddTo(const Eigen::Quaterniond& camera_from_target, double variance, Matrix* h,
             Vector* g) const {
    const Eigen::Vector3d normal = camera_from_target * Eigen::Vector3d::UnitZ();
    constexpr double kFar = 2;  // standard deviations
    const double away = normal.cross(normal_in_camera).norm() / (kFar * sigma);
    const double weight = variance / (sigma * sigma) / (1 + away * away);
    h->template block<3, 3>(kPoseRotation, kPoseRotation) +=
        weight * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
    g->template segment<3>(kPoseRotation) += weight * normal.cross(normal_in_camera);
  }
};

// Location of a ring in the image.
struct RingLocation {
  RigidTransform camera_from_target;  // the turn about the ring's centre is arbitrary
  bool is_whole;                      // nearly all of the ring has edges in the image
};

// Finds the pose from the edges (model-based pose estimation, after Drummond and Cipolla 2002): the
// pose under which the lens projects the outlines of ring and arms nearest to the edges, by
// Gauss-Newton with robust weights. Where the edges leave no doubt it also estimates a spread of
// white over black (overexposure) or of black over white, and another focal length and principal
// point than the calibration's.
class PatternLocator {
 public:
  PatternLocator(const CameraModel& camera, const LandingPattern& pattern);

  const PrintOutline& outline() const { return outline_; }

  // Returns the pose near 'initial' that explains 'edges'. 'prior': determines the tilt of small
  // prints, which the image hardly does. Returns nothing when too few edges are near to determine
  // the six parameters. Does not allocate.
  std::optional<PatternLocation> Locate(const PrintEdges& edges, const RigidTransform& initial,
                                        const std::optional<NormalPrior>& prior = {}) const;

  // Returns the pose of the ring near 'initial' by its edges alone; the turn about its centre stays
  // arbitrary. Repeatedly searches the edge nearest to each point of the outline along the normal,
  // within 'reach_px'. 'min_step': as in EdgeSearch. Does not allocate.
  std::optional<RingLocation> LocateRing(const cv::Mat& image, const RigidTransform& initial,
                                         double reach_px, double min_step, int iterations,
                                         const std::optional<NormalPrior>& prior = {}) const;

 private:
  // The unknowns: pose (translation, then rotation vector), spread of the black, logarithm of the
  // focal length's factor, shift of the principal point, and distortion (added to the distance from
  // the principal point: distortion times its cube, in focal lengths). A single view determines the
  // distortion too poorly to solve for it, but its information is reported.
  static constexpr int kSpread = kPoseUnknowns;
  static constexpr int kFocal = kSpread + 1;
  static constexpr int kPrincipal = kFocal + 1;
  static constexpr int kDistortion = kPrincipal + 2;
  static constexpr int kUnknowns = kDistortion + 1;
  static constexpr int kCalibrationUnknowns = kUnknowns - kFocal;
  // Further columns: the offsets, and their derivatives by the square of the blur.
  static constexpr int kOffset = kUnknowns;
  static constexpr int kBlur = kOffset + 1;
  static constexpr int kEdgeColumns = kBlur + 1;
  using Column = std::array<float, PrintOutline::kMaxPlaces>;
  using PoseVector = Eigen::Matrix<double, kPoseUnknowns, 1>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  static constexpr int kMaxSteps = 8;
  static constexpr double kSettledPx = 0.08;  // outlines that move by less have settled
  // Squared Mahalanobis distance of the calibration from the camera's above which it is solved for.
  static constexpr double kDoubtfulCalibration = 8;

  struct State;
  struct Equations;
  struct EdgeColumns;
  struct Lens;
  struct Outlines;
  struct Linearized;
  struct Residuals;
  struct Solution;

  Eigen::Vector2d Principal() const;
  Lens LensOf(const State& state) const;
  void Project(const RigidTransform& pose, const EdgeColumns& edges, Outlines* outlines) const;
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
