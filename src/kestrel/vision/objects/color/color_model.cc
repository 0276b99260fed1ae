// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

double Square(double x) { return x * x; }

constexpr double kMaxCorrelation = 0.99;

bool IsPart(float x) { return x >= 0 && x <= 1; }

bool IsPositive(double x) { return x > 0 && std::isfinite(x); }

void ValidateComponent(const ColorComponent& component, const std::string& where,
                       std::vector<std::string>* violations) {
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) violations->push_back(fmt::format("{}: {}", where, rule));
  };
  require(IsPositive(component.weight), "weight must be positive");
  require(component.mean.hue_deg >= 0 && component.mean.hue_deg < 360,
          "the mean's hue must be in 0 to 360");
  require(IsPart(component.mean.saturation), "the mean's saturation must be in 0 to 1");
  require(IsPart(component.mean.value), "the mean's value must be in 0 to 1");
  require(IsPositive(component.sigma.hue_deg) && IsPositive(component.sigma.saturation) &&
              IsPositive(component.sigma.value),
          "the sigmas must be positive");
  require(std::abs(component.correlation) <= kMaxCorrelation,
          "the correlation must be in -0.99 to 0.99");
}

void ValidateMixture(const ColorMixture& mixture, std::vector<std::string>* violations) {
  for (std::size_t i = 0; i < mixture.components.size(); ++i) {
    ValidateComponent(mixture.components[i], fmt::format("{}, component {}", mixture.name, i + 1),
                      violations);
  }
}

// Standard deviations of one colour due to the camera's noise.
constexpr Hsv kNoise{4, 0.04F, 0.05F};

// Offset of 'color' from 'mean' in standard deviations of the noise: hue, saturation, value.
Eigen::Vector3d Offset(const Hsv& color, const Hsv& mean) {
  return {HueDifference(color.hue_deg, mean.hue_deg) / kNoise.hue_deg,
          (color.saturation - mean.saturation) / kNoise.saturation,
          (color.value - mean.value) / kNoise.value};
}

// Moments of weighted samples. The mean hue is the direction of the mean unit vector.
struct Moments {
  double weight = 0;  // mean
  Hsv mean;
  Eigen::Matrix3d covariance;  // covariance of Offset
};

Moments WeightedMoments(std::span<const Hsv> samples, std::span<const double> weights) {
  double sum = 0;
  double x = 0;
  double y = 0;
  double saturation = 0;
  double value = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += weights[i];
    x += weights[i] * std::cos(Radians(samples[i].hue_deg));
    y += weights[i] * std::sin(Radians(samples[i].hue_deg));
    saturation += weights[i] * samples[i].saturation;
    value += weights[i] * samples[i].value;
  }
  Moments moments{sum / static_cast<double>(samples.size()), {}, Eigen::Matrix3d::Zero()};
  const auto hue = static_cast<float>(Degrees(std::atan2(y, x)));
  moments.mean = {hue < 0 ? std::fmod(hue + 360, 360.0F) : hue,
                  static_cast<float>(saturation / sum), static_cast<float>(value / sum)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d offset = Offset(samples[i], moments.mean);
    moments.covariance += weights[i] / sum * offset * offset.transpose();
  }
  return moments;
}

// Makes a component with at least the noise's deviation in every direction.
ColorComponent ComponentOf(const Moments& moments) {
  const Eigen::Matrix2d plane = moments.covariance.topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(plane);
  const Eigen::Matrix2d c = axes.eigenvectors() * axes.eigenvalues().cwiseMax(1.0).asDiagonal() *
                            axes.eigenvectors().transpose();
  const Eigen::Vector2d sigma = c.diagonal().cwiseSqrt();
  const double value_sigma = std::sqrt(std::max(1.0, moments.covariance(2, 2)));
  ColorComponent component;
  component.weight = moments.weight;
  component.mean = moments.mean;
  component.sigma = {kNoise.hue_deg * static_cast<float>(sigma(0)),
                     kNoise.saturation * static_cast<float>(sigma(1)),
                     kNoise.value * static_cast<float>(value_sigma)};
  component.correlation =
      std::clamp(c(0, 1) / (sigma(0) * sigma(1)), -kMaxCorrelation, kMaxCorrelation);
  return component;
}

