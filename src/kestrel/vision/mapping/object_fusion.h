// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// Puts the objects of one map to those of others, all of one world and one time: two of one shape
// and colour that are as near to each other as their covariances allow are one, and the assignment
// is the cheapest in all. Those of one map stay apart. The index in 'fused' of each of 'objects'.
std::vector<std::size_t> FuseObjects(const std::vector<MappedObject>& objects,
                                     const ObjectMapOptions& options,
                                     std::vector<MappedObject>* fused);

}  // namespace kestrel
