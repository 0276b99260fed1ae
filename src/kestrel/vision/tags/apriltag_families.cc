// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/apriltag_families.h"

#include <algorithm>
#include <array>

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

namespace kestrel {
namespace {

constexpr std::array<AprilTagFamily, 9> kAprilTagFamilies{{
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
}};

}  // namespace

std::span<const AprilTagFamily> AprilTagFamilies() { return kAprilTagFamilies; }

const AprilTagFamily* FindAprilTagFamily(std::string_view name) {
  const auto known = std::find_if(kAprilTagFamilies.begin(), kAprilTagFamilies.end(),
                                  [name](const AprilTagFamily& each) { return each.name == name; });
  return known == kAprilTagFamilies.end() ? nullptr : &*known;
}

}  // namespace kestrel