// Places the start components along the direction in which the samples spread most.
std::vector<ColorComponent> SplitStart(std::span<const Hsv> samples, int count) {
  const std::vector<double> ones(samples.size(), 1.0);
  const Moments whole = WeightedMoments(samples, ones);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(whole.covariance);
  const Eigen::Vector3f reach =
      (std::sqrt(std::max(0.0, axes.eigenvalues()(2))) * axes.eigenvectors().col(2)).cast<float>();
  std::vector<ColorComponent> start(count, ComponentOf(whole));
  for (int i = 0; i < count; ++i) {
    const float offset =
        count == 1 ? 0 : 2 * static_cast<float>(i) / static_cast<float>(count - 1) - 1;
    Hsv& mean = start[i].mean;
    mean.hue_deg += offset * reach(0) * kNoise.hue_deg;
    mean.saturation += offset * reach(1) * kNoise.saturation;
    mean.value += offset * reach(2) * kNoise.value;
    start[i].weight = 1.0 / count;
  }
  return start;
}

}  // namespace

double ColorComponent::Mahalanobis(const Hsv& color) const {
  const double hue = HueDifference(color.hue_deg, mean.hue_deg) / sigma.hue_deg;
  const double saturation = (color.saturation - mean.saturation) / sigma.saturation;
  const double value = (color.value - mean.value) / sigma.value;
  return std::sqrt((Square(hue) - 2 * correlation * hue * saturation + Square(saturation)) /
                       (1 - Square(correlation)) +
                   Square(value));
}

double ColorComponent::LogDensity(const Hsv& color) const {
  const double volume = static_cast<double>(sigma.hue_deg) * sigma.saturation * sigma.value *
                        std::sqrt(1 - Square(correlation));
  return std::log(weight / volume) - 0.5 * Square(Mahalanobis(color));
}

double ColorMixture::LogLikelihood(const Hsv& color) const {
  double best = -std::numeric_limits<double>::infinity();
  for (const ColorComponent& component : components) {
    best = std::max(best, component.LogDensity(color));
  }
  return best;
}

double ColorMixture::Mahalanobis(const Hsv& color) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ColorComponent& component : components) {
    nearest = std::min(nearest, component.Mahalanobis(color));
  }
  return nearest;
}

std::optional<std::size_t> ColorModel::Classify(const Hsv& color) const {
  std::optional<std::size_t> best;
  double best_likelihood = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (colors[i].Mahalanobis(color) > max_distance) continue;
    const double likelihood = colors[i].LogLikelihood(color);
    if (likelihood <= best_likelihood) continue;
    best_likelihood = likelihood;
    best = i;
  }
  return best;
}

std::vector<std::string> ColorModel::Validate() const {
  std::vector<std::string> violations;
  if (colors.empty()) violations.emplace_back("there must be at least one color");
  if (colors.size() > kMaxColors) {
    violations.push_back(fmt::format("there are {} colors, at most {}", colors.size(), kMaxColors));
  }
  if (!IsPositive(max_distance)) violations.emplace_back("max_distance must be positive");
  std::set<std::string> names;
  for (const ColorMixture& color : colors) {
    if (!names.insert(color.name).second) violations.push_back(color.name + ": is given twice");
    if (color.components.empty()) violations.push_back(color.name + ": has no component");
    ValidateMixture(color, &violations);
  }
  ValidateMixture(ambiguous, &violations);
  if (!violations.empty()) return violations;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (const ColorComponent& component : colors[i].components) {
      const std::size_t winner = Classify(component.mean).value_or(i);
      if (winner == i) continue;
      violations.push_back(fmt::format("{} and {} contradict each other: hue {:.0f} is both",
                                       colors[i].name, colors[winner].name,
                                       component.mean.hue_deg));
    }
  }
  return violations;
}

ColorMixture FitColorMixture(const std::string& name, std::span<const Hsv> samples,
                             int max_components) {
  constexpr int kRounds = 30;
  constexpr std::size_t kMinSamples = 10;
  constexpr double kMinWeight = 0.02;
  if (samples.size() < kMinSamples) {
    throw InputError(fmt::format("{}: {} pixels are marked, expected at least {}", name,
                                 samples.size(), kMinSamples));
  }
  std::vector<ColorComponent> components = SplitStart(samples, max_components);
  std::vector<std::vector<double>> shares(components.size(), std::vector<double>(samples.size()));
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double sum = std::numeric_limits<double>::min();
      for (std::size_t k = 0; k < components.size(); ++k) {
        sum += shares[k][i] = std::exp(components[k].LogDensity(samples[i]));
      }
      for (std::size_t k = 0; k < components.size(); ++k) shares[k][i] /= sum;
    }
    for (std::size_t k = 0; k < components.size(); ++k) {
      const Moments moments = WeightedMoments(samples, shares[k]);
      components[k].weight = moments.weight;
      if (moments.weight >= kMinWeight) components[k] = ComponentOf(moments);
    }
  }
  std::erase_if(components, [](const ColorComponent& c) { return !(c.weight >= kMinWeight); });
  return {name, components};
}

}  // namespace kestrel
