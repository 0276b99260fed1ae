// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/vision/landing/score/detection_choice.h"
#include "kestrel/vision/landing/search/landing_models.h"
#include "kestrel/vision/landing/search/prior_knowledge.h"
#include "kestrel/vision/landing/search/searched_image.h"
#include "kestrel/vision/target/search_log.h"

namespace kestrel {

// The parts of one search that every verifier uses. They must outlive the verifiers.
struct SearchContext {
  const LandingModels& models;
  const PriorKnowledge& prior;
  SearchedImage& image;
  DetectionChoice& choice;
  SearchLog& log;
};

}  // namespace kestrel
