// SPDX-License-Identifier: BSD-3-Clause
// Shadows on a small print.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"

namespace kestrel {
namespace {

// Widest ink, times the width of a stroke; anything wider is light. Where two strokes cross there
// is room for a disc of 1.41 times their width.
constexpr double kWidestInk = 1.5;
constexpr double kBlurReachPx = 1;     // widening of ink by blur, on either side
constexpr double kLeastLight = 0.2;    // least light in a shadow, share of the light beside it
constexpr double kMaxRemaining = 0.5;  // share of the variance that was unexplained without shadows
constexpr double kBrightest = 0.9;     // quantile: the light beside the shadows

struct Offset {
  int x, y;
};

// A disc of the plane as the image shows it, in pixels of a patch: a structuring element.
class Disc {
 public:
  // Radius: 'radius_m' on the plane of the points plus 'radius_px'.
  Disc(const SmallPatternWorkspace& workspace, double radius_m, double radius_px) {
    const Eigen::Matrix2d metres_per_px = MeanDerivative(workspace);
    const int stride = workspace.patch.stride;
    for (int y = -kReach; y <= kReach; ++y) {
      for (int x = -kReach; x <= kReach; ++x) {
        const Eigen::Vector2d step_px(stride * x, stride * y);
        const double length_px = step_px.norm();
        const double px_per_m = length_px / std::max(std::numeric_limits<double>::min(),
                                                     (metres_per_px * step_px).norm());
        if (length_px <= radius_m * px_per_m + radius_px) offsets_[count_++] = {x, y};
      }
    }
  }
  std::span<const Offset> offsets() const { return {offsets_.data(), count_}; }

 private:
  static constexpr int kReach = 9;

  static Eigen::Matrix2d MeanDerivative(const SmallPatternWorkspace& workspace) {
    const SmallPatternWorkspace::Points& points = workspace.points;
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < workspace.count; ++i) {
      sum(0, 0) += points.x_by_u[i];
      sum(0, 1) += points.x_by_v[i];
      sum(1, 0) += points.y_by_u[i];
      sum(1, 1) += points.y_by_v[i];
    }
    return sum / static_cast<double>(workspace.count);
  }

  std::array<Offset, (2 * kReach + 1) * (2 * kReach + 1)> offsets_;
  std::size_t count_ = 0;
};

// Sets the pixels of a patch that do not belong to the print to 'value'.
void SetOutside(const SmallPatternWorkspace::Patch& patch, float value,
                SmallPatternWorkspace::Column* values) {
  for (int at = 0; at < patch.width * patch.height; ++at) {
    if (!patch.is_print[at]) (*values)[at] = value;
  }
}

// Writes for each pixel of a patch the best value within the disc around it according to 'better';
// 'worst' where there is none. Goes row by row for each place of the disc, which compilers
// vectorize.
template <typename Better>
void Filter(const SmallPatternWorkspace::Patch& patch, std::span<const Offset> disc, float worst,
            const SmallPatternWorkspace::Column& from, const Better& better,
            SmallPatternWorkspace::Column* to) {
  std::fill_n(to->begin(), patch.width * patch.height, worst);
  for (int y = 0; y < patch.height; ++y) {
    float* row = to->data() + y * patch.width;
    for (const Offset& offset : disc) {
      const int yy = y + offset.y;
      if (yy < 0 || yy >= patch.height) continue;
      const float* values = from.data() + yy * patch.width + offset.x;
      const int end = std::min(patch.width, patch.width - offset.x);
      for (int x = std::max(0, -offset.x); x < end; ++x) row[x] = better(row[x], values[x]);
    }
  }
}

// Morphological closing: fills what is dark and narrower than the disc.
void Close(std::span<const Offset> disc, SmallPatternWorkspace::Patch* patch,
           SmallPatternWorkspace::Column* values) {
  constexpr float kMost = std::numeric_limits<float>::max();
  const auto brighter = [](float a, float b) { return a < b ? b : a; };
  const auto darker = [](float a, float b) { return b < a ? b : a; };
  SetOutside(*patch, -kMost, values);
  Filter(*patch, disc, -kMost, *values, brighter, &patch->dilated);
  SetOutside(*patch, kMost, &patch->dilated);
  Filter(*patch, disc, kMost, patch->dilated, darker, values);
}

// Returns the share of the gray values' variance that the print does not explain.
double Unexplained(const SmallPatternWorkspace& workspace) {
  const double correlation = CorrelatePrint(workspace);
  return 1 - correlation * correlation;
}

}  // namespace

// Measures the light on the pixels. Closing removes the ink from the image, because ink is narrow.
// Division by the closing of the print in even light corrects for the effect of blur on narrow
// white.
void SmallPatternFitter::MeasureLight(const State& state, SmallPatternWorkspace* workspace) const {
  SmallPatternWorkspace::Patch& patch = workspace->patch;
  const Disc disc(*workspace, 0.5 * kWidestInk * pattern_.ring_width_m, kBlurReachPx);
  // Black reflects 1 - blackness times the light that white does.
  const double blackness = std::clamp(state.contrast / state.white, 0.3, 0.95);
  std::fill_n(patch.is_print.begin(), patch.width * patch.height, false);
  for (std::size_t i = 0; i < workspace->count; ++i) {
    const std::size_t at = patch.IndexOf(workspace->u[i], workspace->v[i]);
    patch.is_print[at] = true;
    patch.gray[at] = workspace->pixels.gray[i];
    patch.print[at] = static_cast<float>(1 - blackness * workspace->points.dark[i]);
  }
  Close(disc.offsets(), &patch, &patch.gray);
  Close(disc.offsets(), &patch, &patch.print);
  for (std::size_t i = 0; i < workspace->count; ++i) {
    const std::size_t at = patch.IndexOf(workspace->u[i], workspace->v[i]);
    workspace->light[i] = patch.gray[at] / patch.print[at];
  }
}

// Removes the shadows from the gray values of the workspace. False when no shadows explain what the
// print does not.
bool SmallPatternFitter::EvenOut(SmallPatternWorkspace* workspace, State* state) const {
  const double before = Unexplained(*workspace);
  MeasureLight(*state, workspace);
  std::copy_n(workspace->light.begin(), workspace->count, workspace->magnitudes.begin());
  const float brightest = QuantileInPlace(std::span(workspace->magnitudes).first(workspace->count),
                                          kBrightest, QuantileRank::kShareBelow);
  const auto least = static_cast<float>(kLeastLight) * brightest;

  for (std::size_t i = 0; i < workspace->count; ++i) {
    const float factor = brightest / std::clamp(workspace->light[i], least, brightest);
    workspace->pixels.gray[i] *= factor;
  }
  if (Unexplained(*workspace) > kMaxRemaining * before) return false;
  MeasureLevels(*workspace, state);
  return state->contrast >= GrayContrast::kLeast;
}

}  // namespace kestrel
