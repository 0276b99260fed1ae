// SPDX-License-Identifier: BSD-3-Clause
// Trains the digit model on rendered faces and prints how many digits of other fonts it gets right:
//
//   train_digits --train A.ttf B.ttf ... --test C.ttf ... --output
//   src/kestrel/vision/objects/digits.txt
//
// A face is painted, given a white digit, and seen from an oblique side at 18 to 70 px, blurred,
// noisy, in sun or shade, and with corners that are off by up to 4 % of its side. docs/digits.md
// has the command that made the model in the sources.
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/freetype.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/vision/objects/digits/digit_classifier.h"

namespace kestrel {
namespace {

constexpr int kFacesPerFontAndDigit = 150;
constexpr int kPaintSide = 256;  // px of a face before it is seen from afar
constexpr int kViewSide = 120;

class FaceMaker {
 public:
  FaceMaker(const std::string& font, std::uint64_t seed)
      : font_(cv::freetype::createFreeType2()), random_(seed) {
    font_->loadFontData(font, 0);
  }

  struct Face {
    cv::Mat image;
    FaceCorners corners;  // the first at the upper left of the upright digit
  };

  Face Make(int digit) {
    const cv::Mat paint = Paint(digit);
    const double side_px = random_.Uniform(18, 70);
    const Eigen::Rotation2Dd turn(random_.Uniform(0, 2 * std::numbers::pi));
    const Eigen::Rotation2Dd tilt_direction(random_.Uniform(0, std::numbers::pi));
    const double squeeze = random_.Uniform(0.7, 1);
    constexpr std::array<std::array<double, 2>, 4> kSquare = {
        {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    Face face;
    std::array<cv::Point2f, 4> from;
    std::array<cv::Point2f, 4> to;
    for (int i = 0; i < 4; ++i) {
      Eigen::Vector2d at = tilt_direction.inverse() * (turn * Eigen::Vector2d(kSquare[i].data()));
      at.x() *= squeeze;
      at = side_px * (tilt_direction * at);
      const Eigen::Vector2d pixel = at + Eigen::Vector2d::Constant(0.5 * kViewSide);
      from[i] = {static_cast<float>((kSquare[i][0] + 0.5) * kPaintSide),
                 static_cast<float>((kSquare[i][1] + 0.5) * kPaintSide)};
      to[i] = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
      face.corners[i] =
          pixel + side_px * 0.02 * Eigen::Vector2d(random_.Normal(), random_.Normal());
    }
    // Averaged from a larger image, as a camera's pixels do.
    constexpr int kFine = 3;
    for (cv::Point2f& point : to) point = point * kFine;
    cv::Mat fine(kFine * kViewSide, kFine * kViewSide, CV_8UC3, Gray());
    cv::warpPerspective(paint, fine, cv::getPerspectiveTransform(from, to), fine.size(),
                        cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
    cv::resize(fine, face.image, cv::Size(kViewSide, kViewSide), 0, 0, cv::INTER_AREA);
    Degrade(&face.image);
    return face;
  }

 private:
  cv::Scalar Gray() { return cv::Scalar::all(random_.Uniform(60, 150)); }

  cv::Mat Paint(int digit) {
    static const std::array<cv::Scalar, 3> kPaints = {
        cv::Scalar(35, 30, 190), cv::Scalar(50, 160, 90), cv::Scalar(120, 60, 10)};
    cv::Mat ink(kPaintSide, kPaintSide, CV_8UC3, cv::Scalar::all(0));  // what FreeType draws on
    const int height = static_cast<int>(kPaintSide * random_.Uniform(0.5, 0.8));
    const std::string text = std::to_string(digit);
    int baseline = 0;
    const cv::Size size = font_->getTextSize(text, height, -1, &baseline);
    const cv::Point origin(static_cast<int>(0.5 * (kPaintSide - size.width) +
                                            random_.Uniform(-0.05, 0.05) * kPaintSide),
                           static_cast<int>(0.5 * (kPaintSide + size.height) +
                                            random_.Uniform(-0.05, 0.05) * kPaintSide));
    font_->putText(ink, text, origin, height, cv::Scalar::all(255), -1, cv::LINE_AA, true);
    cv::cvtColor(ink, ink, cv::COLOR_BGR2GRAY);
    Slant(&ink);
    Thicken(&ink);
    cv::Mat paint(ink.size(), CV_8UC3, kPaints[random_.Integer(0, 2)]);
    paint.setTo(cv::Scalar::all(235), ink > 127);
    return paint;
  }

  // Half of the digits are set in italics.
  void Slant(cv::Mat* ink) {
    if (!random_.Chance(0.5)) return;
    const double slant = random_.Uniform(0.1, 0.35);
    const cv::Matx23d shear(1, -slant, 0.5 * slant * kPaintSide, 0, 1, 0);
    cv::warpAffine(*ink, *ink, shear, ink->size());
  }

  // Digits are painted with brushes, too.
  void Thicken(cv::Mat* ink) {
    const int reach = random_.Integer(0, 5);
    const cv::Size size(2 * reach + 1, 2 * reach + 1);
    cv::dilate(*ink, *ink, cv::getStructuringElement(cv::MORPH_ELLIPSE, size));
  }

  void Degrade(cv::Mat* image) {
    cv::GaussianBlur(*image, *image, cv::Size(), random_.Uniform(0.3, 1.3));
    const double light = random_.Uniform(0.45, 1.1);
    const double slope = random_.Uniform(-0.2, 0.2) / kViewSide;
    image->forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
      for (int c = 0; c < 3; ++c) {
        pixel[c] = cv::saturate_cast<uchar>(pixel[c] * (light + slope * at[1]));
      }
    });
    cv::Mat noise(image->size(), CV_8UC3);
    cv::RNG rng(random_.Bits());
    rng.fill(noise, cv::RNG::NORMAL, 128, random_.Uniform(1, 6));
    cv::addWeighted(*image, 1, noise, 1, -128, *image);
  }

  cv::Ptr<cv::freetype::FreeType2> font_;
  Random random_;
};

// Calls visit(digit, views) for all faces of all fonts.
template <class Visit>
void ForEachDigit(const std::vector<std::string>& fonts, std::uint64_t seed, const Visit& visit) {
  for (const std::string& font : fonts) {
    FaceMaker maker(font, ++seed);
    for (int digit = 0; digit < kDigitCount; ++digit) {
      for (int i = 0; i < kFacesPerFontAndDigit; ++i) {
        const FaceMaker::Face face = maker.Make(digit);
        if (const auto views = CutOutDigit(face.image, face.corners)) visit(digit, *views);
      }
    }
  }
}

// A 6 that is upside down is a 9.
int WithoutUp(int digit) { return digit == 9 ? 6 : digit; }

void PrintScore(const DigitModel& model, const std::string& font, std::uint64_t seed) {
  const DigitClassifier classifier(model);
  int count = 0;
  int right = 0;
  std::map<std::pair<int, int>, int> wrong;
  ForEachDigit({font}, seed, [&](int digit, const DigitViews& views) {
    const DigitLikelihoods likelihoods = classifier.Classify(views);
    const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
    const int found = static_cast<int>(best - likelihoods.begin());
    ++count;
    if (WithoutUp(found) == WithoutUp(digit)) {
      ++right;
    } else {
      ++wrong[{digit, found}];
    }
  });
  fmt::print("{}: {:.1f} % of {} right (6 and 9 as one)", font, 100.0 * right / count, count);
  for (const auto& [pair, times] : wrong) fmt::print(" {}->{}:{}", pair.first, pair.second, times);
  fmt::print("\n");
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Trains the digit model on fonts");
  std::vector<std::string> train;
  std::vector<std::string> test;
  std::string output;
  app.add_option("--train", train, "Fonts to learn from")->required()->check(CLI::ExistingFile);
  app.add_option("--test", test, "Fonts to print the score of")->check(CLI::ExistingFile);
  app.add_option("--output", output, "File for the model");
  CLI11_PARSE(app, argc, argv);
  kestrel::DigitTrainer trainer;
  kestrel::ForEachDigit(train, /*seed=*/0, [&](int digit, const kestrel::DigitViews& views) {
    trainer.Add(digit, views[0]);  // upright
  });
  for (const std::string& font : test) kestrel::PrintScore(trainer.Model(), font, /*seed=*/1000);
  try {
    if (!output.empty()) kestrel::WriteFile(output, kestrel::PrintDigitModel(trainer.Model()));
  } catch (const kestrel::InputError& error) {
    fmt::print(stderr, "train_digits: {}\n", error.what());
    return 1;
  }
  return 0;
}
