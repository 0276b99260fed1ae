// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/pads/pad_map.h"

#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCornerSigmaPx = 0.2;  // also what is left of a lens that is nearly right
constexpr double kCauchy = 3;           // standard deviations of a corner

using PadVector = std::array<double, 3>;   // x, y, yaw
using ViewVector = std::array<double, 6>;  // camera from map: rotation vector, translation

RigidTransform MapFromPad(const PadVector& pad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(pad[2], Vector3d::UnitZ())), {pad[0], pad[1], 0}};
}

PadVector InPlane(const RigidTransform& map_from_pad) {
  return {map_from_pad.translation.x(), map_from_pad.translation.y(),
          HeadingOf(map_from_pad.rotation)};
}

ViewVector ViewOf(const RigidTransform& camera_from_map) {
  const Vector3d turn = RotationVector(camera_from_map.rotation);
  const Vector3d& place = camera_from_map.translation;
  return {turn.x(), turn.y(), turn.z(), place.x(), place.y(), place.z()};
}

// A corner of a pad, across the ray on which an image shows it, in standard deviations.
struct CornerError {
  template <class T>
  bool operator()(const T* pad, const T* view, T* residual) const {
    const T in_map[3] = {pad[0] + cos(pad[2]) * corner.x() - sin(pad[2]) * corner.y(),
                         pad[1] + sin(pad[2]) * corner.x() + cos(pad[2]) * corner.y(), T(0)};
    T point[3];
    ceres::AngleAxisRotatePoint(view, in_map, point);
    Eigen::Matrix<T, 3, 1> ray(point[0] + view[3], point[1] + view[4], point[2] + view[5]);
    ray.normalize();
    const Eigen::Matrix<T, 2, 1> off = across.cast<T>() * ray;
    residual[0] = per_radian * off.x();
    residual[1] = per_radian * off.y();
    return true;
  }

  Vector2d corner;                     // in the pad
  Eigen::Matrix<double, 2, 3> across;  // axes across the ray
  double per_radian;
};

Eigen::Matrix<double, 2, 3> AxesAcross(const Vector3d& ray) {
  Eigen::Matrix<double, 2, 3> axes;
  axes.row(0) = ray.unitOrthogonal().transpose();
  axes.row(1) = ray.cross(Vector3d(axes.row(0).transpose())).transpose();
  return axes;
}

class Adjustment {
 public:
  Adjustment(std::span<const std::vector<PadSighting>> images, std::span<const double> sizes_m,
             double focal_px)
      : images_(images),
        sizes_m_(sizes_m),
        focal_px_(focal_px),
        pads_(sizes_m.size()),
        views_(images.size()) {}

  PadMap Run() {
    Connect();
    ceres::Problem problem;
    for (std::size_t i = 0; i < images_.size(); ++i) AddImage(i, &problem);
    PadMap map;
    map.places.resize(pads_.size());
    if (problem.NumResiduals() == 0) {
      throw InputError("no image shows the first pad beside another one");
    }
    problem.SetParameterBlockConstant(pads_[0]->data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.max_num_iterations = 200;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) throw InputError("no places agree with these images");
    Describe(&problem, &map);
    return map;
  }

 private:
  // Finds a first place of each pad by the images that show it beside one whose place is found.
  void Connect() {
    pads_[0] = PadVector{0, 0, 0};
    for (bool is_new = true; std::exchange(is_new, false);) {
      for (std::size_t i = 0; i < images_.size(); ++i) {
        if (!views_[i]) views_[i] = FirstView(images_[i]);
        if (!views_[i]) continue;
        for (const PadSighting& seen : images_[i]) {
          if (pads_[seen.pad]) continue;
          pads_[seen.pad] = InPlane(MapFromCamera(*views_[i]) * seen.camera_from_pad);
          is_new = true;
        }
      }
    }
  }
  static RigidTransform MapFromCamera(const ViewVector& view) {
    return RigidTransform{RotationBy({view[0], view[1], view[2]}), {view[3], view[4], view[5]}}
        .Inverse();
  }
  // Returns a first view by the nearest pad that is known; nothing: the image shows no other pad.
  std::optional<ViewVector> FirstView(const std::vector<PadSighting>& image) const {
    if (image.size() < 2) return std::nullopt;
    const PadSighting* nearest = nullptr;
    for (const PadSighting& seen : image) {
      if (!pads_[seen.pad]) continue;
      if (nearest == nullptr ||
          seen.camera_from_pad.translation.norm() < nearest->camera_from_pad.translation.norm()) {
        nearest = &seen;
      }
    }
    if (nearest == nullptr) return std::nullopt;
    return ViewOf(nearest->camera_from_pad * MapFromPad(*pads_[nearest->pad]).Inverse());
  }

