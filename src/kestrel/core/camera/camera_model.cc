// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/camera_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using Coefficients = std::array<double, 8>;
using Polynomial = std::vector<double>;  // coefficients, constant term first

// Beyond this tangent a pinhole's pixel is a thousand focal lengths away, outside of any image.
constexpr double kMaxTangent = 1000;
constexpr int kMaxImageSide = 65535;
constexpr double kMaxCoefficient = 1e4;

// A function of one variable and its derivative.
struct Slope {
  double value;
  double derivative;
};

// Distorted radius as a function of the angle: theta_d(theta) = theta (1 + k1 theta^2 + ...).
Slope EquidistantRadius(const Coefficients& k, double theta) {
  const double s = theta * theta;
  const double value = theta * (1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
  const double derivative = 1 + s * (3 * k[0] + s * (5 * k[1] + s * (7 * k[2] + s * 9 * k[3])));
  return {value, derivative};
}

// Radial factor g as a function of the squared undistorted radius s: (1 + k1 s + k2 s^2 + k3 s^3)
// divided by (1 + k4 s + k5 s^2 + k6 s^3).
Slope RadialFactor(const Coefficients& k, double s) {
  const double numerator = 1 + s * (k[0] + s * (k[1] + s * k[4]));
  const double denominator = 1 + s * (k[5] + s * (k[6] + s * k[7]));
  const double d_numerator = k[0] + s * (2 * k[1] + s * 3 * k[4]);
  const double d_denominator = k[5] + s * (2 * k[6] + s * 3 * k[7]);
  const double value = numerator / denominator;
  return {value, (d_numerator - value * d_denominator) / denominator};
}

// Distorted radius as a function of the tangent t of the angle, without the tangential part.
Slope RadialRadius(const Coefficients& k, double t) {
  const Slope factor = RadialFactor(k, t * t);
  return {t * factor.value, factor.value + 2 * t * t * factor.derivative};
}

struct DistortedPoint {
  Eigen::Vector2d value;
  Eigen::Matrix2d jacobian;  // symmetric: the distortion is the gradient of a scalar function
};

DistortedPoint DistortRadialTangential(const Coefficients& k, const Eigen::Vector2d& point) {
  const double x = point.x();
  const double y = point.y();
  const double s = point.squaredNorm();
  const double p1 = k[2];
  const double p2 = k[3];
  const Slope factor = RadialFactor(k, s);
  DistortedPoint result;
  result.value = factor.value * point + Eigen::Vector2d(2 * p1 * x * y + p2 * (s + 2 * x * x),
                                                        p1 * (s + 2 * y * y) + 2 * p2 * x * y);
  const double mixed = 2 * (factor.derivative * x * y + p1 * x + p2 * y);
  result.jacobian << factor.value + 2 * factor.derivative * x * x + 2 * p1 * y + 6 * p2 * x, mixed,
      mixed, factor.value + 2 * factor.derivative * y * y + 6 * p1 * y + 2 * p2 * x;
  return result;
}

bool HasTangentialPart(const Coefficients& k) { return k[2] != 0 || k[3] != 0; }

double Evaluate(const Polynomial& polynomial, double s) {
  double value = 0;
  for (auto c = polynomial.rbegin(); c != polynomial.rend(); ++c) value = value * s + *c;
  return value;
}

Polynomial Derivative(const Polynomial& polynomial) {
  Polynomial result;
  for (std::size_t i = 1; i < polynomial.size(); ++i) {
    result.push_back(static_cast<double>(i) * polynomial[i]);
  }
  return result;
}

Polynomial Product(const Polynomial& a, const Polynomial& b) {
  Polynomial result(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

double BisectSignChange(const Polynomial& polynomial, double low, double high) {
  const bool positive_at_low = Evaluate(polynomial, low) > 0;
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return low;
    ((Evaluate(polynomial, middle) > 0) == positive_at_low ? low : high) = middle;
  }
}

// Returns the sign changes of the polynomial between 0 and 'upper', ascending. The sign changes of
// the derivative divide the range into monotonic pieces, so that none is missed.
std::vector<double> SignChanges(const Polynomial& polynomial, double upper) {
  if (polynomial.size() < 2) return {};
  std::vector<double> knots = SignChanges(Derivative(polynomial), upper);
  knots.insert(knots.begin(), 0.0);
  knots.push_back(upper);
  std::vector<double> changes;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if ((Evaluate(polynomial, knots[i]) > 0) != (Evaluate(polynomial, knots[i + 1]) > 0)) {
      changes.push_back(BisectSignChange(polynomial, knots[i], knots[i + 1]));
    }
  }
  return changes;
}

double FirstSignChange(const Polynomial& polynomial, double upper) {
  const std::vector<double> changes = SignChanges(polynomial, upper);
  return changes.empty() ? upper : changes.front();
}

// First angle at which d theta_d / d theta changes its sign, at most pi.
double EquidistantLimit(const Coefficients& k) {
  const double pi = std::numbers::pi;
  const Polynomial slope{1, 3 * k[0], 5 * k[1], 7 * k[2], 9 * k[3]};
  return std::sqrt(FirstSignChange(slope, pi * pi));
}

// Returns the first tangent at which the radial part has a pole or stops growing. With N and D the
// numerator and denominator of the radial factor over s = t^2, the slope of t N / D has the sign of
// (N + 2 s N') D - 2 s N D'.
double RadialLimit(const Coefficients& k) {
  const Polynomial numerator{1, k[0], k[1], k[4]};
  const Polynomial denominator{1, k[5], k[6], k[7]};
  const Polynomial growth{1, 3 * k[0], 5 * k[1], 7 * k[4]};
  const Polynomial pole_shift{0, 2 * k[5], 4 * k[6], 6 * k[7]};
  Polynomial slope = Product(growth, denominator);
  const Polynomial loss = Product(numerator, pole_shift);
  for (std::size_t i = 0; i < slope.size(); ++i) slope[i] -= loss[i];
  const double upper = kMaxTangent * kMaxTangent;
  return std::sqrt(std::min(FirstSignChange(slope, upper), FirstSignChange(denominator, upper)));
}

// Returns the angle up to which the Jacobian of the whole distortion is positive definite in every
// direction. The Jacobian is symmetric, so within that disc the distortion is the gradient of a
// strictly convex function: no two points share a pixel, and Newton's method finds each.
double TangentialLimit(const Coefficients& k, double radial_limit_angle) {
  constexpr int kDirections = 72;
  constexpr int kSteps = 500;
  int good_steps = kSteps;
  for (int i = 0; i < kDirections; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
    for (int step = 1; step <= good_steps; ++step) {
      const double tangent = std::tan(radial_limit_angle * step / kSteps);
      const Eigen::Matrix2d jacobian = DistortRadialTangential(k, tangent * direction).jacobian;
      if (!(jacobian.determinant() > 0 && jacobian.trace() > 0)) good_steps = step - 1;
    }
  }
  return radial_limit_angle * good_steps / kSteps;
}

double PinholeLimit(const Coefficients& k) {
  const double angle = std::atan(RadialLimit(k));
  return HasTangentialPart(k) ? TangentialLimit(k, angle) : angle;
}

// Solves function(x) = target for a function that grows from 0 to 'upper', by Newton's method with
// bisection where it would leave the bracket.
template <class Function>
double InvertMonotonic(const Function& function, double target, double upper) {
  double low = 0;
  double high = upper;
  double x = std::min(target, upper);
  for (int i = 0; i < 100; ++i) {
    const Slope slope = function(x);
    const double error = slope.value - target;
    (error > 0 ? high : low) = x;
    double next = x - error / slope.derivative;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const double change = std::abs(next - x);
    x = next;
    if (change <= 1e-15 * (1 + x)) break;
  }
  return x;
}

// Newton's method in the plane from 'guess'. Halves a step that leaves the disc or does not bring
// the distorted point nearer. False when 'target' is not the image of a point in the disc.
bool InvertRadialTangential(const Coefficients& k, const Eigen::Vector2d& target,
                            double max_tangent, Eigen::Vector2d* point) {
  const double tolerance = 1e-14 * (1 + target.norm());
  const double disc = max_tangent * (1 + 1e-9);
  DistortedPoint distorted = DistortRadialTangential(k, *point);
  double error = (target - distorted.value).norm();
  for (int i = 0; i < 50 && error > tolerance; ++i) {
    Eigen::Vector2d step = distorted.jacobian.inverse() * (target - distorted.value);
    bool better = false;
    for (int halving = 0; halving < 30 && !better; ++halving, step *= 0.5) {
      const Eigen::Vector2d candidate = *point + step;
      const DistortedPoint next = DistortRadialTangential(k, candidate);
      const double next_error = (target - next.value).norm();
      better = candidate.norm() <= disc && next_error < error;
      if (better) {
        *point = candidate;
        distorted = next;
        error = next_error;
      }
    }
    if (!better) break;
  }
  return error <= 100 * tolerance && point->norm() <= disc;
}

std::vector<std::size_t> CoefficientCounts(DistortionModel model) {
  switch (model) {
    case DistortionModel::kNone:
      return {0};
    case DistortionModel::kRadialTangential:
      return {4, 5, 8};
    case DistortionModel::kEquidistant:
      return {4};
  }
  return {};
}

Coefficients Padded(const std::vector<double>& distortion) {
  Coefficients k{};
  std::copy_n(distortion.begin(), std::min(distortion.size(), k.size()), k.begin());
  return k;
}

double MaxAngle(DistortionModel model, const Coefficients& k) {
  return model == DistortionModel::kEquidistant ? EquidistantLimit(k) : PinholeLimit(k);
}

double MaxRadius(DistortionModel model, const Coefficients& k, double max_angle) {
  return model == DistortionModel::kEquidistant ? EquidistantRadius(k, max_angle).value
                                                : RadialRadius(k, std::tan(max_angle)).value;
}

using Violations = std::vector<std::string>;

void CheckSide(const char* name, int side_px, Violations* violations) {
  if (side_px < 1 || side_px > kMaxImageSide) {
    violations->push_back(
        fmt::format("image {} is {} px, expected 1 to {}", name, side_px, kMaxImageSide));
  }
}

void CheckFocalLength(const char* name, double focal_px, int width_px, Violations* violations) {
  const double low = 0.05 * width_px;
  const double high = 50.0 * width_px;
  if (!(focal_px >= low && focal_px <= high)) {
    violations->push_back(
        fmt::format("focal length {} is {} px, expected {} to {} (0.05 to 50 image widths)", name,
                    focal_px, low, high));
  }
}

void CheckPrincipalPoint(const char* name, double center_px, int side_px, Violations* violations) {
  if (!(center_px >= -side_px && center_px <= 2.0 * side_px)) {
    violations->push_back(fmt::format("principal point {} is {} px, expected {} to {}", name,
                                      center_px, -side_px, 2 * side_px));
  }
}

void CheckDistortion(const CameraIntrinsics& camera, Violations* violations) {
  const std::vector<std::size_t> counts = CoefficientCounts(camera.distortion_model);
  if (std::find(counts.begin(), counts.end(), camera.distortion.size()) == counts.end()) {
    violations->push_back(fmt::format("{} distortion coefficients, expected {}",
                                      camera.distortion.size(), fmt::join(counts, ", ")));
  }
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    if (!(std::abs(camera.distortion[i]) <= kMaxCoefficient)) {
      violations->push_back(
          fmt::format("distortion coefficient {} is {}, expected -{:.0f} to {:.0f}", i + 1,
                      camera.distortion[i], kMaxCoefficient, kMaxCoefficient));
    }
  }
}

