// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An object of the map: its position and motion with their covariance, its likeliest colour and
// digit.
//
// Example:
//   const ObjectModel model = DefaultObjectModel();
//   for (const MappedObject& object : LoadObjects("object_map.json")) {
//     std::cout << object.position().transpose() << ", score " << ScoreOf(object, model)
//               << (object.moves ? ", moves\n" : "\n");
//   }

#include "kestrel/vision/mapping/mapped_object.h"  // IWYU pragma: export
