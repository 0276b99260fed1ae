// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/grid_spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

// The factor of a butterfly, a complex number of length 1.
struct Twiddle {
  float cosine, sine;
};

// A stage, for 'half' complex values: (a, b) <- (a + wb, a - wb).
void Combine(float* HWY_RESTRICT a, float* HWY_RESTRICT b, int half, const Twiddle& w) {
  for (int i = 0; i < half; ++i) {
    const float re = w.cosine * b[i] - w.sine * b[half + i];
    const float im = w.cosine * b[half + i] + w.sine * b[i];
    b[i] = a[i] - re;
    b[half + i] = a[half + i] - im;
    a[i] += re;
    a[half + i] += im;
  }
}

// Two stages in one pass over the values: first (a, b) and (c, d) with 'near',
// then (a, c) with 'far' and (b, d) with 'far' and a quarter of a turn more.
void CombineFour(float* HWY_RESTRICT a, float* HWY_RESTRICT b, float* HWY_RESTRICT c,
                 float* HWY_RESTRICT d, int half, const Twiddle& near, const Twiddle& far,
                 float sign) {
  for (int i = 0; i < half; ++i) {
    const int k = half + i;  // of the imaginary part
    const float b_re = near.cosine * b[i] - near.sine * b[k];
    const float b_im = near.cosine * b[k] + near.sine * b[i];
    const float d_re = near.cosine * d[i] - near.sine * d[k];
    const float d_im = near.cosine * d[k] + near.sine * d[i];
    const float c_re = c[i] + d_re, c_im = c[k] + d_im;
    const float less_re = c[i] - d_re, less_im = c[k] - d_im;
    const float far_re = far.cosine * c_re - far.sine * c_im;
    const float far_im = far.cosine * c_im + far.sine * c_re;
    const float turned_re = -sign * (far.cosine * less_im + far.sine * less_re);
    const float turned_im = sign * (far.cosine * less_re - far.sine * less_im);
    const float sum_re = a[i] + b_re, sum_im = a[k] + b_im;
    const float difference_re = a[i] - b_re, difference_im = a[k] - b_im;
    a[i] = sum_re + far_re;
    a[k] = sum_im + far_im;
    b[i] = difference_re + turned_re;
    b[k] = difference_im + turned_im;
    c[i] = sum_re - far_re;
    c[k] = sum_im - far_im;
    d[i] = difference_re - turned_re;
    d[k] = difference_im - turned_im;
  }
}

// The stages of a transform (Cooley, Tukey 1965, decimation in time) of 'side' elements in
// bit-reversed order, 'step' values apart. An element is a run of 'cells' cells.
void TransformAlong(float* values, int side, std::size_t step, int cells, int channels,
                    const float* cosines, const float* sines, float sign) {
  const int half = channels / 2;
  const auto twiddle = [&](int turn) { return Twiddle{cosines[turn], sign * sines[turn]}; };
  int span = 1;
  for (; 4 * span <= side; span *= 4) {
    for (int j = 0; j < span; ++j) {
      const Twiddle near = twiddle(j * (side / (2 * span))), far = twiddle(j * (side / (4 * span)));
      for (int first = j; first < side; first += 4 * span) {
        float* at = values + first * step;
        const std::size_t next = span * step;
        for (int cell = 0; cell < cells; ++cell, at += channels) {
          CombineFour(at, at + next, at + 2 * next, at + 3 * next, half, near, far, sign);
        }
      }
    }
  }
  if (span == side) return;
  for (int j = 0; j < span; ++j) {
    float* at = values + j * step;
    for (int cell = 0; cell < cells; ++cell, at += channels) {
      Combine(at, at + span * step, half, twiddle(j));
    }
  }
}

// Along the rows, each of which stays in the cache, then along the columns, all at once.
void TransformStages(float* values, int side, int channels, const float* cosines,
                     const float* sines, float sign) {
  const std::size_t row = std::size_t(side) * channels;
  for (int y = 0; y < side; ++y) {
    TransformAlong(values + y * row, side, channels, 1, channels, cosines, sines, sign);
  }
  TransformAlong(values, side, row, side, channels, cosines, sines, sign);
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
