// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/candidates/ring_candidates.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/landing/score/detection_choice.h"
#include "kestrel/vision/landing/search/landing_models.h"
#include "kestrel/vision/landing/search/prior_knowledge.h"
#include "kestrel/vision/landing/search/search_context.h"
#include "kestrel/vision/landing/search/search_plan.h"
#include "kestrel/vision/landing/search/searched_image.h"
#include "kestrel/vision/landing/verification/near_print_verifier.h"
#include "kestrel/vision/landing/verification/partial_pattern.h"
#include "kestrel/vision/landing/verification/small_print_verifier.h"
#include "kestrel/vision/target/search_log.h"

namespace kestrel {

struct LandingWorkspace::Buffers {
  SearchedImageBuffers image;
  RingFinderBuffers rings;
  PartialPatternWorkspace crosses;
  NearPrintBuffers near_prints;
  SmallPrintBuffers small_prints;

  // Reserves all memory that a search of an image of this size may need.
  void Reserve(const cv::Mat& image_of_that_size);
};

// Searches one image: first where the ring is predicted, then where it is likely, then everywhere.
class LandingSearch {
 public:
  // 'observer' may be null (see DetectionChoice). The arguments must outlive the search.
  LandingSearch(const LandingModels& models, const cv::Mat& image, const TargetHint& hint,
                LandingWorkspace::Buffers* buffers, const FindingObserver* observer = nullptr);

  TargetReport Run();

 private:
  void TestPrediction();
  void TakeSteps();
  void Take(const SearchStep& step);
  void TestCrosses(std::size_t pass);
  bool IsOutOfTime() const;

  const LandingModels& models_;
  const TargetHint& hint_;
  LandingWorkspace::Buffers& buffers_;
  std::chrono::steady_clock::time_point start_;
  TargetReport report_;
  SearchLog log_;
  PriorKnowledge prior_;
  SearchedImage image_;
  DetectionChoice choice_;
  RingFinder rings_;
  NearPrintVerifier near_prints_;
  SmallPrintVerifier small_prints_;
};

}  // namespace kestrel