// A distortion that folds back near the centre is probably mistyped.
void CheckReach(const CameraIntrinsics& camera, Violations* violations) {
  const Coefficients k = Padded(camera.distortion);
  const double angle = MaxAngle(camera.distortion_model, k);
  const double reach_px =
      std::min(camera.fx_px, camera.fy_px) * MaxRadius(camera.distortion_model, k, angle);
  const double expected_px = 0.25 * std::min(camera.width_px, camera.height_px);
  if (!(reach_px >= expected_px)) {
    violations->push_back(
        fmt::format("the distortion coefficients fold the image back {:.1f} px from the principal "
                    "point, expected {:.1f} px or more (a quarter of the smaller side)",
                    reach_px, expected_px));
  }
}

}  // namespace

std::vector<std::string> CameraIntrinsics::Validate() const {
  Violations violations;
  CheckSide("width", width_px, &violations);
  CheckSide("height", height_px, &violations);
  const bool has_size = violations.empty();
  CheckDistortion(*this, &violations);
  if (has_size) {
    CheckFocalLength("fx", fx_px, width_px, &violations);
    CheckFocalLength("fy", fy_px, width_px, &violations);
    CheckPrincipalPoint("cx", cx_px, width_px, &violations);
    CheckPrincipalPoint("cy", cy_px, height_px, &violations);
  }
  if (violations.empty()) CheckReach(*this, &violations);
  return violations;
}

