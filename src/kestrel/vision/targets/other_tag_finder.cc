// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/other_tag_finder.h"

#include <algorithm>
#include <string>

#include "kestrel/vision/tags/tag_search.h"

namespace kestrel {

OtherTagFinder::OtherTagFinder(const CameraModel& camera, const TagBoard& board)
    : camera_(camera), id_(board.tags.front().id) {
  const BoardTag& tag = board.tags.front();
  if (!tag.IsOfFamily()) return;
  reader_.emplace(tag.family, tag.inverted);
  const std::vector<std::string>& names = TagFamily::Names();
  family_ = *std::find(names.begin(), names.end(), tag.family);
  for (const BoardTag& own : board.tags) {
    if (own.family == tag.family) own_ids_.push_back(own.id);
  }
}

std::optional<int> OtherTagFinder::Find(const cv::Mat& image, TargetWorkspace* searched) const {
  if (!reader_) return std::nullopt;
  auto& buffers = dynamic_cast<TagSearchBuffers&>(*searched);
  for (const TagQuad& quad : buffers.quads.quads) {
    const auto reading = reader_->Read(image, camera_, quad, &buffers.pad.samples);
    if (!reading || reading->wrong_bits > 0) continue;
    if (std::find(own_ids_.begin(), own_ids_.end(), reading->id) == own_ids_.end()) {
      return reading->id;
    }
  }
  return std::nullopt;
}

}  // namespace kestrel
