// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/image/log_gray.h"
#include "kestrel/vision/search/pad_samples.h"

namespace kestrel {

// Where light is dimmed, the logarithms of gray values keep the contrast of a print; where glare
// veils it, the gray values themselves.
enum class Tone { kLogarithm, kLinear };

// Agreement of the gray values of samples with a pad.
struct InkAgreement {
  // Natural logarithm of how much likelier a pad of one ink on one ground is than any gray values:
  // -n/2 log(1 - r^2) - k/2 log n. r: LikenessOf, so that 1 - r^2 is the share of the contrasts'
  // squares that the pad does not explain, noise and unequal ink among it. n: the number of
  // independent samples, one for each area that the blur makes alike. k = 6: the pose was fitted to
  // the same gray values (Schwarz, Estimating the dimension of a model, 1978).
  double evidence = 0;
  double worst_share = 1;  // share of agreeing samples in the worst part
  int parts = 0;           // number of parts in view
};

// Points on a pad's ink and on the ground beside it. Each is held against those of the other colour
// around it, so that the edge of a shadow does not matter. Gray values of all samples are negative
// where out of view.
class InkSamples {
 public:
  explicit InkSamples(bool white) : white_(white) {}  // the ink

  // Adds a point. 'part': of the pad or of its surroundings, a number below 16; the parts are
  // examined one by one, as no part may be wrong. At most 256 points.
  void Add(const Eigen::Vector2d& place, std::size_t part, bool ink);
  // Holds the points from number 'first' on against those among them within 'reach_m'.
  void Connect(std::size_t first, double reach_m);

  bool white() const { return white_; }
  std::size_t count() const { return places_.size(); }
  const std::vector<Eigen::Vector2d>& places() const { return places_; }  // on the pad

  // Compares gray values with the pad. 'area_px2': of the pad in the image, for each sample.
  InkAgreement Compare(std::span<const float> gray, double area_px2, DimSample dim) const;

  // Returns how much gray values look like the pad: the mean contrast of a sample over its root
  // mean square, 1 where all have the same; negative when few are in view.
  double LikenessOf(std::span<const float> gray, Tone tone = Tone::kLogarithm) const;

 private:
  struct Sample {
    std::size_t part;
    bool ink;
    std::vector<std::size_t> opposite;  // numbers of the samples that it is held against
  };
  // Contrast of a sample with those that it is held against, positive as it should be; NaN where it
  // or they are out of view.
  struct Contrast {
    float mean, largest;
  };

  static constexpr std::size_t kMostSamples = 256;
  using Tones = std::array<float, kMostSamples>;
  Tones TonesOf(std::span<const float> gray, Tone tone) const;
  Contrast ContrastAt(const Tones& tones, std::size_t i) const;
  // Of each sample what the tones show at most; NaN where it is out of view.
  struct SampleContrasts {
    SampleContrasts() {
      of_usual.fill(NAN);
      largest.fill(NAN);
    }
    std::array<float, kMostSamples> of_usual;  // contrast, as a share of the median of its tone
    std::array<float, kMostSamples> largest;
  };

  bool AddTone(std::span<const float> gray, Tone tone, SampleContrasts* seen) const;
  bool IsClipped(std::span<const float> gray, std::size_t i) const;
  double EvidenceOf(std::span<const float> gray, double area_px2, Tone tone) const;

  bool white_;
  std::vector<Eigen::Vector2d> places_;
  std::vector<Sample> samples_;
  LogGrays log_;
};

}  // namespace kestrel
