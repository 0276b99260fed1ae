// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/appearance_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

#include <Eigen/LU>

#include "kestrel/core/geometry/angles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/region/appearance_filter.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

#ifndef KESTREL_REGION_APPEARANCE_FILTER_CC_
#define KESTREL_REGION_APPEARANCE_FILTER_CC_
namespace kestrel {
namespace {

constexpr double kLabelSigma = 0.045;      // as a share of the target's size
constexpr double kTargetWeight = 0.1;      // against the filter where the target is
constexpr double kBackgroundWeight = 1e6;  // and where it is not
constexpr int kIterations = 3;
constexpr float kFirstPenalty = 100, kPenaltyGrowth = 10;  // weights for ADMM

}  // namespace
}  // namespace kestrel
#endif

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

// Solves (x x^H + (t + g) I) f = x y + t p + g (h - s) for one bin by Sherman and Morrison; f is
// written over p.
void SolveBin(const float* HWY_RESTRICT x, const float* HWY_RESTRICT h, const float* HWY_RESTRICT s,
              int channels, float y, float t, float g, float* HWY_RESTRICT f) {
  const float* xi = x + channels;
  float* fi = f + channels;
  float dot_re = 0, dot_im = 0, power = 0;
  for (int c = 0; c < 2 * channels; ++c) {
    f[c] = x[c] * y + t * f[c] + g * (h[c] - s[c]);
    power += x[c] * x[c];
    dot_re += x[c] * f[c];
  }
  for (int c = 0; c < channels; ++c) dot_im += x[c] * fi[c] - xi[c] * f[c];
  const float rho = t + g;
  const float scale = 1 / (rho + power), inverse = 1 / rho;
  const float re = dot_re * scale, im = dot_im * scale;
  for (int c = 0; c < channels; ++c) {
    const float fr = (f[c] - (x[c] * re - xi[c] * im)) * inverse;
    fi[c] = (fi[c] - (x[c] * im + xi[c] * re)) * inverse;
    f[c] = fr;
  }
}

void SolveBins(const float* x, const float* h, const float* s, const float* y, int bins,
               int channels, float t, float g, float* f) {
  for (int bin = 0; bin < bins; ++bin) {
    const int at = bin * 2 * channels;
    SolveBin(x + at, h + at, s + at, channels, y[bin], t, g, f + at);
  }
}

