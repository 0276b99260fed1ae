// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/object_fusion.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "kestrel/mapping/assignment.h"

namespace kestrel {
namespace {

// Squared Mahalanobis distance; kImpossibleCost for one that is beyond the gate.
double SquaredDistance(const MappedObject& a, const MappedObject& b,
                       const ObjectMapOptions& options) {
  Eigen::Matrix3d covariance =
      a.covariance.topLeftCorner<3, 3>() + b.covariance.topLeftCorner<3, 3>();
  // The navigation of each UAV has its own bias.
  covariance.diagonal().array() += 2 * options.shared_sigma_m * options.shared_sigma_m;
  const Eigen::Vector3d difference = a.position() - b.position();
  // No variance along any direction is above the trace: most pairs need no solver.
  if (difference.squaredNorm() > options.gate * covariance.trace()) return kImpossibleCost;
  const double distance = difference.dot(covariance.llt().solve(difference));
  return distance <= options.gate ? distance : kImpossibleCost;
}

std::vector<std::size_t> ColorsOf(const std::vector<MappedObject>& objects) {
  std::vector<std::size_t> colors;
  for (const MappedObject& object : objects) colors.push_back(object.color_index());
  return colors;
}

}  // namespace

std::vector<std::size_t> FuseObjects(const std::vector<MappedObject>& objects,
                                     const ObjectMapOptions& options,
                                     std::vector<MappedObject>* fused) {
  const auto rows = static_cast<Eigen::Index>(objects.size());
  const auto known = static_cast<Eigen::Index>(fused->size());
  const std::vector<std::size_t> colors = ColorsOf(objects);
  const std::vector<std::size_t> known_colors = ColorsOf(*fused);
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(rows, known + rows, kImpossibleCost);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < known; ++k) {
      if (objects[i].shape != (*fused)[k].shape || colors[i] != known_colors[k]) continue;
      costs(i, k) = SquaredDistance(objects[i], (*fused)[k], options);
    }
    costs(i, known + i) = options.gate;
  }
  AssignmentSolver solver;
  const std::vector<int>& columns = solver.Solve(costs);
  std::vector<std::size_t> indices;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const bool is_known = columns[i] < known;
    indices.push_back(is_known ? columns[i] : fused->size());
    if (is_known) {
      UnifyObjects(objects[i], &(*fused)[columns[i]]);
    } else {
      fused->push_back(objects[i]);
    }
  }
  return indices;
}

}  // namespace kestrel
