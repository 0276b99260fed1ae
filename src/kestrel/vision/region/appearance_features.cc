// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/appearance_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/region/appearance_features.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Length of the gradient, and its direction in 'bins' to the turn, for the pixels of a row but its
// first and last.
void Gradients(const float* HWY_RESTRICT above, const float* HWY_RESTRICT row,
               const float* HWY_RESTRICT below, int side, float bins, float* HWY_RESTRICT length,
               float* HWY_RESTRICT bin) {
  const hn::CappedTag<float, 8> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto of = [&](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto zero = hn::Zero(d);
  for (int i = 1; i < side - 1; i += lanes) {
    const int x = i + lanes < side ? i : side - 1 - lanes;  // the last ones once more
    const auto dx = hn::Sub(hn::LoadU(d, row + x + 1), hn::LoadU(d, row + x - 1));
    const auto dy = hn::Sub(hn::LoadU(d, below + x), hn::LoadU(d, above + x));
    hn::StoreU(hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy))), d, length + x);
    const auto ax = hn::Abs(dx), ay = hn::Abs(dy);
    // atan(r) for r in [0, 1], Hastings, error below 1e-4 rad.
    const auto r = hn::Div(hn::Min(ax, ay), hn::Add(hn::Max(ax, ay), of(1e-9f)));
    const auto s = hn::Mul(r, r);
    auto angle = hn::MulAdd(s, of(0.0208351f), of(-0.0851330f));
    angle = hn::MulAdd(s, angle, of(0.1801410f));
    angle = hn::MulAdd(s, angle, of(-0.3302995f));
    angle = hn::Mul(r, hn::MulAdd(s, angle, of(0.9998660f)));
    angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(of(1.5707963f), angle), angle);
    angle = hn::IfThenElse(hn::Lt(dx, zero), hn::Sub(of(3.1415927f), angle), angle);
    angle = hn::IfThenElse(hn::Lt(dy, zero), hn::Sub(of(6.2831853f), angle), angle);
    hn::StoreU(hn::Mul(angle, of(bins / 6.2831853f)), d, bin + x);
  }
}

