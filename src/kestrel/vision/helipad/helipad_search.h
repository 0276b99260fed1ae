// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/helipad/helipad_candidates.h"
#include "kestrel/vision/helipad/helipad_detector.h"
#include "kestrel/vision/helipad/helipad_model.h"
#include "kestrel/vision/tags/board_alignment.h"
#include "kestrel/vision/tags/board_samples.h"
#include "kestrel/vision/target/landing_detection.h"

namespace kestrel {

// What a search works with; constant, of one detector.
struct HelipadSearchModels {
  const CameraModel& camera;
  const HelipadModel& pad;
  const HelipadDetectorOptions& options;
  const HelipadFinder& finder;
  const BoardAlignment& alignment;
};

// Memory of one thread's searches.
struct HelipadSearchBuffers {
  HelipadCandidateBuffers candidates;
  BoardSamples samples;
  BoardAlignmentBuffers alignment;
};

// The search of one image. Does not allocate once the buffers have warmed up.
class HelipadSearch {
 public:
  HelipadSearch(const HelipadSearchModels& models, const cv::Mat& image, const LandingHint& hint,
                HelipadSearchBuffers* buffers);

  LandingReport Run();

 private:
  void Follow();
  void Search();
  void SearchPass(const cv::Rect& part, int pass);
  void Try(const HelipadCandidate& candidate);
  // Returns the affine map from the pad to the plane under which the image looks most like an H.
  std::optional<Eigen::Matrix2d> BestTurn(const HelipadCandidate& candidate);
  std::optional<RigidTransform> ShiftedPose(const RigidTransform& expected);
  cv::Rect SearchedPart() const;
  bool MayHaveSize(int pass) const;
  // Aligns all edges, and reports the pose if it is likelier than what was found before.
  // 'prior': logarithm of the odds against a helipad at any of the places that were tried.
  void Take(const RigidTransform& pose, double prior, DetectionMethod method);
  // Returns the probability that the pad is there.
  double QualityOf(const AlignedBoard& aligned, double prior);
  // Number of points of the H's edges that the image should show.
  int EdgesInView(const RigidTransform& pose) const;
  void Report(const AlignedBoard& aligned, double quality, DetectionMethod method);
  void SampleAt(const RigidTransform& pose);
  void Reached(LandingStage stage, std::string_view reason);
  bool is_found() const { return report_.detection.has_value(); }

  const HelipadSearchModels& models_;
  const cv::Mat& image_;
  const LandingHint& hint_;
  HelipadSearchBuffers& buffers_;
  LevelPrior prior_;
  LandingReport report_;
};

}  // namespace kestrel
