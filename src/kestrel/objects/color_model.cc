// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/color_model.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "kestrel/base/error.h"

namespace kestrel {
namespace {

double Square(double x) { return x * x; }

bool IsPart(float x) { return x >= 0 && x <= 1; }

void ValidateComponent(const ColorComponent& component, const std::string& where,
                       std::vector<std::string>* violations) {
  const auto require = [&](bool holds, const char* rule) {
    if (!holds) violations->push_back(fmt::format("{}: {}", where, rule));
  };
  require(component.weight > 0 && component.weight < 1e6, "weight must be positive");
  require(component.mean.hue_deg >= 0 && component.mean.hue_deg < 360,
          "the mean's hue must be in 0 to 360");
  require(IsPart(component.mean.saturation), "the mean's saturation must be in 0 to 1");
  require(IsPart(component.mean.value), "the mean's value must be in 0 to 1");
  const auto is_sigma = [](float x) { return x > 0 && x < 1e4F; };
  require(is_sigma(component.sigma.hue_deg) && is_sigma(component.sigma.saturation) &&
              is_sigma(component.sigma.value),
          "the sigmas must be positive");
}

void ValidateMixture(const ColorMixture& mixture, std::vector<std::string>* violations) {
  for (std::size_t i = 0; i < mixture.components.size(); ++i) {
    ValidateComponent(mixture.components[i], fmt::format("{}, component {}", mixture.name, i + 1),
                      violations);
  }
}

// Mean and deviations of samples with weights; the hue's mean is that of its unit vectors.
ColorComponent WeightedComponent(std::span<const Hsv> samples, std::span<const double> weights) {
  constexpr double kRadians = std::numbers::pi / 180;
  constexpr Hsv kMinSigma{4, 0.04F, 0.05F};
  double sum = 0;
  double x = 0;
  double y = 0;
  double saturation = 0;
  double value = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += weights[i];
    x += weights[i] * std::cos(kRadians * samples[i].hue_deg);
    y += weights[i] * std::sin(kRadians * samples[i].hue_deg);
    saturation += weights[i] * samples[i].saturation;
    value += weights[i] * samples[i].value;
  }
  ColorComponent component;
  component.weight = sum / static_cast<double>(samples.size());
  const auto hue = static_cast<float>(std::atan2(y, x) / kRadians);
  component.mean = {hue < 0 ? hue + 360 : hue, static_cast<float>(saturation / sum),
                    static_cast<float>(value / sum)};
  double hue_square = 0;
  double saturation_square = 0;
  double value_square = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    hue_square += weights[i] * Square(HueDifference(samples[i].hue_deg, component.mean.hue_deg));
    saturation_square += weights[i] * Square(samples[i].saturation - component.mean.saturation);
    value_square += weights[i] * Square(samples[i].value - component.mean.value);
  }
  const auto sigma = [&](double square, float min) {
    return std::max(min, static_cast<float>(std::sqrt(square / sum)));
  };
  component.sigma = {sigma(hue_square, kMinSigma.hue_deg),
                     sigma(saturation_square, kMinSigma.saturation),
                     sigma(value_square, kMinSigma.value)};
  return component;
}

// Splits the component along the saturation and value in which its samples spread most.
std::vector<ColorComponent> SplitStart(std::span<const Hsv> samples, int count) {
  const std::vector<double> ones(samples.size(), 1.0);
  const ColorComponent whole = WeightedComponent(samples, ones);
  std::vector<ColorComponent> start(count, whole);
  for (int i = 0; i < count; ++i) {
    const float offset = count == 1 ? 0 : 2.0F * i / (count - 1) - 1;
    start[i].mean.saturation += offset * whole.sigma.saturation;
    start[i].mean.value -= offset * whole.sigma.value;
    start[i].weight = 1.0 / count;
  }
  return start;
}

}  // namespace

double ColorComponent::Mahalanobis(const Hsv& color) const {
  return std::sqrt(Square(HueDifference(color.hue_deg, mean.hue_deg) / sigma.hue_deg) +
                   Square((color.saturation - mean.saturation) / sigma.saturation) +
                   Square((color.value - mean.value) / sigma.value));
}

double ColorComponent::LogDensity(const Hsv& color) const {
  const double volume = static_cast<double>(sigma.hue_deg) * sigma.saturation * sigma.value;
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
  if (!(max_distance > 0 && max_distance < 100)) {
    violations.emplace_back("max_distance must be positive and below 100");
  }
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
      double sum = 1e-300;
      for (std::size_t k = 0; k < components.size(); ++k) {
        sum += shares[k][i] = std::exp(components[k].LogDensity(samples[i]));
      }
      for (std::size_t k = 0; k < components.size(); ++k) shares[k][i] /= sum;
    }
    for (std::size_t k = 0; k < components.size(); ++k) {
      const ColorComponent updated = WeightedComponent(samples, shares[k]);
      components[k].weight = updated.weight;
      if (updated.weight >= kMinWeight) components[k] = updated;
    }
  }
  std::erase_if(components, [](const ColorComponent& c) { return !(c.weight >= kMinWeight); });
  return {name, components};
}

}  // namespace kestrel
