// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/object_fusion.h"

#include <cstdint>
#include <map>

#include <Eigen/Cholesky>

#include "kestrel/vision/mapping/assignment.h"

namespace kestrel {
namespace {

// The part of an object that excludes most pairs. It is small, because all are compared with all.
struct Outline {
  Eigen::Vector3d position;
  double trace;  // trace of the position's covariance
  std::size_t color;
  ObjectShape shape;
};

std::vector<Outline> OutlinesOf(const std::vector<MappedObject>& objects) {
  std::vector<Outline> outlines;
  outlines.reserve(objects.size());
  for (const MappedObject& object : objects) {
    outlines.push_back({object.position(), object.covariance.topLeftCorner<3, 3>().trace(),
                        object.color_index(), object.shape});
  }
  return outlines;
}

// Squared Mahalanobis distance.
double SquaredDistance(const MappedObject& a, const MappedObject& b, double shared_variance) {
  Eigen::Matrix3d covariance =
      a.covariance.topLeftCorner<3, 3>() + b.covariance.topLeftCorner<3, 3>();
  covariance.diagonal().array() += shared_variance;
  const Eigen::Vector3d difference = a.position() - b.position();
  return difference.dot(covariance.llt().solve(difference));
}

// A known object that an object may be.
struct Pairing {
  std::size_t known;
  double cost;
};

// Returns for each object the known ones that it may be.
std::vector<std::vector<Pairing>> FindPairings(const std::vector<MappedObject>& objects,
                                               const std::vector<MappedObject>& known) {
  // Each UAV's navigation has its own bias.
  const double shared_variance =
      2 * ObjectMapOptions::kSharedSigma_m * ObjectMapOptions::kSharedSigma_m;
  const std::vector<Outline> outlines = OutlinesOf(objects);
  const std::vector<Outline> known_outlines = OutlinesOf(known);
  std::vector<std::vector<Pairing>> pairings(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Outline& a = outlines[i];
    for (std::size_t k = 0; k < known.size(); ++k) {
      const Outline& b = known_outlines[k];
      if (a.color != b.color || a.shape != b.shape) continue;
      // The variance along any direction is at most the trace, so most pairs need no solver.
      const double trace = a.trace + b.trace + 3 * shared_variance;
      if ((a.position - b.position).squaredNorm() > ObjectMapOptions::kGate * trace) continue;
      const double cost = SquaredDistance(objects[i], known[k], shared_variance);
      if (cost <= ObjectMapOptions::kGate) pairings[i].push_back({k, cost});
    }
  }
  return pairings;
}

constexpr std::size_t kNew = SIZE_MAX;

// Assigns each of 'rows', which have rivals, its known object or kNew, at the least total cost.
void AssignRivals(const std::vector<std::size_t>& rows,
                  const std::vector<std::vector<Pairing>>& pairings, double new_cost,
                  std::vector<std::size_t>* assigned) {
  std::map<std::size_t, Eigen::Index> column_of;
  for (const std::size_t row : rows) {
    for (const Pairing& pairing : pairings[row]) column_of.emplace(pairing.known, 0);
  }
  std::vector<std::size_t> known;
  for (auto& [index, column] : column_of) {
    column = std::ssize(known);
    known.push_back(index);
  }
  const Eigen::Index count = std::ssize(known);
  Eigen::MatrixXd costs =
      Eigen::MatrixXd::Constant(std::ssize(rows), count + std::ssize(rows), kImpossibleCost);
  for (Eigen::Index i = 0; i < std::ssize(rows); ++i) {
    for (const Pairing& pairing : pairings[rows[i]]) {
      costs(i, column_of[pairing.known]) = pairing.cost;
    }
    costs(i, count + i) = new_cost;
  }
  AssignmentSolver solver;
  const std::vector<int>& columns = solver.Solve(costs);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    (*assigned)[rows[i]] = columns[i] < count ? known[columns[i]] : kNew;
  }
}

// Returns for each object its known object, or kNew.
std::vector<std::size_t> Assign(const std::vector<std::vector<Pairing>>& pairings,
                                std::size_t known, double new_cost) {
  std::vector<int> claims(known);
  for (const auto& row : pairings) {
    for (const Pairing& pairing : row) ++claims[pairing.known];
  }
  std::vector<std::size_t> assigned(pairings.size(), kNew);
  std::vector<std::size_t> rivals;
  for (std::size_t i = 0; i < pairings.size(); ++i) {
    if (pairings[i].empty()) continue;
    const std::size_t only = pairings[i].front().known;
    if (pairings[i].size() == 1 && claims[only] == 1) {
      assigned[i] = only;
    } else {
      rivals.push_back(i);
    }
  }
  if (!rivals.empty()) AssignRivals(rivals, pairings, new_cost, &assigned);
  return assigned;
}

}  // namespace

std::vector<std::size_t> FuseObjects(const std::vector<MappedObject>& objects,
                                     std::vector<MappedObject>* fused) {
  std::vector<std::size_t> indices =
      Assign(FindPairings(objects, *fused), fused->size(), ObjectMapOptions::kGate);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (indices[i] == kNew) {
      indices[i] = fused->size();
      fused->push_back(objects[i]);
    } else {
      UnifyObjects(objects[i], &(*fused)[indices[i]]);
    }
  }
  return indices;
}

}  // namespace kestrel
