// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/image/black_top_hat.h"
#include "kestrel/core/image/border_tracing.h"
#include "kestrel/core/image/local_threshold.h"

namespace kestrel {

// One of the passes of a search, each over the image at another resolution.
struct BorderPass {
  int image_level;  // the image at 1 / 2^level
  int tile_level;   // tiles of 2^tile_level pixels make the threshold's box
  int min_px;       // least and largest extent of a figure, full resolution
  int max_px;
  int least_extent;     // least extent of a traced border, pixels of the level
  bool at_rim = false;  // also figures that the rim of the image bounds above
};

// Memory of one thread's borders.
struct BorderBuffers {
  int width_px = 0;  // size of the image that it was reserved for
  int height_px = 0;
  std::vector<std::uint8_t> log_grays;  // grays of the searched part
  TilePyramid pyramid;                  // pyramid of these grays
  LocalThreshold threshold;
  BinaryImage binary;
  BorderTracer tracer;
  std::vector<Eigen::Vector2d> points;  // points of one border on the plane

  // Returns whether some area of the logarithms in the pyramid is overexposed.
  bool ShowsGlare() const;
};

// Memory of one thread's narrow borders.
struct NarrowBorderBuffers {
  BlackTopHat top_hat;
  std::vector<std::uint8_t> inverted;  // a level, dark where there is white ink

  void Reserve(const cv::Mat& image, BorderBuffers* borders);
};

// Traces borders around strokes of ink that are narrow at a level of an image's pyramid, in any
// light: the edge of a shadow that crosses a stroke is no border of it, as light is a term of the
// logarithms in the pyramid, which the top-hat removes. 'level': from 0; 'borders->pyramid' must
// have it. A border goes around the ink. Does not allocate after Reserve.
std::span<const Border> TraceNarrow(int level, bool white_ink, const BorderLimits& limits,
                                    BorderBuffers* borders, NarrowBorderBuffers* buffers);

// Traces borders in the logarithms of the raw image: what is darker than its surroundings by a
// factor has a border, also where a shadow's edge runs through it. A lens bends lines, so borders
// are examined as rays: on a plane across the ray to their middle a straight edge is straight,
// however far from the axis.
class PlaneBorders {
 public:
  static constexpr int kPasses = 4;  // from the image at an eighth, for near pads, to all of it

  using Passes = std::array<BorderPass, kPasses>;

  PlaneBorders(const CameraModel& camera, const Passes& passes) : rays_(camera), passes_(passes) {}

  // Returns whether figures of these extents (px) are among those of a pass.
  bool Covers(int pass, double least_px, double most_px) const;

  // Prepares a search of 'part', whole pixels in the image; Trace does not allocate afterwards once
  // it has seen an image of this size.
  void Begin(const cv::Mat& image, const cv::Rect& part, BorderBuffers* buffers) const;

  // From here on Trace searches the gray values of 'part' themselves: a dark line between light
  // areas that blur into it stays dark there, but not in a shadow. Begin comes before it.
  void BeginLinear(const cv::Mat& image, const cv::Rect& part, BorderBuffers* buffers) const;

  // Returns the borders of one pass, in pixels of its level.
  std::span<const Border> Trace(const cv::Rect& part, int pass, BorderBuffers* buffers) const;

  // Writes points of a border in pixels of a level, in its order, to 'buffers->points': on the
  // plane at distance 1 across the ray to its middle. The columns of 'camera_from_plane' become the
  // plane's axes and that ray. False where the border leaves the sight of the lens or of the plane.
  bool OnPlane(const Border& border, const cv::Rect& part, int level,
               Eigen::Matrix3d* camera_from_plane, BorderBuffers* buffers) const;

 private:
  void BuildPyramid(const cv::Mat& grays, BorderBuffers* buffers) const;

  RayTable rays_;
  Passes passes_;
};

}  // namespace kestrel
