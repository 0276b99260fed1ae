// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

constexpr int kMax = SmallMask::kMaxSize;
constexpr double kDiscSquared = 0.81;   // inner radii: the disc ends short of the ring's inner edge
constexpr double kLeastDiscSeen = 0.2;  // share of the disc in view
constexpr float kDarkMargin = 0.05f;    // below the local mean, share of the contrast

// Integral images of gray values and of known pixels of a small image.
class SmallIntegral {
 public:
  explicit SmallIntegral(int size) : size_(size) {
    std::fill_n(sums_.begin(), kMax + 1, 0.0f);
    std::fill_n(counts_.begin(), kMax + 1, 0);
  }
  void AddRow(int y, const float* gray) {
    float sum = 0;
    int count = 0;
    const int row = (y + 1) * (kMax + 1);
    sums_[row] = 0;
    counts_[row] = 0;
    for (int x = 0; x < size_; ++x) {
      if (gray[x] >= 0) {
        sum += gray[x];
        ++count;
      }
      sums_[row + x + 1] = sums_[row - (kMax + 1) + x + 1] + sum;
      counts_[row + x + 1] = counts_[row - (kMax + 1) + x + 1] + count;
    }
  }
  // True when a gray value is below the mean of the known pixels in the square around (x, y).
  bool IsBelowMean(float gray, int x, int y, int radius) const {
    const int x0 = std::max(x - radius, 0), x1 = std::min(x + radius + 1, size_);
    const int y0 = std::max(y - radius, 0) * (kMax + 1);
    const int y1 = std::min(y + radius + 1, size_) * (kMax + 1);
    const int count = counts_[y1 + x1] - counts_[y0 + x1] - counts_[y1 + x0] + counts_[y0 + x0];
    const float sum = sums_[y1 + x1] - sums_[y0 + x1] - sums_[y1 + x0] + sums_[y0 + x0];
    return gray * static_cast<float>(count) < sum;
  }

 private:
  int size_;
  std::array<float, (kMax + 1) * (kMax + 1)> sums_;
  std::array<int, (kMax + 1) * (kMax + 1)> counts_;
};

}  // namespace

std::optional<RingInside> RectifyInside(const cv::Mat& image, const PatternView& view,
                                        const LandingPattern& pattern, int size,
                                        double min_contrast) {
  RingInside inside{SmallMask(size), SmallMask(size), 0};
  std::array<float, kMax * kMax> gray;
  SmallIntegral integral(size);
  const auto radius_m = static_cast<float>(pattern.inner_radius_m());
  float darkest = 255, brightest = 0;
  int in_disc = 0, seen = 0;
  std::array<float, kMax> x_m, y_m;
  for (int x = 0; x < size; ++x) x_m[x] = static_cast<float>(inside.Coordinate(x)) * radius_m;
  for (int y = 0; y < size; ++y) {
    float* const values = &gray[y * kMax];
    std::fill_n(values, size, -1.0f);
    std::fill_n(y_m.begin(), size, x_m[y]);
    const double v = inside.Coordinate(y);
    const double half = 0.5 * size * std::sqrt(std::max(0.0, kDiscSquared - v * v));
    const int count = 2 * static_cast<int>(std::lround(half));
    const int first = (size - count) / 2;
    view.Sample(image, &x_m[first], y_m.data(), count, values + first);
    in_disc += count;
    for (int x = first; x < first + count; ++x) {
      if (values[x] < 0) continue;
      ++seen;
      inside.disc.Set(x, y);
      darkest = std::min(darkest, values[x]);
      brightest = std::max(brightest, values[x]);
    }
    integral.AddRow(y, values);
  }
  if (seen < kLeastDiscSeen * in_disc || brightest - darkest < min_contrast) return std::nullopt;
  // The box of the local threshold reaches across an arm to the white on both of its sides.
  const int radius = std::max(2, size * 5 / 16);
  const float margin = kDarkMargin * (brightest - darkest);
  for (int y = 0; y < size; ++y) {
    std::uint64_t below = 0;
    for (int x = 0; x < size; ++x) {
      const bool is_below = integral.IsBelowMean(gray[y * kMax + x] + margin, x, y, radius);
      below |= std::uint64_t{is_below} << x;
    }
    inside.dark.SetRow(y, below & inside.disc.row(y));
  }
  inside.seen = static_cast<double>(seen) / in_disc;
  return inside;
}

}  // namespace kestrel
