// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "kestrel/vision/search/pad_search.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/tag_quads.h"

namespace kestrel {

// Constants of the searches of one detector.
struct TagSearchModels {
  PadSearchModels search;
  const BoardModel& board;
  const TagQuadFinder& finder;
  double min_quality;
};

// Memory of one thread's searches. It keeps the quads of the last one.
struct TagSearchBuffers : TargetWorkspace {
  TagQuadBuffers quads;
  PadSearchBuffers pad;
};

// The search of one image for a board of tags.
class TagSearch final : public PadSearch {
 public:
  TagSearch(const TagSearchModels& models, const cv::Mat& image, const TargetHint& hint,
            TagSearchBuffers* buffers);

 private:
  void Follow(const RigidTransform& expected) override;
  void Begin(const cv::Rect& part) override;
  int Steps() const override;
  void SearchStep(const cv::Rect& part, int step) override;
  bool MayHaveSize(int pass, double distance_m, double error) const override;

  const TagModel* LeadingTag(const RigidTransform& pose);
  void Try(const TagQuad& quad);
  // Aligns 'tag', by which the pose was found, then all tags, and reports the pose if it is
  // likelier than what was found before. 'prior': logarithm of the odds against a board at any of
  // the places that were tried.
  void Take(const RigidTransform& pose, const TagModel& tag, double prior, DetectionMethod method);
  // 'aligned': a copy, as its mirror pose may replace it.
  void Report(AlignedPad aligned, const SeenParts& parts, double quality, DetectionMethod method);

  const TagSearchModels& tags_;
  TagQuadBuffers& quads_;
  int tried_ = 0;           // number of quads
  bool is_linear_ = false;  // the gray values are searched, not their logarithms
};

}  // namespace kestrel
