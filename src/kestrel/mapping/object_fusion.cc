// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/object_fusion.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "kestrel/mapping/assignment.h"

namespace kestrel {
namespace {

double SquaredDistance(const MappedObject& a, const MappedObject& b, double shared_sigma_m) {
  if (a.shape != b.shape || a.color_index() != b.color_index()) return kImpossibleCost;
  Eigen::Matrix3d covariance =
      a.covariance.topLeftCorner<3, 3>() + b.covariance.topLeftCorner<3, 3>();
  // The navigation of each UAV has its own bias.
  covariance.diagonal().array() += 2 * shared_sigma_m * shared_sigma_m;
  const Eigen::Vector3d difference = a.position() - b.position();
  return difference.dot(covariance.llt().solve(difference));
}

}  // namespace

std::vector<std::size_t> FuseObjects(const std::vector<MappedObject>& objects,
                                     const ObjectMapOptions& options,
                                     std::vector<MappedObject>* fused) {
  const auto rows = static_cast<Eigen::Index>(objects.size());
  const auto known = static_cast<Eigen::Index>(fused->size());
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(rows, known + rows, kImpossibleCost);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < known; ++k) {
      const double distance = SquaredDistance(objects[i], (*fused)[k], options.shared_sigma_m);
      if (distance <= options.gate) costs(i, k) = distance;
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
