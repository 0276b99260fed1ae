// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// Merges the objects of one map into 'fused', all of one world and at one time. Two objects of one
// shape and colour that are as near as their covariances allow are one; the assignment has the
// least total cost. Objects of one map stay apart. Returns the index in 'fused' of each of
// 'objects'.
std::vector<std::size_t> FuseObjects(const std::vector<MappedObject>& objects,
                                     std::vector<MappedObject>* fused);

}  // namespace kestrel