void CheckImageSize(const CameraIntrinsics& camera, int width_px, int height_px,
                    const std::string& image) {
  if (width_px == camera.width_px && height_px == camera.height_px) return;
  const bool is_swapped = width_px == camera.height_px && height_px == camera.width_px;
  throw ImageSizeError(fmt::format(
      "{}: the image is {}x{} px, expected {}x{} px as in the calibration{}", image, width_px,
      height_px, camera.width_px, camera.height_px, is_swapped ? " (swapped)" : ""));
}

CameraModel::CameraModel(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  const std::vector<std::string> violations = intrinsics.Validate();
  if (!violations.empty()) {
    throw InputError(fmt::format("camera calibration: {}", fmt::join(violations, "; ")));
  }
  k_ = Padded(intrinsics.distortion);
  is_distorted_ = std::any_of(k_.begin(), k_.end(), [](double k) { return k != 0; });
  max_angle_ = MaxAngle(intrinsics.distortion_model, k_);
  max_tangent_ = std::tan(max_angle_);
  max_radius_ = MaxRadius(intrinsics.distortion_model, k_, max_angle_);
  kernel_.is_equidistant = intrinsics.distortion_model == DistortionModel::kEquidistant;
  std::copy(k_.begin(), k_.end(), kernel_.k.begin());
  kernel_.limit = static_cast<float>(kernel_.is_equidistant ? max_angle_ : max_tangent_);
  kernel_.fx_px = static_cast<float>(intrinsics.fx_px);
  kernel_.fy_px = static_cast<float>(intrinsics.fy_px);
  kernel_.cx_px = static_cast<float>(intrinsics.cx_px);
  kernel_.cy_px = static_cast<float>(intrinsics.cy_px);
}

