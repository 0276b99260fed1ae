// SPDX-License-Identifier: BSD-3-Clause
#include "apriltag_peer.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/tags/apriltag_families.h"

namespace kestrel {
namespace {

std::shared_ptr<apriltag_family_t> FamilyOf(const std::string& name) {
  const AprilTagFamily* const known = FindAprilTagFamily(name);
  if (known == nullptr) throw InputError(fmt::format("libapriltag has no family {}", name));
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