// sum_c conj(f_c) x_c by bin.
void Correlate(const float* HWY_RESTRICT f, const float* HWY_RESTRICT x, int bins, int channels,
               float* HWY_RESTRICT out) {
  for (int bin = 0; bin < bins; ++bin, f += 2 * channels, x += 2 * channels, out += 4) {
    float re = 0, im = 0;
    for (int c = 0; c < 2 * channels; ++c) re += f[c] * x[c];
    for (int c = 0; c < channels; ++c) im += f[c] * x[channels + c] - f[channels + c] * x[c];
    out[0] = re;
    out[2] = im;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(SolveBins);
HWY_EXPORT(Correlate);

namespace {

// Sums over the responses at all displacements.
struct ResponseRange {
  int x = 0, y = 0;  // where the highest is
  float most = -1e9f, least = 1e9f;
};

ResponseRange RangeOf(const FeatureGrid& response) {
  ResponseRange range;
  for (int y = 0; y < response.side; ++y) {
    for (int x = 0; x < response.side; ++x) {
      const float value = response.Cell(x, y)[0];
      range.least = std::min(range.least, value);
      if (value > range.most) range.most = value, range.x = x, range.y = y;
    }
  }
  return range;
}

double Sharpness(const FeatureGrid& response, const ResponseRange& range) {
  double sum = 0;
  for (std::size_t i = 0; i < response.values.size(); i += 2) {
    const double above = response.values[i] - range.least;
    sum += above * above;
  }
  const double height = range.most - range.least;
  return height * height / (sum / (0.5 * response.values.size()) + 1e-12);
}

// The trigonometric polynomial through all cells, and its derivatives.
struct ResponseBetween {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // cells
  double value = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

ResponseBetween ResponseAt(const GridSpectrum& spectrum, const Eigen::Vector2d& at) {
  const int cells = spectrum.side;
  const double turn = 2 * kPi / cells;
  const std::complex<double> step_x = std::polar(1.0, turn * at.x());
  ResponseBetween response{.at = at};
  for (int row = 0; row < cells; ++row) {
    const int ky = row < cells / 2 ? row : row - cells;
    std::complex<double> phase = std::polar(1.0, turn * ky * at.y());
    const float* bin = spectrum.Bin(row * (cells / 2 + 1));
    for (int kx = 0; kx < cells / 2; ++kx, bin += 4, phase *= step_x) {
      const double twice = kx == 0 ? 1 : 2;
      const double real = twice * (bin[0] * phase.real() - bin[2] * phase.imag());
      const double imaginary = twice * (bin[0] * phase.imag() + bin[2] * phase.real());
      const Eigen::Vector2d k(turn * kx, turn * ky);
      response.value += real;
      response.gradient -= imaginary * k;
      response.hessian -= real * k * k.transpose();
    }
  }
  const double scale = 1.0 / (cells * cells);
  return {at, scale * response.value, scale * response.gradient, scale * response.hessian};
}

// Returns the maximum of the polynomial near the highest cell: by half cells, as a sharp
// response between cells is flat over four of them, then by Newton's method.
ResponseBetween Refine(const GridSpectrum& spectrum, const Eigen::Vector2d& highest) {
  constexpr int kSteps = 3;
  constexpr double kHalf = 0.5;
  ResponseBetween best = ResponseAt(spectrum, highest);
  for (const int y : {-1, 0, 1}) {
    for (const int x : {-1, 0, 1}) {
      if (x == 0 && y == 0) continue;
      const auto response = ResponseAt(spectrum, highest + kHalf * Eigen::Vector2d(x, y));
      if (response.value > best.value) best = response;
    }
  }
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Matrix2d& hessian = best.hessian;
    if (!(hessian(0, 0) < 0 && hessian.determinant() > 0)) break;
    const Eigen::Vector2d move = -hessian.inverse() * best.gradient;
    const ResponseBetween response = ResponseAt(spectrum, best.at + move);
    if (!(response.value > best.value) || move.norm() > kHalf) break;
    best = response;
  }
  return best;
}

}  // namespace

FilterWorkspace::FilterWorkspace(int cells, int channels)
    : transform(cells, channels),
      response_transform(cells, 2),
      prior(cells, channels),
      spatial(cells, channels),
      dual(cells, channels),
      response_spectrum(cells, 2),
      grid(cells, channels),
      response(cells, 2) {}

AppearanceFilter::AppearanceFilter(int cells, int channels)
    : cells_(cells),
      filter_(cells, channels),
      label_(filter_.bins()),
      weight_(std::size_t(cells) * cells) {}

void AppearanceFilter::Reset(const Eigen::Vector2d& target, FilterWorkspace* workspace) {
  has_learnt_ = false;
  std::fill(filter_.values.begin(), filter_.values.end(), 0.0f);
  const double sigma = kLabelSigma * std::sqrt(target.prod());
  for (int y = 0; y < cells_; ++y) {
    for (int x = 0; x < cells_; ++x) {
      const Eigen::Vector2d away(std::min(x, cells_ - x), std::min(y, cells_ - y));
      float* label = workspace->response.Cell(x, y);
      label[0] = static_cast<float>(std::exp(-0.5 * away.squaredNorm() / (sigma * sigma)));
      label[1] = 0;
      const Eigen::Vector2d from_middle(std::abs(x + 0.5 - 0.5 * cells_),
                                        std::abs(y + 0.5 - 0.5 * cells_));
      const double beyond = (from_middle - 0.5 * target).cwiseMax(0).squaredNorm();
      weight_[std::size_t(y) * cells_ + x] =
          static_cast<float>(kTargetWeight + std::min(1.0, beyond) * kBackgroundWeight);
    }
  }
  workspace->response_transform.Forward(&workspace->response, &workspace->response_spectrum);
  for (int bin = 0; bin < filter_.bins(); ++bin) {
    label_[bin] = workspace->response_spectrum.Bin(bin)[0];
  }
}

void AppearanceFilter::Learn(const GridSpectrum& sample, double temporal,
                             FilterWorkspace* workspace) {
  const int channels = sample.channels;
  GridSpectrum& h = workspace->spatial;
  GridSpectrum& s = workspace->dual;
  std::fill(h.values.begin(), h.values.end(), 0.0f);
  std::fill(s.values.begin(), s.values.end(), 0.0f);
  workspace->prior.values = filter_.values;
  const float t = has_learnt_ ? static_cast<float>(temporal) : 0.0f;
  has_learnt_ = true;
  float g = kFirstPenalty;
  for (int i = 0; i < kIterations; ++i, g *= kPenaltyGrowth) {
    filter_.values = workspace->prior.values;
    HWY_DYNAMIC_DISPATCH(SolveBins)
    (sample.values.data(), h.values.data(), s.values.data(), label_.data(), sample.bins(), channels,
     t, g, filter_.values.data());
    if (i + 1 == kIterations) break;
    // h = g (f + s) / (w^2 + g) by cell, s = (s + f - h) g / next g.
    for (std::size_t k = 0; k < s.values.size(); ++k) s.values[k] += filter_.values[k];
    workspace->transform.Inverse(s, &workspace->grid);
    for (std::size_t cell = 0; cell < weight_.size(); ++cell) {
      const float share = g / (weight_[cell] + g);
      float* values = &workspace->grid.values[cell * channels];
      for (int c = 0; c < channels; ++c) values[c] *= share;
    }
    workspace->transform.Forward(&workspace->grid, &h);
    for (std::size_t k = 0; k < s.values.size(); ++k) {
      s.values[k] = (s.values[k] - h.values[k]) / kPenaltyGrowth;
    }
  }
}

FilterPeak AppearanceFilter::Find(const GridSpectrum& sample, FilterWorkspace* workspace) const {
  GridSpectrum& spectrum = workspace->response_spectrum;
  HWY_DYNAMIC_DISPATCH(Correlate)
  (filter_.values.data(), sample.values.data(), sample.bins(), sample.channels,
   spectrum.values.data());
  workspace->response_transform.Inverse(spectrum, &workspace->response);
  const ResponseRange range = RangeOf(workspace->response);
  FilterPeak peak;
  peak.sharpness = Sharpness(workspace->response, range);
  const ResponseBetween highest = Refine(spectrum, Eigen::Vector2d(range.x, range.y));
  const Eigen::Vector2d& at = highest.at;
  peak.value = std::max<double>(range.most, highest.value);
  for (int i = 0; i < 2; ++i) peak.displacement[i] = at[i] > 0.5 * cells_ ? at[i] - cells_ : at[i];
  return peak;
}

}  // namespace kestrel
#endif  // HWY_ONCE