ProjectionStatus CameraModel::Project(const Eigen::Vector3d& point_in_camera,
                                      Eigen::Vector2d* pixel,
                                      Eigen::Matrix<double, 2, 3>* d_pixel_d_point) const {
  return intrinsics_.distortion_model == DistortionModel::kEquidistant
             ? ProjectEquidistant(point_in_camera, pixel, d_pixel_d_point)
             : ProjectPinhole(point_in_camera, pixel, d_pixel_d_point);
}

ProjectionStatus CameraModel::Unproject(const Eigen::Vector2d& pixel,
                                        Eigen::Vector3d* ray_in_camera) const {
  const Eigen::Vector2d distorted((pixel.x() - intrinsics_.cx_px) / intrinsics_.fx_px,
                                  (pixel.y() - intrinsics_.cy_px) / intrinsics_.fy_px);
  const bool inside_model = intrinsics_.distortion_model == DistortionModel::kEquidistant
                                ? UnprojectEquidistant(distorted, ray_in_camera)
                                : UnprojectPinhole(distorted, ray_in_camera);
  return inside_model ? InImage(pixel) : ProjectionStatus::kOutsideModel;
}

ProjectionStatus CameraModel::InImage(const Eigen::Vector2d& pixel) const {
  const bool inside = pixel.x() >= -0.5 && pixel.x() < intrinsics_.width_px - 0.5 &&
                      pixel.y() >= -0.5 && pixel.y() < intrinsics_.height_px - 0.5;
  return inside ? ProjectionStatus::kOk : ProjectionStatus::kOutsideImage;
}

