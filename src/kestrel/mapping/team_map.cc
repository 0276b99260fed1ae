// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/mapping/team_map.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "kestrel/mapping/assignment.h"
#include "kestrel/mapping/map_file.h"

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

void FuseInto(const std::vector<MappedObject>& objects, const ObjectMapOptions& options,
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
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (columns[i] < known) {
      UnifyObjects(objects[i], &(*fused)[columns[i]]);
    } else {
      fused->push_back(objects[i]);
    }
  }
}

}  // namespace

void TeamMap::Put(const std::string& uav, const UavMap& map) {
  const auto [known, is_new] = maps_.try_emplace(uav, map);
  if (is_new || map.version < known->second.version) return;
  if (map.version > known->second.version ||
      PrintObjects(map.objects) > PrintObjects(known->second.objects)) {
    known->second = map;
  }
}

void TeamMap::Merge(const TeamMap& other) {
  for (const auto& [uav, map] : other.maps_) Put(uav, map);
}

std::vector<MappedObject> TeamMap::Fused(const ObjectMapOptions& options) const {
  Time newest = Time::min();
  for (const auto& [uav, map] : maps_) {
    for (const MappedObject& object : map.objects) newest = std::max(newest, object.time);
  }
  std::vector<MappedObject> fused;
  for (const auto& [uav, map] : maps_) {
    std::vector<MappedObject> objects = map.objects;
    for (MappedObject& object : objects) {
      PredictObject(newest, options.motion(), &object);
    }
    FuseInto(objects, options, &fused);
  }
  for (std::size_t i = 0; i < fused.size(); ++i) fused[i].id = static_cast<std::int64_t>(i) + 1;
  return fused;
}

}  // namespace kestrel
