// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include <apriltag/apriltag.h>

namespace kestrel {

// A family of libapriltag.
struct AprilTagFamily {
  std::string_view name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

// Returns all families, in the order in which they are explained.
std::span<const AprilTagFamily> AprilTagFamilies();

// Returns the family of that name, nullptr where libapriltag has none.
const AprilTagFamily* FindAprilTagFamily(std::string_view name);

}  // namespace kestrel
