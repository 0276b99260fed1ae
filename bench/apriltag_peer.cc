// SPDX-License-Identifier: BSD-3-Clause
#include "apriltag_peer.h"

#include <algorithm>
#include <iterator>

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

struct Family {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr Family kFamilies[] = {
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

std::shared_ptr<apriltag_family_t> FamilyOf(const std::string& name) {
  const auto* const known = std::find_if(std::begin(kFamilies), std::end(kFamilies),
                                         [&](const Family& each) { return each.name == name; });
  if (known == std::end(kFamilies)) throw InputError(fmt::format("no peer has family {}", name));
  return {known->create(), known->destroy};
}

}  // namespace

AprilTagPeer::AprilTagPeer(const std::string& family, float decimate)
    : family_(FamilyOf(family)), detector_(apriltag_detector_create(), apriltag_detector_destroy) {
  apriltag_detector_add_family(detector_.get(), family_.get());
  detector_->nthreads = 1;
  detector_->quad_decimate = decimate;
}

std::vector<AprilTagPeer::Tag> AprilTagPeer::Find(const cv::Mat& image) const {
  image_u8_t view = {.width = image.cols,
                     .height = image.rows,
                     .stride = static_cast<int>(image.step[0]),
                     .buf = image.data};
  zarray_t* const all = apriltag_detector_detect(detector_.get(), &view);
  std::vector<Tag> tags;
  for (int i = 0; i < zarray_size(all); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(all, i, static_cast<void*>(&detection));
    Tag& tag = tags.emplace_back();
    tag.id = detection->id;
    // Half a pixel, because its pixels have integer borders.
    for (std::size_t k = 0; k < tag.corners.size(); ++k) {
      tag.corners[k] = Eigen::Vector2d(detection->p[k][0] - 0.5, detection->p[k][1] - 0.5);
    }
  }
  apriltag_detections_destroy(all);
  return tags;
}

}  // namespace kestrel
