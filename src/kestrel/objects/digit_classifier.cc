// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/digit_classifier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/objects/embedded_data.h"

namespace kestrel {
namespace {

constexpr char kHeading[] = "digits";

[[noreturn]] void Fail(const std::string& file, int line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: {}", file, line, message));
}

}  // namespace

DigitModel ParseDigitModel(const std::string& text, const std::string& file) {
  DigitModel model;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const std::string heading = fmt::format("{} {} {}", kHeading, kDigitCount, kDigitSide);
  if (line != heading) Fail(file, 1, fmt::format("expected '{}'", heading));
  for (int i = 0; i < kDigitCount * kDigitSide; ++i) {
    if (!std::getline(lines, line)) Fail(file, i + 2, "ends here, expected more rows");
    if (line.size() != 2 * kDigitSide) {
      Fail(file, i + 2, fmt::format("expected {} numbers of two digits", kDigitSide));
    }
    for (int column = 0; column < kDigitSide; ++column) {
      const auto percent =
          ParseNumber<int>(std::string_view(line).substr(2 * static_cast<std::size_t>(column), 2));
      if (!percent || *percent < 1) Fail(file, i + 2, "expected percent, 01 to 99");
      model[i / kDigitSide][i % kDigitSide * kDigitSide + column] = 0.01F * *percent;
    }
  }
  if (std::getline(lines, line)) Fail(file, kDigitCount * kDigitSide + 2, "expected the end");
  return model;
}

std::string PrintDigitModel(const DigitModel& model) {
  std::string text = fmt::format("{} {} {}\n", kHeading, kDigitCount, kDigitSide);
  for (const auto& shares : model) {
    for (int i = 0; i < kDigitSide * kDigitSide; ++i) {
      const long percent = std::lround(100 * shares[i]);
      text += fmt::format("{:02}", std::clamp(percent, 1L, 99L));
      if (i % kDigitSide == kDigitSide - 1) text += '\n';
    }
  }
  return text;
}

const DigitModel& DefaultDigitModel() {
  static const DigitModel model =
      ParseDigitModel(std::string(kDefaultDigitModelText), "default digit model");
  return model;
}

DigitClassifier::DigitClassifier(const DigitModel& model) : set_gain_(), empty_() {
  for (int digit = 0; digit < kDigitCount; ++digit) {
    for (int i = 0; i < kDigitSide * kDigitSide; ++i) {
      const float set = std::log(model[digit][i]);
      const float not_set = std::log(1 - model[digit][i]);
      set_gain_[digit][i] = set - not_set;
      empty_[digit] += not_set;
    }
  }
}

DigitLikelihoods DigitClassifier::Classify(const DigitImage& digit) const {
  // Neighbouring pixels say the same: about ten of them are worth one.
  constexpr double kIndependentShare = 0.1;
  DigitLikelihoods log_likelihoods;
  log_likelihoods.fill(-std::numeric_limits<double>::infinity());
  DigitImage turned = digit;
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int k = 0; k < kDigitCount; ++k) {
      double sum = empty_[k];
      for (std::size_t i = 0; i < turned.size(); ++i) sum += turned[i] * set_gain_[k][i];
      log_likelihoods[k] = std::max(log_likelihoods[k], kIndependentShare * sum);
    }
    turned = QuarterTurn(turned);
  }
  const double best = *std::max_element(log_likelihoods.begin(), log_likelihoods.end());
  double total = 0;
  for (double& x : log_likelihoods) total += x = std::exp(x - best);
  for (double& x : log_likelihoods) x /= total;
  return log_likelihoods;
}

void DigitTrainer::Add(int digit, const DigitImage& image) {
  ++images_[digit];
  for (std::size_t i = 0; i < image.size(); ++i) set_[digit][i] += image[i];
}

DigitModel DigitTrainer::Model() const {
  DigitModel model = set_;
  for (int digit = 0; digit < kDigitCount; ++digit) {
    for (float& share : model[digit]) share = (share + 1) / static_cast<float>(images_[digit] + 2);
  }
  return model;
}

}  // namespace kestrel
