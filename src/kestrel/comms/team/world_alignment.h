// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Transform from the world of one UAV's navigation to another's. Both are level: they differ by a
// translation and a rotation about the vertical.
struct WorldAlignment {
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();        // centre of the rotation, in the first
                                                          // world
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m, of the pivot
  double yaw = 0;                                         // rad, from x to y
  // Covariance of translation and yaw.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  WorldAlignment Inverse() const;
  // Applies 'first' and then this one.
  WorldAlignment operator*(const WorldAlignment& first) const;
  bool operator==(const WorldAlignment& other) const;
};

// Moves the object to the other world; its covariance grows by the alignment's.
void MoveToWorld(const WorldAlignment& alignment, MappedObject* object);

// Prior for the difference of two worlds: standard deviations per axis and of the yaw, rad.
struct WorldPrior {
  double translation_sigma_m;
  double yaw_sigma;
};

// Returns the identity with the uncertainty of the prior, about the middle of these objects.
WorldAlignment UnknownAlignment(const std::vector<MappedObject>& objects, const WorldPrior& prior);

// An alignment, and the number of pairs of objects that agree on it.
struct FoundAlignment {
  WorldAlignment alignment;
  std::size_t matches = 0;
};

// Returns the alignment from the world of 'objects' to that of 'reference', from the standing
// objects in both: pairs of one shape and colour that agree on one alignment, and the least squares
// of all of them. Nothing where that is not certain: fewer than three agree, nearly as many agree
// on another alignment, or it is not better than 0.3 m and 1 degree. A pure function of its
// arguments.
std::optional<FoundAlignment> EstimateAlignment(const std::vector<MappedObject>& objects,
                                                const std::vector<MappedObject>& reference,
                                                const WorldPrior& prior);

}  // namespace kestrel