  void AddImage(std::size_t i, ceres::Problem* problem) {
    if (!views_[i]) return;
    ++used_;
    for (const PadSighting& seen : images_[i]) {
      for (const auto& [x, y] : {std::pair{-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}}) {
        const Vector2d corner = sizes_m_[seen.pad] * Vector2d(x, y);
        const Vector3d ray =
            (seen.camera_from_pad * Vector3d(corner.x(), corner.y(), 0)).normalized();
        problem->AddResidualBlock(
            new ceres::AutoDiffCostFunction<CornerError, 2, 3, 6>(
                new CornerError{corner, AxesAcross(ray), focal_px_ / kCornerSigmaPx}),
            new ceres::CauchyLoss(kCauchy), pads_[seen.pad]->data(), views_[i]->data());
      }
    }
  }

  void Describe(ceres::Problem* problem, PadMap* map) const {
    std::vector<double> residuals;
    ceres::Problem::EvaluateOptions plain;
    plain.apply_loss_function = false;
    problem->Evaluate(plain, nullptr, &residuals, nullptr, nullptr);
    double sum = 0;
    for (const double residual : residuals) sum += residual * residual;
    map->rms_px = kCornerSigmaPx * std::sqrt(sum / static_cast<double>(residuals.size()));
    map->images = used_;
    ceres::Covariance covariance{ceres::Covariance::Options()};
    std::vector<const double*> blocks;
    for (std::size_t pad = 1; pad < pads_.size(); ++pad) {
      if (pads_[pad]) blocks.push_back(pads_[pad]->data());
    }
    if (!covariance.Compute(blocks, problem)) {
      throw InputError("these images do not determine the places of the pads");
    }
    for (std::size_t pad = 0; pad < pads_.size(); ++pad) {
      if (!pads_[pad]) continue;
      PadPlace& place = map->places[pad].emplace();
      const auto& [x, y, yaw] = *pads_[pad];
      place.position = {x, y};
      place.yaw = std::remainder(yaw, 2 * M_PI);
      place.images = ImagesOf(pad);
      if (pad > 0) SetSigmas(covariance, pads_[pad]->data(), &place);
    }
  }
  int ImagesOf(std::size_t pad) const {
    int count = 0;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      if (!views_[i]) continue;
      for (const PadSighting& seen : images_[i]) count += seen.pad == pad ? 1 : 0;
    }
    return count;
  }
  static void SetSigmas(const ceres::Covariance& covariance, const double* block, PadPlace* place) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> matrix;
    covariance.GetCovarianceBlock(block, block, matrix.data());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(matrix.topLeftCorner<2, 2>());
    place->position_sigma_m = std::sqrt(axes.eigenvalues().maxCoeff());
    place->yaw_sigma = std::sqrt(matrix(2, 2));
  }

  std::span<const std::vector<PadSighting>> images_;
  std::span<const double> sizes_m_;
  double focal_px_;
  std::vector<std::optional<PadVector>> pads_;
  std::vector<std::optional<ViewVector>> views_;
  int used_ = 0;
};

}  // namespace

PadMap EstimatePadMap(std::span<const std::vector<PadSighting>> images,
                      std::span<const double> sizes_m, double focal_px) {
  return Adjustment(images, sizes_m, focal_px).Run();
}

}  // namespace kestrel
