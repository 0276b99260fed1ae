// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/helipad/helipad_candidates.h"
#include "kestrel/vision/helipad/helipad_model.h"
#include "kestrel/vision/search/pad_search.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

// Constants of the searches of one detector.
struct HelipadSearchModels {
  PadSearchModels search;
  const HelipadModel& pad;
  const HelipadFinder& finder;
  double min_quality;
};

// Memory of one thread's searches.
struct HelipadSearchBuffers : TargetWorkspace {
  HelipadCandidateBuffers candidates;
  PadSearchBuffers pad;
};

// The search of one image for a helipad.
class HelipadSearch final : public PadSearch {
 public:
  HelipadSearch(const HelipadSearchModels& models, const cv::Mat& image, const TargetHint& hint,
                HelipadSearchBuffers* buffers);

 private:
  void Follow(const RigidTransform& expected) override;
  void Begin(const cv::Rect& part) override;
  int Steps() const override;
  void SearchStep(const cv::Rect& part, int step) override;
  bool MayHaveSize(int pass, double distance_m, double error) const override;

  void Try(const HelipadCandidate& candidate);
  // Returns the affine map from the pad to the plane under which the image looks most like an H.
  std::optional<Eigen::Matrix2d> BestTurn(const HelipadCandidate& candidate);
  // Aligns all edges, and reports the pose if it is likelier than what was found before.
  // 'prior': logarithm of the odds against a helipad at any of the places that were tried.
  void Take(const RigidTransform& pose, double prior, DetectionMethod method);
  // Returns the probability that the pad is there.
  double QualityOf(const AlignedPad& aligned, double prior, DimSample dim);
  // Number of points of the H's edges that the image should show.
  int EdgesInView(const RigidTransform& pose) const;
  void Report(const AlignedPad& found, double quality, DetectionMethod method);
  double StrokePx(const RigidTransform& pose) const;

  const HelipadSearchModels& helipad_;
  HelipadCandidateBuffers& candidates_;
  bool may_be_in_glare_ = false;
  bool is_linear_ = false;  // the gray values are searched, not their logarithms
};

}  // namespace kestrel
