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
#include "kestrel/vision/landing/dark_areas.h"
#include "kestrel/vision/landing/landing_models.h"
#include "kestrel/vision/landing/ring_arcs.h"
#include "kestrel/vision/landing/ring_fit.h"
#include "kestrel/vision/landing/searched_image.h"

namespace kestrel {

// Axes (diameters, px, the longer one first) of the image of the ring whose circle lies so: near
// its rim a fisheye lens stretches what it shows. By its angles where it leaves the lens.
Eigen::Vector2d RingDiametersPx(const CameraModel& camera, double radius_m, const CirclePose& ring);

// Whether the strokes of a ring with such diameters are hardly wider than the blur, everywhere or
// somewhere: then the print is looked at as a whole, else by its edges.
bool IsSmallRing(const Eigen::Vector2d& diameters_px);

// Something in the image that may be the ring.
struct RingCandidate {
  std::array<CirclePose, 2> poses;  // of the circle that looks so, mirror images of each other
  Eigen::Vector2d diameters_px;
  bool is_small;    // see IsSmallRing
  double reach_px;  // within which its edges are
  // How many times smaller it may be than it seems, as an outline that has grown together with
  // something is.
  std::span<const double> scales;
};

// Memory of RingFinder, which does not allocate once it is reserved.
struct RingFinderBuffers {
  static constexpr std::size_t kMaxRays = 48;  // of a border

  struct Outline {
    Ellipse outer_edge;                // of the ring, pixels of the image of the pass
    RingEdge edge = RingEdge::kOuter;  // which edge of it was seen
    bool board = false;                // seen was the white board around it
    std::size_t border = 0;            // in the tracer of the pass
    double contrast = 0;               // of ring and white, gray values
  };
  std::vector<Outline> outlines;
  std::vector<Eigen::Vector3d> rays;
  RingArcsWorkspace arcs;
  std::vector<RingCandidate> candidates;

  void Reserve(std::size_t most_border_points);
};

// Finds what may be the ring among the borders of a pass (paper, sections 2.1 to 2.3).
class RingFinder {
 public:
  // The arguments must outlive the finder.
  RingFinder(const LandingModels& models, RingFinderBuffers* buffers, SearchLog* log);

  // What stands out most first; good until the next call.
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