// The channels of gradients of a cell with the histogram 'h', and then, after one of another kind,
// the four of texture.
void NormalizeCell(const float* HWY_RESTRICT h, const float* HWY_RESTRICT norms,
                   float* HWY_RESTRICT out) {
  constexpr int kDirections = AppearanceFeatures::kDirections;
  constexpr int kOrientations = kDirections / 2;
  constexpr int kBins = kDirections + kOrientations;
  constexpr int kPadded = 32;    // of whole registers
  constexpr float kMost = 0.2f;  // share of the neighbourhood's length
  float bins[kPadded] = {}, sums[kPadded] = {};
  for (int o = 0; o < kDirections; ++o) bins[o] = h[o];
  for (int o = 0; o < kOrientations; ++o) bins[kDirections + o] = h[o] + h[o + kOrientations];
  float texture[4];
  for (int k = 0; k < 4; ++k) {
    float shares[kPadded];
    for (int i = 0; i < kPadded; ++i) {
      shares[i] = bins[i] * norms[k] < kMost ? bins[i] * norms[k] : kMost;
      sums[i] += 0.5f * shares[i];
    }
    float sum = 0;
    for (int o = 0; o < kDirections; ++o) sum += shares[o];
    texture[k] = sum;
  }
  for (int i = 0; i < kBins; ++i) out[i] = sums[i];
  for (int k = 0; k < 4; ++k) {
    out[AppearanceFeatures::kGradientChannels + 1 + k] = 0.2357f * texture[k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(Gradients);
HWY_EXPORT(NormalizeCell);

AppearanceFeatures::AppearanceFeatures(int cells, int cell_px)
    : cells_(cells),
      cell_px_(cell_px),
      side_(cells * cell_px),
      left_cell_(side_),
      right_(side_),
      gray_(std::size_t(side_) * side_),
      histograms_(std::size_t(cells) * cells * kDirections),
      // A cell more at both ends, which is not used.
      row_(std::size_t(cells + 2) * kDirections),
      energy_(std::size_t(cells) * cells),
      magnitude_(side_),
      bin_(side_),
      inverse_norm_(std::size_t(cells + 1) * (cells + 1)) {
  for (int x = 0; x < side_; ++x) {
    const float at = (static_cast<float>(x) + 0.5f) / static_cast<float>(cell_px) + 0.5f;
    const int cell = static_cast<int>(at);
    left_cell_[x] = cell * kDirections;
    right_[x] = at - static_cast<float>(cell);
  }
}

void AppearanceFeatures::Compute(const SampledWindow& window, FeatureGrid* features) {
  const std::vector<float>* gray = &window.values[0];
  if (window.planes == 3) {
    for (std::size_t i = 0; i < gray_.size(); ++i) {
      gray_[i] = 0.114f * window.values[0][i] + 0.587f * window.values[1][i] +
                 0.299f * window.values[2][i];
    }
    gray = &gray_;
  }
  ComputeHistograms(*gray);
  Normalize(features);
  AddMeans(window, features);
}

// Each pixel adds to the two nearest directions of the four nearest cells.
void AppearanceFeatures::ComputeHistograms(const std::vector<float>& gray) {
  std::fill(histograms_.begin(), histograms_.end(), 0.0f);
  for (int y = 1; y < side_ - 1; ++y) {
    const float* row = &gray[std::size_t(y) * side_];
    HWY_DYNAMIC_DISPATCH(Gradients)
    (row - side_, row, row + side_, side_, kDirections, magnitude_.data(), bin_.data());
    std::fill(row_.begin(), row_.end(), 0.0f);
    for (int x = 1; x < side_ - 1; ++x) {
      const float right = right_[x];
      const int floor = static_cast<int>(bin_[x]);
      const float next = bin_[x] - static_cast<float>(floor);
      const int bin = floor >= kDirections ? 0 : floor, bin2 = bin + 1 == kDirections ? 0 : bin + 1;
      float* histogram = &row_[left_cell_[x]];
      const float m_right = magnitude_[x] * right, m_left = magnitude_[x] - m_right;
      histogram[bin] += m_left * (1 - next);
      histogram[bin2] += m_left * next;
      histogram[kDirections + bin] += m_right * (1 - next);
      histogram[kDirections + bin2] += m_right * next;
    }
    const float at = (static_cast<float>(y) + 0.5f) / static_cast<float>(cell_px_) - 0.5f;
    const int cell = static_cast<int>(std::floor(at));
    const float below = at - static_cast<float>(cell);
    const std::size_t length = std::size_t(cells_) * kDirections;
    for (int k = 0; k < 2; ++k) {
      if (cell + k < 0 || cell + k >= cells_) continue;
      const float weight = k == 0 ? 1 - below : below;
      float* to = &histograms_[std::size_t(cell + k) * length];
      for (std::size_t i = 0; i < length; ++i) to[i] += weight * row_[kDirections + i];
    }
  }
}

void AppearanceFeatures::Normalize(FeatureGrid* features) {
  constexpr int kOrientations = kDirections / 2;
  for (std::size_t cell = 0; cell < energy_.size(); ++cell) {
    const float* h = &histograms_[cell * kDirections];
    float sum = 0;
    for (int o = 0; o < kOrientations; ++o) {
      const float both = h[o] + h[o + kOrientations];
      sum += both * both;
    }
    energy_[cell] = sum;
  }
  const auto at = [&](int x, int y) {
    return energy_[std::clamp(y, 0, cells_ - 1) * cells_ + std::clamp(x, 0, cells_ - 1)];
  };
  for (int y = 0; y <= cells_; ++y) {
    for (int x = 0; x <= cells_; ++x) {
      const float sum = at(x - 1, y - 1) + at(x, y - 1) + at(x - 1, y) + at(x, y);
      inverse_norm_[y * (cells_ + 1) + x] = 1 / std::sqrt(sum + 1e-4f * 255 * 255);
    }
  }
  for (int y = 0; y < cells_; ++y) {
    for (int x = 0; x < cells_; ++x) {
      const float* h = &histograms_[(std::size_t(y) * cells_ + x) * kDirections];
      const float* n = &inverse_norm_[y * (cells_ + 1) + x];
      const std::array<float, 4> norms = {n[0], n[1], n[cells_ + 1], n[cells_ + 2]};
      HWY_DYNAMIC_DISPATCH(NormalizeCell)(h, norms.data(), features->Cell(x, y));
    }
  }
}

void AppearanceFeatures::AddMeans(const SampledWindow& window, FeatureGrid* features) const {
  const std::vector<float>& gray = window.planes == 3 ? gray_ : window.values[0];
  const float scale = 1.0f / static_cast<float>(cell_px_ * cell_px_);
  for (int y = 0; y < cells_; ++y) {
    for (int x = 0; x < cells_; ++x) {
      float sum = 0;
      std::array<float, 3> color{};
      for (int v = y * cell_px_; v < (y + 1) * cell_px_; ++v) {
        for (int u = x * cell_px_; u < (x + 1) * cell_px_; ++u) {
          const std::size_t i = std::size_t(v) * side_ + u;
          sum += gray[i];
          if (window.planes < 3) continue;
          for (int c = 0; c < 3; ++c) color[c] += window.values[c][i];
        }
      }
      float* out = features->Cell(x, y) + kGradientChannels;
      out[0] = sum * scale / 255 - 0.5f;
      if (window.planes < 3) continue;
      const float yellow = scale / 255 * (0.5f * (color[1] + color[2]) - color[0]);
      const float red = scale / 255 * (color[2] - color[1]);
      out[1] = std::max(yellow, 0.0f);
      out[2] = std::max(-yellow, 0.0f);
      out[3] = std::max(red, 0.0f);
      out[4] = std::max(-red, 0.0f);
    }
  }
}

}  // namespace kestrel
#endif  // HWY_ONCE
