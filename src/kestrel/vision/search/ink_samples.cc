// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/ink_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr std::size_t kMostParts = 16;

}  // namespace

void InkSamples::Add(const Eigen::Vector2d& place, std::size_t part, bool ink) {
  places_.push_back(place);
  samples_.push_back({part, ink, {}});
}

void InkSamples::Connect(std::size_t first, double reach_m) {
  for (std::size_t i = first; i < samples_.size(); ++i) {
    for (std::size_t k = first; k < i; ++k) {
      if (samples_[i].ink == samples_[k].ink) continue;
      if ((places_[i] - places_[k]).norm() > reach_m) continue;
      samples_[i].opposite.push_back(k);
      samples_[k].opposite.push_back(i);
    }
  }
}

// One of each sample, negative where it is out of view.
InkSamples::Tones InkSamples::TonesOf(std::span<const float> gray, Tone tone) const {
  Tones tones;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool is_logarithm = tone == Tone::kLogarithm && gray[i] >= 0;
    tones[i] = is_logarithm ? log_(gray[i]) : gray[i] / 255;
  }
  return tones;
}

InkSamples::Contrast InkSamples::ContrastAt(const Tones& tones, std::size_t i) const {
  if (tones[i] < 0) return {NAN, NAN};
  const float sign = samples_[i].ink == white_ ? 1.0F : -1.0F;
  float sum = 0, largest = -1;
  int count = 0;
  for (const std::size_t k : samples_[i].opposite) {
    if (tones[k] < 0) continue;
    const float contrast = sign * (tones[i] - tones[k]);
    sum += contrast;
    largest = std::max(largest, contrast);
    ++count;
  }
  if (count == 0) return {NAN, NAN};
  return {sum / static_cast<float>(count), largest};
}

// Bright ground that is overexposed shows a part of its contrast only.
bool InkSamples::IsClipped(std::span<const float> gray, std::size_t i) const {
  constexpr float kClipped = 250;
  const auto is_clipped = [&](std::size_t k) { return gray[k] >= kClipped; };
  return is_clipped(i) || std::ranges::any_of(samples_[i].opposite, is_clipped);
}

// Adds what one tone shows; false where it shows no contrast. At the edge of a shadow the others
// are no reference: a sample is held against the one that is in one light with it.
bool InkSamples::AddTone(std::span<const float> gray, Tone tone, SampleContrasts* seen) const {
  constexpr double kLeastContrast = 0.02;
  constexpr float kLeastClipped = 0.03F;
  const Tones tones = TonesOf(gray, tone);
  std::array<float, kMostSamples> means, largest;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Contrast contrast = ContrastAt(tones, i);
    largest[i] = contrast.largest;
    if (!std::isnan(contrast.mean)) means[count++] = contrast.mean;
  }
  if (count == 0) return false;
  const double usual = MedianInPlace(std::span(means.data(), count));
  if (usual < kLeastContrast) return false;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (std::isnan(largest[i])) continue;
    const bool is_lower_bound = largest[i] > kLeastClipped && IsClipped(gray, i);
    const float share = is_lower_bound ? 1 : static_cast<float>(largest[i] / usual);
    seen->of_usual[i] = std::fmax(seen->of_usual[i], share);
    seen->largest[i] = std::fmax(seen->largest[i], largest[i]);
  }
  return true;
}

InkAgreement InkSamples::Compare(std::span<const float> gray, double area_px2,
                                 DimSample dim) const {
  constexpr float kLeastDimContrast = 0.1F;  // contrast of ink in a shadow
  constexpr float kLeast = 0.45F;  // share of the usual contrast that a sample needs to agree
  InkAgreement agreement;
  SampleContrasts seen;
  for (const Tone tone : {Tone::kLogarithm, Tone::kLinear}) {
    if (!AddTone(gray, tone, &seen)) continue;
    agreement.evidence = std::max(agreement.evidence, EvidenceOf(gray, area_px2, tone));
  }
  std::array<int, kMostParts> all{}, right{};
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (std::isnan(seen.of_usual[i])) continue;
    const bool agrees = seen.of_usual[i] > kLeast;
    if (!agrees && dim == DimSample::kUnknown && seen.largest[i] > kLeastDimContrast) continue;
    const std::size_t part = samples_[i].part;
    ++all[part];
    right[part] += agrees;
  }
  for (std::size_t part = 0; part < kMostParts; ++part) {
    constexpr int kFewest = 3;
    if (all[part] < kFewest) continue;
    ++agreement.parts;
    agreement.worst_share =
        std::min(agreement.worst_share, static_cast<double>(right[part]) / all[part]);
  }
  return agreement;
}

double InkSamples::EvidenceOf(std::span<const float> gray, double area_px2, Tone tone) const {
  constexpr double kBlurArea_px2 = 7.2;       // 4 pi sigma^2 of a usual lens with its pixels
  constexpr double kLeastUnexplained = 1e-4;  // gray values are whole numbers
  constexpr double kPoseParameters = 6;
  const double likeness = LikenessOf(gray, tone);
  if (likeness <= 0) return 0;
  const auto seen = std::count_if(gray.begin(), gray.end(), [](float g) { return g >= 0; });
  const double share = std::min(1.0, area_px2 / kBlurArea_px2);
  const double independent = std::max(1.0, share * static_cast<double>(seen));
  const double unexplained = std::max(kLeastUnexplained, 1 - likeness * likeness);
  return -0.5 * (independent * std::log(unexplained) + kPoseParameters * std::log(independent));
}

double InkSamples::LikenessOf(std::span<const float> gray, Tone tone) const {
  constexpr double kLeastSpread = 0.01;
  const Tones tones = TonesOf(gray, tone);
  double sum = 0, squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const float contrast = ContrastAt(tones, i).mean;
    if (std::isnan(contrast)) continue;
    sum += contrast;
    squares += contrast * contrast;
    ++count;
  }
  constexpr int kFewest = 8;
  if (count < kFewest) return -1;
  return sum / count / std::max(kLeastSpread, std::sqrt(squares / count));
}

}  // namespace kestrel
