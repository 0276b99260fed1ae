// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/cone.h"
#include "kestrel/vision/landing/candidates/dark_areas.h"
#include "kestrel/vision/landing/candidates/ring_arcs.h"
#include "kestrel/vision/landing/candidates/ring_fit.h"
#include "kestrel/vision/landing/search/landing_models.h"
#include "kestrel/vision/landing/search/searched_image.h"

namespace kestrel {

// Search reach for the edges of a ring.
struct RingReach {
  static constexpr double kSure = 0.02;  // share of its diameter, where a circle fits
  static constexpr double kLeastPx = 2;
};

// Scales of a ring that is as large as it seems.
inline constexpr std::array<double, 1> kOneScale{1.0};

// Returns the axes (diameters, px, the longer one first) of the image of a ring. They are those of
// its projection, because a fisheye lens stretches near its rim. Where the lens does not show the
// ring, they follow from its angles.
Eigen::Vector2d RingDiametersPx(const CameraModel& camera, double radius_m, const CirclePose& ring);

// True when the strokes of a ring with these diameters are hardly wider than the blur, everywhere
// or in places. Such a print is fitted as a whole, a larger one is examined by its edges.
bool IsSmallRing(const Eigen::Vector2d& diameters_px);

// A candidate: a part of the image that may be the ring.
struct RingCandidate {
  std::array<CirclePose, 2> poses;  // the two mirror poses of its circle
  Eigen::Vector2d diameters_px;
  bool is_small;    // see IsSmallRing
  double reach_px;  // its edges are within this distance
  // Factors by which the ring may be smaller than it seems, for an outline that has grown together
  // with something beside it.
  std::span<const double> scales;
};

// Memory of RingFinder. Does not allocate once it is reserved.
struct RingFinderBuffers {
  static constexpr std::size_t kMaxRays = 48;  // rays along one border

  struct Outline {
    Ellipse outer_edge;                // outer edge of the ring, pixels of the image of the pass
    RingEdge edge = RingEdge::kOuter;  // the edge of the ring that was seen
    bool board = false;      // true when the white board around the ring was seen, not the ring
    std::size_t border = 0;  // index in the tracer of the pass
    double contrast = 0;     // contrast of ring and white, gray values
  };
  std::vector<Outline> outlines;
  std::vector<Eigen::Vector3d> rays;
  RingArcsWorkspace arcs;
  std::vector<RingCandidate> candidates;

  void Reserve(std::size_t most_border_points);
};

// Finds ring candidates among the borders of a pass (paper, sections 2.1 to 2.3).
class RingFinder {
 public:
  // The arguments must outlive the finder.
  RingFinder(const LandingModels& models, RingFinderBuffers* buffers, SearchLog* log);

  // Each returns candidates, valid until the next call. In areas, those of the highest contrast
  // come first.
  std::span<const RingCandidate> FindInAreas(SearchedImage* image, std::size_t pass);
  std::span<const RingCandidate> FindInCutAreas(SearchedImage* image, std::size_t pass);
  std::span<const RingCandidate> FindInArcs(SearchedImage* image, std::size_t pass);

 private:
  using Outline = RingFinderBuffers::Outline;

  void CollectOutlines(const cv::Mat& image, const BorderTracer& tracer, const SearchPass& pass);
  void AddOutline(const Outline& outline, const BorderTracer& tracer, const ImageRegion& region);
  bool AddRay(const Eigen::Vector2d& pixel);
  std::optional<RingFit> FitToBorder(const Outline& outline, const BorderTracer& tracer,
                                     const ImageRegion& region);
  std::optional<RingFit> FitToOutline(const Outline& outline, const ImageRegion& region);
  bool StandsOut(const SearchedImage& image, const CirclePose& ring) const;
  void Add(const RingFit& ring, const Eigen::Vector2d& diameters_px, bool is_small, double reach_px,
           std::span<const double> scales);

  const LandingModels& models_;
  double focal_px_;
  RingFinderBuffers& buffers_;
  SearchLog& log_;
};

}  // namespace kestrel