ProjectionStatus CameraModel::ProjectEquidistant(const Eigen::Vector3d& point,
                                                 Eigen::Vector2d* pixel,
                                                 Eigen::Matrix<double, 2, 3>* jacobian) const {
  const double z = point.z();
  const double squared_norm = point.squaredNorm();
  if (!(squared_norm > 0 && std::isfinite(squared_norm))) return ProjectionStatus::kOutsideModel;
  const double rho = point.head<2>().norm();
  const double theta = std::atan2(rho, z);
  if (theta > max_angle_ || (rho == 0 && z < 0)) return ProjectionStatus::kOutsideModel;

  const Slope radius = EquidistantRadius(k_, theta);
  const bool on_axis = rho == 0;
  const double across = on_axis ? 1 / z : radius.value / rho;  // distorted radius over radius
  *pixel << intrinsics_.fx_px * across * point.x() + intrinsics_.cx_px,
      intrinsics_.fy_px * across * point.y() + intrinsics_.cy_px;
  if (jacobian != nullptr) {
    const double along = radius.derivative * z / squared_norm;  // derivative along the radius
    const double cosine = on_axis ? 1 : point.x() / rho;
    const double sine = on_axis ? 0 : point.y() / rho;
    const double d_depth = -radius.derivative * rho / squared_norm;
    const double difference = along - across;
    *jacobian << intrinsics_.fx_px * (across + cosine * cosine * difference),
        intrinsics_.fx_px * cosine * sine * difference, intrinsics_.fx_px * cosine * d_depth,
        intrinsics_.fy_px * cosine * sine * difference,
        intrinsics_.fy_px * (across + sine * sine * difference), intrinsics_.fy_px * sine * d_depth;
  }
  return InImage(*pixel);
}

ProjectionStatus CameraModel::ProjectPinhole(const Eigen::Vector3d& point, Eigen::Vector2d* pixel,
                                             Eigen::Matrix<double, 2, 3>* jacobian) const {
  const double z = point.z();
  if (!(z > 0 && std::isfinite(z))) return ProjectionStatus::kOutsideModel;
  const Eigen::Vector2d undistorted = point.head<2>() / z;
  if (!(undistorted.norm() <= max_tangent_)) return ProjectionStatus::kOutsideModel;

  const DistortedPoint distorted = is_distorted_
                                       ? DistortRadialTangential(k_, undistorted)
                                       : DistortedPoint{undistorted, Eigen::Matrix2d::Identity()};
  *pixel << intrinsics_.fx_px * distorted.value.x() + intrinsics_.cx_px,
      intrinsics_.fy_px * distorted.value.y() + intrinsics_.cy_px;
  if (jacobian != nullptr) {
    const Eigen::Vector2d focal(intrinsics_.fx_px, intrinsics_.fy_px);
    jacobian->leftCols<2>() = focal.asDiagonal() * distorted.jacobian / z;
    jacobian->col(2) = -jacobian->leftCols<2>() * undistorted;
  }
  return InImage(*pixel);
}

bool CameraModel::UnprojectEquidistant(const Eigen::Vector2d& distorted,
                                       Eigen::Vector3d* ray) const {
  const double radius = distorted.norm();
  if (!(radius <= max_radius_ * (1 + 1e-12))) return false;
  const double theta = InvertMonotonic(
      [this](double angle) { return EquidistantRadius(k_, angle); }, radius, max_angle_);
  const double scale = radius > 0 ? std::sin(theta) / radius : 1;
  *ray << scale * distorted, std::cos(theta);
  return true;
}

bool CameraModel::UnprojectPinhole(const Eigen::Vector2d& distorted, Eigen::Vector3d* ray) const {
  const double radius = distorted.norm();
  if (!std::isfinite(radius)) return false;
  const bool tangential = HasTangentialPart(k_);
  if (!tangential && radius > max_radius_ * (1 + 1e-12)) return false;
  const double tangent = InvertMonotonic([this](double t) { return RadialRadius(k_, t); },
                                         std::min(radius, max_radius_), max_tangent_);
  Eigen::Vector2d undistorted = radius > 0 ? (tangent / radius) * distorted : distorted;
  if (tangential && !InvertRadialTangential(k_, distorted, max_tangent_, &undistorted)) {
    return false;
  }
  *ray = Eigen::Vector3d(undistorted.x(), undistorted.y(), 1).normalized();
  return true;
}

}  // namespace kestrel
