// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/digits/digit_classifier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/vision/objects/embedded_data.h"

namespace kestrel {
namespace {

constexpr char kHeading[] = "digits";

[[noreturn]] void Fail(const std::string& file, int line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: {}", file, line, message));
}

DigitModel CountPixels(const std::array<std::vector<DigitImage>, kDigitCount>& images,
                       const std::array<std::vector<int>, kDigitCount>& figures) {
  DigitModel model{};
  std::array<int, kFigureCount> counts{};
  for (int digit = 0; digit < kDigitCount; ++digit) {
    for (std::size_t k = 0; k < images[digit].size(); ++k) {
      const int figure = figures[digit][k];
      ++counts[figure];
      for (std::size_t i = 0; i < images[digit][k].size(); ++i) {
        model[figure][i] += images[digit][k][i];
      }
    }
  }
  for (int figure = 0; figure < kFigureCount; ++figure) {
    for (float& share : model[figure]) {
      share = (share + 1) / static_cast<float>(counts[figure] + 2);
    }
  }
  return model;
}

}  // namespace

LikelyDigit LikeliestDigit(const DigitLikelihoods& likelihoods) {
  const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
  return {static_cast<int>(best - likelihoods.begin()), *best};
}

DigitModel ParseDigitModel(const std::string& text, const std::string& file) {
  DigitModel model;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const std::string heading =
      fmt::format("{} {} {} {}", kHeading, kDigitCount, kStyleCount, kDigitSide);
  if (line != heading) Fail(file, 1, fmt::format("expected '{}'", heading));
  for (int i = 0; i < kFigureCount * kDigitSide; ++i) {
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
  if (std::getline(lines, line)) Fail(file, kFigureCount * kDigitSide + 2, "expected the end");
  return model;
}

std::string PrintDigitModel(const DigitModel& model) {
  std::string text = fmt::format("{} {} {} {}\n", kHeading, kDigitCount, kStyleCount, kDigitSide);
  for (const DigitFigure& shares : model) {
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

DigitClassifier::DigitClassifier(const DigitModel& model) {
  DigitFigure mean{};
  for (int figure = 0; figure < kFigureCount; ++figure) {
    figures_[figure] = LogOf(model[figure]);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += model[figure][i] / kFigureCount;
  }
  mean_ = LogOf(mean);
}

DigitClassifier::LogFigure DigitClassifier::LogOf(const DigitFigure& figure) {
  LogFigure log{};
  for (std::size_t i = 0; i < figure.size(); ++i) {
    const float set = std::log(figure[i]);
    const float not_set = std::log(1 - figure[i]);
    log.set_gain[i] = set - not_set;
    log.empty += not_set;
  }
  return log;
}

int DigitClassifier::LikeliestFigure(const DigitImage& image, int digit) const {
  int best = digit * kStyleCount;
  for (int figure = best + 1; figure < (digit + 1) * kStyleCount; ++figure) {
    if (LogLikelihood(image, figures_[figure]) > LogLikelihood(image, figures_[best])) {
      best = figure;
    }
  }
  return best;
}

double DigitClassifier::LogLikelihood(const DigitImage& image, const LogFigure& figure) {
  double sum = figure.empty;
  for (std::size_t i = 0; i < image.size(); ++i) sum += image[i] * figure.set_gain[i];
  return sum;
}

DigitLikelihoods DigitClassifier::Classify(const DigitViews& views) const {
  // Neighbouring pixels are correlated: ten count as one.
  constexpr double kIndependentShare = 0.1;
  DigitLikelihoods log_likelihoods;
  log_likelihoods.fill(-std::numeric_limits<double>::infinity());
  double none = -std::numeric_limits<double>::infinity();  // the same for what is no digit
  for (const DigitImage& view : views) {
    none = std::max(none, kIndependentShare * LogLikelihood(view, mean_));
    for (int figure = 0; figure < kFigureCount; ++figure) {
      double& best = log_likelihoods[figure / kStyleCount];
      best = std::max(best, kIndependentShare * LogLikelihood(view, figures_[figure]));
    }
  }
  // A few pixels that differ between 6 and 9 differ by chance. In a map such chance would
  // accumulate.
  log_likelihoods[6] = log_likelihoods[9] = std::max(log_likelihoods[6], log_likelihoods[9]);
  const double best =
      std::max(none, *std::max_element(log_likelihoods.begin(), log_likelihoods.end()));
  none = std::exp(none - best);
  double total = none;
  for (double& x : log_likelihoods) total += x = std::exp(x - best);
  for (double& x : log_likelihoods) x = (x + none / kDigitCount) / total;
  return log_likelihoods;
}

DigitModel DigitTrainer::Model() const {
  constexpr int kRounds = 20;
  std::array<std::vector<int>, kDigitCount> figures;  // index of each image's figure
  for (int digit = 0; digit < kDigitCount; ++digit) {
    const std::size_t count = images_[digit].size();
    for (std::size_t i = 0; i < count; ++i) {
      figures[digit].push_back(digit * kStyleCount + static_cast<int>(i * kStyleCount / count));
    }
  }
  DigitModel model = CountPixels(images_, figures);
  for (int round = 0; round < kRounds; ++round) {
    const DigitClassifier classifier(model);
    for (int digit = 0; digit < kDigitCount; ++digit) {
      for (std::size_t i = 0; i < images_[digit].size(); ++i) {
        figures[digit][i] = classifier.LikeliestFigure(images_[digit][i], digit);
      }
    }
    model = CountPixels(images_, figures);
  }
  return model;
}

}  // namespace kestrel
