// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/tags/board_alignment.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/board_samples.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/tag_quads.h"
#include "kestrel/vision/target/landing_detection.h"

namespace kestrel {

// What a search works with; constant, of one detector.
struct TagSearchModels {
  const CameraModel& camera;
  const BoardModel& board;
  const TagBoardDetectorOptions& options;
  const TagQuadFinder& finder;
  const BoardAlignment& alignment;
};

// Memory of one thread's searches.
struct TagSearchBuffers {
  TagQuadBuffers quads;
  BoardSamples cells;
  BoardAlignmentBuffers alignment;
};

// The search of one image. Does not allocate once the buffers have warmed up.
class TagSearch {
 public:
  TagSearch(const TagSearchModels& models, const cv::Mat& image, const LandingHint& hint,
            TagSearchBuffers* buffers);

  LandingReport Run();

 private:
  // A pose with what speaks for it.
  struct Finding {
    AlignedBoard aligned;
    double evidence = 0;  // natural logarithm of the odds
    SeenParts parts;
  };

  void Follow();
  void Search();
  void SearchPass(const cv::Rect& part, int pass);
  std::optional<RigidTransform> ShiftedPose(const RigidTransform& expected, const TagModel& tag);
  const TagModel* LeadingTag(const RigidTransform& pose);
  cv::Rect SearchedPart() const;
  bool MayHaveSize(int pass) const;
  // Aligns all tags, and reports the pose if it is likelier than what was found before.
  // 'prior': logarithm of the odds against a board at any of the places that were tried.
  void Take(const RigidTransform& pose, double prior, DetectionMethod method);
  Finding Judge(const AlignedBoard& aligned);
  void Report(const Finding& finding, double logit, DetectionMethod method);
  void ResolveMirror(Finding* finding, std::optional<RigidTransform>* mirror);
  void Reached(LandingStage stage, std::string_view reason);
  bool is_found() const { return report_.detection.has_value(); }

  const TagSearchModels& models_;
  const cv::Mat& image_;
  const LandingHint& hint_;
  TagSearchBuffers& buffers_;
  LevelPrior prior_;
  LandingReport report_;
};

}  // namespace kestrel
