// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "kestrel/vision/landing/candidates/ring_candidates.h"
#include "kestrel/vision/landing/candidates/ring_memory.h"
#include "kestrel/vision/landing/search/search_context.h"
#include "kestrel/vision/landing/small_pattern/small_pattern.h"

namespace kestrel {

// Memory of SmallPrintVerifier. Does not allocate once it is reserved.
struct SmallPrintBuffers {
  SmallPatternWorkspace gray_values;
  RingMemory tested;

  void Reserve() { tested.Reserve(); }
};

// Tests whether a ring whose strokes are no wider than the blur is that of the print, and locates
// it, by fitting the whole print to the gray values (docs/small_pattern.md).
class SmallPrintVerifier {
 public:
  // 'buffers' must outlive the verifier.
  SmallPrintVerifier(const SearchContext& search, SmallPrintBuffers* buffers)
      : search_(search), buffers_(*buffers) {}

  void Test(const RingCandidate& ring);

  // Tests a ring near its predicted pose. 'diameters_px': the longer one first.
  void TestPredicted(const CirclePose& ring, const Eigen::Vector2d& diameters_px);

 private:
  // Result of testing one pose of a ring: kOtherPose means the other pose may still fit.
  enum class Outcome { kFound, kOtherPose, kNothing };

  bool IsTooSmall(const Eigen::Vector2d& diameters_px) const;
  Outcome TestPose(const CirclePose& pose, std::span<const double> scales);
  SmallPatternFitter::Start FindStart(const CirclePose& pose, std::span<const double> scales);
  std::optional<double> ArmAngle(const CirclePose& pose);
  std::optional<PrintFinding> FindingOf(const SmallPatternFitter::Fit& fit,
                                        SmallPatternFitter::Light light) const;

  SearchContext search_;
  SmallPrintBuffers& buffers_;
};

}  // namespace kestrel
