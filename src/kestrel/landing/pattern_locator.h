// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/camera/camera_model.h"
#include "kestrel/geometry/rigid_transform.h"
#include "kestrel/landing/landing_pattern.h"

namespace kestrel {

// Pose of the pattern that explains the edges of its ring and cross, in the image itself.
struct PatternLocation {
  RigidTransform camera_from_pattern;
  // Of the pose error: translation in the camera frame (m), then rotation vector in the camera
  // frame about the pattern's centre (rad).
  Eigen::Matrix<double, 6, 6> covariance;
  double edge_rms_px = 0;  // of the edges used, from the projected pattern
  double edge_share = 0;   // share of the pattern's edges in the image that were found there
  int edges = 0;           // how many were used
  double gray_rms = 0;     // gray values, of a print that was fitted as a whole, from the model
  // The same share for each arm and for the ring around it; negative when the image shows less than
  // a quarter of it.
  std::array<double, 4> arm_share{};
  std::array<double, 4> ring_share{};
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

// Refines a pose from the edges (model-based pose estimation, after Drummond and Cipolla 2002): the
// outlines of ring and arms are projected through the lens, the edge nearest to each of their
// points is looked for along the normal, to a fraction of a pixel, and the pose that brings them
// together is found by Gauss-Newton with robust weights. Where the edges leave no doubt that white
// has spread over the black (overexposure) or black over the white, by how much is found as well.
class PatternLocator {
 public:
  PatternLocator(const CameraModel& camera, const LandingPattern& pattern);

  // 'image': CV_8UC1 of the camera. 'initial': a pose whose outlines are within 'reach_px' of the
  // edges. 'min_step': gray values per pixel below which a change in full light is no edge.
  // 'iterations': of a pose that settles; a few more follow while it does not. 'prior': what tells
  // the tilt where the image hardly does, of small prints. Nothing when too few edges are found to
  // fix the six parameters. Does not allocate.
  std::optional<PatternLocation> Locate(const cv::Mat& image, const RigidTransform& initial,
                                        double reach_px, double min_step, int iterations,
                                        const std::optional<NormalPrior>& prior = {}) const;

  // The same by the edges of the ring alone, however the cross is turned about its centre.
  std::optional<RigidTransform> LocateRing(const cv::Mat& image, const RigidTransform& initial,
                                           double reach_px, double min_step, int iterations,
                                           const std::optional<NormalPrior>& prior = {}) const;

 private:
  // A point of an outline and the unit normal that points from black to white, in the plane.
  struct Place {
    Eigen::Vector2d point;
    Eigen::Vector2d normal;
    int part;          // 0 to 3: arm, 4 to 7: ring around it
    int side;          // 0 or 1: of the arm, or the inside and outside of the ring
    double width;      // of the stroke whose edge it is, m
    double curvature;  // 1/m; positive where the outline bends around the black side
  };
  // Pose (translation, then rotation vector), then the spread of the black.
  static constexpr int kPoseUnknowns = 6;
  static constexpr int kSpread = kPoseUnknowns;
  static constexpr int kUnknowns = kPoseUnknowns + 1;
  using PoseVector = Eigen::Matrix<double, kPoseUnknowns, 1>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  struct State;
  struct Normal;
  struct Residuals;

  static bool AreOnOneOutline(const Place& a, const Place& b);
  void AddCircle(double radius, double sign, int count, double arm_clearance);
  void AddArms();
  Normal Accumulate(const cv::Mat& image, const State& state, std::span<const Place> places,
                    std::size_t stride, double reach_px, double min_step, double scale_px) const;
  Normal Measure(const cv::Mat& image, const State& state, std::span<const Place> places,
                 std::size_t enough, double reach_px, double min_step, double scale_px) const;
  static Vector Solve(const State& state, const std::optional<NormalPrior>& prior, bool has_spread,
                      Normal* normal);
  static void Describe(const Normal& normal, const Vector& step, PatternLocation* location);

  CameraModel camera_;
  LandingPattern pattern_;
  std::vector<Place> places_;  // those of the ring first
  std::size_t ring_places_ = 0;
};

}  // namespace kestrel
