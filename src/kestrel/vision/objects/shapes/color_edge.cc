// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/color_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace kestrel {
namespace {

constexpr int kReach = 4;  // samples at -4 ... 4 px
constexpr int kSamples = 2 * kReach + 1;

using Profile = std::array<Eigen::Vector3f, kSamples>;

// Converts the values of a channel to a scale on which colours mix linearly. The optics mix light,
// which is about the square of a value; the camera's compression mixes the values themselves, and
// blurs colour more than the optics do. An exponent between both keeps the edge in place on ground
// of any brightness: 2 would move it towards bright ground, 1 towards dark ground.
const std::array<float, 256>& LightTable() {
  constexpr float kPower = 1.5F;
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light{};
    for (int i = 0; i < 256; ++i) light[i] = std::pow(static_cast<float>(i) / 255.0F, kPower);
    return light;
  }();
  return table;
}

Eigen::Vector3f LightAt(const std::uint8_t* bgr, const std::array<float, 256>& light) {
  return {light[bgr[0]], light[bgr[1]], light[bgr[2]]};
}

bool ReadProfile(const cv::Mat& image, const Eigen::Vector2d& start, const Eigen::Vector2d& outward,
                 Profile* profile) {
  const std::array<float, 256>& light = LightTable();
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d at = start + (i - kReach) * outward;
    const int u = static_cast<int>(std::floor(at.x()));
    const int v = static_cast<int>(std::floor(at.y()));
    if (u < 0 || v < 0 || u + 1 >= image.cols || v + 1 >= image.rows) return false;
    const auto x = static_cast<float>(at.x() - u);
    const auto y = static_cast<float>(at.y() - v);
    const std::uint8_t* upper = image.ptr(v) + 3 * u;
    const std::uint8_t* lower = image.ptr(v + 1) + 3 * u;
    (*profile)[i] = (1 - y) * ((1 - x) * LightAt(upper, light) + x * LightAt(upper + 3, light)) +
                    y * ((1 - x) * LightAt(lower, light) + x * LightAt(lower + 3, light));
  }
  return true;
}

// Returns the colour at a fractional index, clamped to the ends of the profile.
Eigen::Vector3f ColorAt(const Profile& profile, double index) {
  const double inside = std::clamp<double>(index, 0, kSamples - 1);
  const int i = std::min(static_cast<int>(inside), kSamples - 2);
  const auto part = static_cast<float>(inside - i);
  return (1 - part) * profile[i] + part * profile[i + 1];
}

// Returns the direction in colour space that best separates 'inside' from 'outside'. The direction
// of the outside colour, along which shadow and light move it, is excluded where the two colours
// differ by more than brightness: a disc on the ground has its own shadow around half of its edge.
Eigen::Vector3f AxisBetween(const Eigen::Vector3f& inside, const Eigen::Vector3f& outside) {
  constexpr float kMinShare = 0.4F;
  const Eigen::Vector3f difference = inside - outside;
  const float norm = std::max(outside.squaredNorm(), std::numeric_limits<float>::min());
  const Eigen::Vector3f hue = inside - inside.dot(outside) / norm * outside;
  return hue.norm() > kMinShare * difference.norm() ? hue : difference;
}

struct Crossing {
  double index;  // sample index at which the share of the inside passes one half
  float slope;   // decrease of the share of the inside per sample; positive
};

// Finds where the profile, after 'first', first passes half-way from 'inside' to 'outside'.
std::optional<Crossing> FindCrossing(const Profile& profile, const Eigen::Vector3f& inside,
                                     const Eigen::Vector3f& outside, int first) {
  constexpr float kMinContrast = 0.02F;
  const Eigen::Vector3f axis = AxisBetween(inside, outside);
  if (axis.norm() < kMinContrast) return std::nullopt;
  const float contrast = axis.dot(inside - outside);
  const auto share = [&](int i) { return axis.dot(profile[i] - outside) / contrast; };
  float last = share(first);
  for (int i = first + 1; i < kSamples; ++i) {
    const float here = share(i);
    const float slope = last - here;
    if (last >= 0.5F && here < 0.5F) return Crossing{i - (0.5F - here) / slope, slope};
    last = here;
  }
  return std::nullopt;
}

}  // namespace

bool ShowsColorEdge(const cv::Size& image, const Eigen::Vector2d& start,
                    const Eigen::Vector2d& outward) {
  const auto is_inside = [&](const Eigen::Vector2d& at) {
    return at.x() >= 0 && at.y() >= 0 && at.x() < image.width - 1 && at.y() < image.height - 1;
  };
  return is_inside(start - kReach * outward) && is_inside(start + kReach * outward);
}

std::optional<ColorEdge> FindColorEdge(const cv::Mat& image, const Eigen::Vector2d& start,
                                       const Eigen::Vector2d& outward) {
  constexpr double kBeside = 3;  // distance from the edge at which a blurred profile is flat again
  Profile profile;
  if (!ReadProfile(image, start, outward, &profile)) return std::nullopt;
  std::optional<Crossing> edge =
      FindCrossing(profile, 0.5F * (profile[1] + profile[2]), profile[kSamples - 2], /*first=*/1);
  // Repeats with the colours at equal distances on both sides of the edge.
  if (!edge) return std::nullopt;
  const double first = std::max(0.0, edge->index - kBeside);
  edge = FindCrossing(profile, ColorAt(profile, edge->index - kBeside),
                      ColorAt(profile, edge->index + kBeside), static_cast<int>(first));
  if (!edge) return std::nullopt;
  const double blur_px = 1 / (std::sqrt(2 * std::numbers::pi) * edge->slope);
  return ColorEdge{edge->index - kReach, blur_px};
}

}  // namespace kestrel
