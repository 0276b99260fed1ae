// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The map of objects: detections in the world in, confirmed objects out, each counted once.
//
// Example:
//   struct Everywhere : FieldOfView {
//     bool Shows(const MappedObject&) const override { return true; }
//   };
//   ObjectMap map(DefaultObjectModel(), {});
//   const ObjectMeasurement disc{.position = {3, 1, 0},
//                                .covariance = 0.01 * Eigen::Matrix3d::Identity()};
//   map.Update(time, std::array{disc}, Everywhere());
//   std::cout << map.Confirmed().size() << " objects\n";

#include "kestrel/vision/mapping/object_map.h"  // IWYU pragma: export
