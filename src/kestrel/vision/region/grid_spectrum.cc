// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/grid_spectrum.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/geometry/angles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/region/grid_spectrum.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

// (a, b) <- (a + wb, a - wb) for pairs of cells that lie side by side.
void Combine(float* HWY_RESTRICT a, float* HWY_RESTRICT b, int cells, int half, float cosine,
             float sine) {
  for (int cell = 0; cell < cells; ++cell, a += 2 * half, b += 2 * half) {
    for (int i = 0; i < half; ++i) {
      const float re = cosine * b[i] - sine * b[half + i];
      const float im = cosine * b[half + i] + sine * b[i];
      b[i] = a[i] - re;
      b[half + i] = a[half + i] - im;
      a[i] += re;
      a[half + i] += im;
    }
  }
}

// The stages of a transform along both axes (Cooley, Tukey 1965, decimation in time) of cells in
// bit-reversed order.
void TransformStages(float* values, int side, int channels, const float* cosines,
                     const float* sines, float sign) {
  const int half = channels / 2;
  const auto cell = [&](int x, int y) { return values + (y * side + x) * channels; };
  for (int span = 1; span < side; span *= 2) {
    for (int j = 0; j < span; ++j) {
      const int turn = j * (side / (2 * span));
      const float cosine = cosines[turn], sine = sign * sines[turn];
      for (int first = j; first < side; first += 2 * span) {
        Combine(cell(0, first), cell(0, first + span), side, half, cosine, sine);
        for (int y = 0; y < side; ++y) {
          Combine(cell(first, y), cell(first + span, y), 1, half, cosine, sine);
        }
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(TransformStages);

GridTransform::GridTransform(int side, int channels)
    : side_(side), channels_(channels), cosines_(side), sines_(side), reversed_(side) {
  for (int i = 0; i < side; ++i) {
    cosines_[i] = static_cast<float>(std::cos(2 * kPi * i / side));
    sines_[i] = static_cast<float>(std::sin(2 * kPi * i / side));
    for (int bit = 1; bit < side; bit *= 2) reversed_[i] = 2 * reversed_[i] + ((i & bit) != 0);
  }
}

void GridTransform::TransformComplex(FeatureGrid* grid, float sign) const {
  for (int y = 0; y < side_; ++y) {
    for (int x = 0; x < side_; ++x) {
      const int from = reversed_[y] * side_ + reversed_[x];
      if (from <= y * side_ + x) continue;
      std::swap_ranges(grid->Cell(x, y), grid->Cell(x, y) + channels_,
                       grid->Cell(reversed_[x], reversed_[y]));
    }
  }
  HWY_DYNAMIC_DISPATCH(TransformStages)
  (grid->values.data(), side_, channels_, cosines_.data(), sines_.data(), sign);
}

// With z = a + ib for real a and b: A(k) = (Z(k) + Z*(-k)) / 2, B(k) = (Z(k) - Z*(-k)) / 2i.
void GridTransform::Forward(FeatureGrid* grid, GridSpectrum* spectrum) const {
  TransformComplex(grid, -1);
  const int half = channels_ / 2;
  for (int y = 0, bin = 0; y < side_; ++y) {
    for (int x = 0; x <= side_ / 2; ++x, ++bin) {
      const float* z = grid->Cell(x, y);
      const float* m = grid->Cell((side_ - x) % side_, (side_ - y) % side_);
      float* out = spectrum->Bin(bin);
      for (int i = 0; i < half; ++i) {
        out[i] = 0.5f * (z[i] + m[i]);
        out[half + i] = 0.5f * (z[half + i] + m[half + i]);
        out[channels_ + i] = 0.5f * (z[half + i] - m[half + i]);
        out[channels_ + half + i] = 0.5f * (m[i] - z[i]);
      }
    }
  }
}

void GridTransform::Inverse(const GridSpectrum& spectrum, FeatureGrid* grid) const {
  const int half = channels_ / 2;
  const float scale = 1.0f / static_cast<float>(side_ * side_);
  for (int y = 0, bin = 0; y < side_; ++y) {
    for (int x = 0; x <= side_ / 2; ++x, ++bin) {
      const float* in = spectrum.Bin(bin);
      float* z = grid->Cell(x, y);
      float* m = grid->Cell((side_ - x) % side_, (side_ - y) % side_);
      for (int i = 0; i < half; ++i) {
        const float a_re = scale * in[i], a_im = scale * in[channels_ + i];
        const float b_re = scale * in[half + i], b_im = scale * in[channels_ + half + i];
        m[i] = a_re + b_im;
        m[half + i] = b_re - a_im;
        z[i] = a_re - b_im;
        z[half + i] = a_im + b_re;
      }
    }
  }
  TransformComplex(grid, +1);
}

}  // namespace kestrel
#endif  // HWY_ONCE
