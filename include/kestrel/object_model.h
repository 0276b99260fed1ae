// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The colours and the classes of the objects to find, from a file or as in the paper.
//
// Example:
//   ObjectModel model = ReadObjectModel("objects.yaml");
//   std::erase_if(model.classes,
//                 [](const ObjectClass& each) { return each.shape != ObjectShape::kDisc; });
//   std::cout << PrintObjectModel(model);

#include "kestrel/vision/objects/object_model.h"  // IWYU pragma: export
