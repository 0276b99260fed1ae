// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/search/pad_alignment.h"
#include "kestrel/vision/search/pad_samples.h"
#include "kestrel/vision/search/plane_borders.h"
#include "kestrel/vision/target/search_log.h"
#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Constants of the searches of one detector.
struct PadSearchModels {
  const CameraModel& camera;
  const PadAlignment& alignment;
  double radius_m;         // radius of the pad
  double level_sigma_deg;  // standard deviation of its tilt from level
  // The part of the image that is searched is so much larger than the pad where it is expected:
  // lenses magnify towards the edge, and thresholds look at boxes around a pixel.
  double part_factor;
  double part_margin_px;
};

// Memory of one thread's searches.
struct PadSearchBuffers {
  PadSamples samples;
  PadAlignmentBuffers alignment;
};

// The search of one image for a flat pad whose edges are known: by its appearance at the expected
// place, then in passes over the image until a pose is found. A kind of pad defines what a
// candidate is and how likely a pose is. Does not allocate once the buffers have warmed up.
class PadSearch {
 public:
  virtual ~PadSearch() = default;
  PadSearch(const PadSearch&) = delete;
  PadSearch& operator=(const PadSearch&) = delete;

  TargetReport Run();

 protected:
  PadSearch(const PadSearchModels& models, const cv::Mat& image, const TargetHint& hint,
            PadSearchBuffers* buffers);

  // Looks for the pad near the expected pose.
  virtual void Follow(const RigidTransform& expected) = 0;
  // Prepares passes over a part of the image.
  virtual void Begin(const cv::Rect& part) = 0;
  // Returns the number of steps of a search: the passes, once or several times over.
  virtual int Steps() const { return PlaneBorders::kPasses; }
  // Tries the candidates of a step.
  virtual void SearchStep(const cv::Rect& part, int step) = 0;
  // Returns whether a pass finds the pad at 'distance_m', known up to the relative 'error'.
  virtual bool MayHaveSize(int pass, double distance_m, double error) const = 0;

  // Counts the borders that a pass has examined. 'reason': why none of them is a candidate.
  void ExamineBorders(std::size_t count, std::string_view reason);

  // Moves a pose across the line of sight, in steps of at least 'step_px' within the hint's
  // uncertainty, to where the samples at 'places' (on the pad) are most like the pad. 'likeness'
  // of their gray values: positive where they are like it. Nothing when they nowhere are.
  template <class Likeness>
  std::optional<RigidTransform> MostLike(const RigidTransform& expected,
                                         std::span<const Eigen::Vector2d> places, double step_px,
                                         const Likeness& likeness);

  std::optional<AlignedPad> Align(const RigidTransform& start, const PadPart* only = nullptr);

  // Replaces 'best' by its mirror pose where that is likelier. Returns the other of the two where
  // the image cannot distinguish them.
  std::optional<RigidTransform> ResolveMirror(AlignedPad* best);

  // Returns the part of a detection that is common to all kinds of pads.
  TargetDetection DetectionOf(const AlignedPad& aligned, double quality,
                              DetectionMethod method) const;
  // Returns the share of its length that a pad in this pose has across its tilt.
  static double Slant(const RigidTransform& pose);

  bool is_found() const { return report_.detection.has_value(); }

  const PadSearchModels& models_;
  const cv::Mat& image_;
  const TargetHint& hint_;
  PadSearchBuffers& buffers_;
  TargetReport report_;
  SearchLog log_{&report_};

 private:
  // A square of shifts around the expected place.
  struct ShiftGrid {
    double step_px;
    int steps;  // to either side
  };
  ShiftGrid GridOf(const RigidTransform& expected, double step_px) const;
  std::optional<RigidTransform> Shifted(const RigidTransform& expected,
                                        std::span<const Eigen::Vector2d> places,
                                        const Eigen::Vector2d& shift_px) const;
  void Search();
  bool MayHaveSize(int pass) const;
  cv::Rect SearchedPart() const;

  LevelPrior prior_;
};

template <class Likeness>
std::optional<RigidTransform> PadSearch::MostLike(const RigidTransform& expected,
                                                  std::span<const Eigen::Vector2d> places,
                                                  double step_px, const Likeness& likeness) {
  buffers_.samples.Place(models_.camera, expected, places);
  const ShiftGrid grid = GridOf(expected, step_px);
  double best = 0;
  Eigen::Vector2d shift(0, 0);
  for (int y = -grid.steps; y <= grid.steps; ++y) {
    for (int x = -grid.steps; x <= grid.steps; ++x) {
      const double here = likeness(buffers_.samples.Read(
          image_, static_cast<float>(x * grid.step_px), static_cast<float>(y * grid.step_px)));
      if (here <= best) continue;
      best = here;
      shift = Eigen::Vector2d(x, y) * grid.step_px;
    }
  }
  if (best <= 0) return std::nullopt;
  return Shifted(expected, places, shift);
}

}  // namespace kestrel
