// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "kestrel/vision/landing/alignment/print_alignment.h"
#include "kestrel/vision/landing/candidates/ring_candidates.h"
#include "kestrel/vision/landing/candidates/ring_memory.h"
#include "kestrel/vision/landing/search/search_context.h"

namespace kestrel {

// Memory of NearPrintVerifier. Does not allocate once it is reserved.
struct NearPrintBuffers {
  RingMemory tested;
  RingMemory refused;  // rings whose edges were found and that are something else

  void Reserve();
};

// Tests whether a ring whose strokes are wide enough to have edges is that of the print, and
// locates it: looks for the cross inside, aligns the print with the edges of the image, measures
// the doubts and finds the pose (paper, sections 2.3 to 2.5).
class NearPrintVerifier {
 public:
  // 'buffers' must outlive the verifier.
  NearPrintVerifier(const SearchContext& search, NearPrintBuffers* buffers)
      : search_(search), buffers_(*buffers) {}

  void Test(const RingCandidate& ring);

  // Tests a ring near its predicted pose. 'predicted_px': diameters, the longer one first.
  void TestPredicted(const CirclePose& ring, const Eigen::Vector2d& predicted_px);

  // Tests a print whose cross was seen without a ring. 'region': of the image in which it was seen.
  void TestCross(const RigidTransform& pose, const ImageRegion& region);

 private:
  // A possible print: a ring with a cross inside, or a cross alone.
  struct Hypothesis {
    RigidTransform camera_from_target;
    double contrast;  // contrast of ring and white, gray values
  };

  std::optional<Hypothesis> FindCross(const RigidTransform& ring, double diameter_px);
  std::optional<RingLocation> RefineRing(const CirclePose& ring, double reach_px, int iterations);
  bool TestPrint(const Hypothesis& print, const Eigen::Vector2d& diameters_px, double reach_px,
                 std::span<const CirclePose> rings, const PriorKnowledge::Order& order);
  RigidTransform WithArmOf(const PrintAlignment& alignment, const CirclePose& ring) const;
  bool Locate(const PrintAlignment& alignment, const RigidTransform& initial, PrintFinding finding);
  void Refuse(const PrintFinding& finding, const PrintAlignment& alignment, double reach_px);
  static void DoubtEdges(const PrintAlignment& alignment, PrintFinding* finding);

  SearchContext search_;
  NearPrintBuffers& buffers_;
};

}  // namespace kestrel
