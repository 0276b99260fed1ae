// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"

namespace kestrel {

// Pictures without a tag, of things that have the outlines of some: drawn on a wall, seen aslant,
// blurred, with noise.

inline const cv::Size kTaglessSize(480, 360);  // px

// A wall with things in a square each.
class TaglessDrawing {
 public:
  explicit TaglessDrawing(Random* random)
      : random_(*random),
        wall_(random_.Uniform(120, 235)),
        image_(kTaglessSize * kScale, CV_32FC1, cv::Scalar(wall_)) {}

  // Calls 'thing' with places of random size and turn: it fills polygons in the unit square.
  template <class Thing>
  void Place(int count, double least_px, double most_px, const Thing& thing) {
    for (int i = 0; i < count; ++i) {
      side_ = kScale * least_px * std::pow(most_px / least_px, random_.Uniform());
      const double turn = random_.Chance(0.5) ? 0 : random_.Uniform(-0.6, 0.6);
      cosine_ = std::cos(turn);
      sine_ = std::sin(turn);
      center_ = {random_.Uniform(0.6 * side_, image_.cols - 0.6 * side_),
                 random_.Uniform(0.6 * side_, image_.rows - 0.6 * side_)};
      thing();
    }
  }
  void Fill(const std::vector<cv::Point2d>& outline, double gray) {
    constexpr int kShift = 4;
    std::vector<cv::Point> points;
    for (const cv::Point2d& point : outline) {
      const cv::Point2d d = side_ * (point - cv::Point2d(0.5, 0.5));
      const cv::Point2d at =
          center_ + cv::Point2d(cosine_ * d.x - sine_ * d.y, sine_ * d.x + cosine_ * d.y);
      points.emplace_back(static_cast<int>(std::lround(at.x * (1 << kShift))),
                          static_cast<int>(std::lround(at.y * (1 << kShift))));
    }
    cv::fillPoly(image_, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(gray), cv::LINE_8,
                 kShift);
  }
  void Box(double left, double top, double right, double bottom, double gray) {
    Fill({{left, top}, {right, top}, {right, bottom}, {left, bottom}}, gray);
  }
  // A box with round corners; a disc where 'radius' is half of its sides.
  void RoundBox(double left, double top, double right, double bottom, double radius, double gray) {
    constexpr int kPoints = 10;  // along a quarter
    const double x[] = {right - radius, left + radius, left + radius, right - radius};
    const double y[] = {bottom - radius, bottom - radius, top + radius, top + radius};
    std::vector<cv::Point2d> outline;
    for (int i = 0; i < 4 * kPoints; ++i) {
      const double angle = 2 * M_PI * (i + 0.5) / (4 * kPoints);
      outline.emplace_back(x[i / kPoints] + radius * std::cos(angle),
                           y[i / kPoints] + radius * std::sin(angle));
    }
    Fill(outline, gray);
  }
  void Write(const std::string& text, double scale, cv::Point at, double gray) {
    cv::putText(image_, text, at, random_.Integer(0, 4), kScale * scale, cv::Scalar(gray),
                std::max(1, static_cast<int>(std::lround(kScale * scale * random_.Uniform(2, 6)))),
                cv::LINE_8);
  }
  double wall() const { return wall_; }
  double Dark() { return random_.Uniform(10, 0.4 * wall_); }
  double Light() { return random_.Uniform(0.8 * wall_, 250); }
  cv::Mat& image() { return image_; }

  // Returns the drawing as a camera takes it.
  cv::Mat Taken() {
    const auto moved = [this](double x, double y) {
      constexpr double kMost = 0.12;  // as a share of the image
      return cv::Point2f(static_cast<float>((x + random_.Uniform(-kMost, kMost)) * image_.cols),
                         static_cast<float>((y + random_.Uniform(-kMost, kMost)) * image_.rows));
    };
    const auto width = static_cast<float>(image_.cols);
    const auto height = static_cast<float>(image_.rows);
    const std::array<cv::Point2f, 4> from{{{0, 0}, {width, 0}, {width, height}, {0, height}}};
    const std::array<cv::Point2f, 4> to{moved(0, 0), moved(1, 0), moved(1, 1), moved(0, 1)};
    cv::Mat seen;
    cv::warpPerspective(image_, seen, cv::getPerspectiveTransform(from.data(), to.data()),
                        image_.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::resize(seen, seen, kTaglessSize, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(seen, seen, cv::Size(), random_.Uniform(0.3, 1.2));
    const double noise = random_.Uniform(0.5, 5);
    cv::Mat taken(seen.size(), CV_8UC1);
    for (int v = 0; v < seen.rows; ++v) {
      for (int u = 0; u < seen.cols; ++u) {
        taken.at<std::uint8_t>(v, u) =
            cv::saturate_cast<std::uint8_t>(seen.at<float>(v, u) + noise * random_.Normal());
      }
    }
    return taken;
  }

 private:
  static constexpr int kScale = 3;  // pixels of the drawing per pixel of the picture

  Random& random_;
  double wall_;
  cv::Mat image_;
  double side_ = 1, cosine_ = 1, sine_ = 0;
  cv::Point2d center_;
};

// Dark panes with bars and lamps in them, as many cells wide as those of tags.
inline cv::Mat WindowsWithLamps(Random* random) {
  TaglessDrawing drawing(random);
  drawing.Place(random->Integer(2, 5), 25, 120, [&] {
    const double dark = drawing.Dark();
    drawing.Box(0, 0, 1, 1, dark);
    const int cells = random->Integer(6, 9);
    for (int lamps = random->Integer(0, 2); lamps >= 0; --lamps) {
      const int left = random->Integer(1, cells - 2), top = random->Integer(1, cells - 2);
      const int right = random->Integer(left, cells - 2), bottom = random->Integer(top, cells - 2);
      drawing.Box(1.0 * left / cells, 1.0 * top / cells, (right + 1.0) / cells,
                  (bottom + 1.0) / cells, drawing.Light());
    }
  });
  return drawing.Taken();
}

inline cv::Mat Letters(Random* random) {
  TaglessDrawing drawing(random);
  for (int line = 1; line < 7; ++line) {
    std::string text;
    for (int i = 0; i < 14; ++i) text += static_cast<char>(random->Integer('0', 'Z'));
    drawing.Write(text, random->Uniform(0.6, 2.2),
                  {random->Integer(0, 200), line * drawing.image().rows / 7}, drawing.Dark());
  }
  return drawing.Taken();
}

// Round-cornered dark squares with one or two highlights.
inline cv::Mat Buttons(Random* random) {
  TaglessDrawing drawing(random);
  drawing.Place(random->Integer(3, 8), 20, 90, [&] {
    drawing.RoundBox(0, 0, 1, 1, random->Uniform(0.03, 0.3), drawing.Dark());
    for (int spots = random->Integer(0, 1); spots >= 0; --spots) {
      const double radius = random->Uniform(0.06, 0.2);
      const double x = random->Uniform(0.15, 0.85 - 2 * radius);
      const double y = random->Uniform(0.15, 0.85 - 2 * radius);
      const double length = random->Chance(0.4) ? random->Uniform(0, 0.85 - 2 * radius - x) : 0;
      drawing.RoundBox(x, y, x + length + 2 * radius, y + 2 * radius, radius, drawing.Light());
    }
  });
  return drawing.Taken();
}

// Tyres with spokes, in a dark housing or not.
inline cv::Mat Wheels(Random* random) {
  TaglessDrawing drawing(random);
  drawing.Place(random->Integer(2, 5), 40, 140, [&] {
    const double dark = drawing.Dark(), light = drawing.Light();
    if (random->Chance(0.5)) {
      drawing.Box(0, 0, 1, 1, dark);
    } else {
      drawing.RoundBox(0, 0, 1, 1, 0.5, dark);
    }
    drawing.RoundBox(0.2, 0.2, 0.8, 0.8, 0.3, light);
    const int spokes = random->Integer(2, 6);
    for (int i = 0; i < spokes; ++i) {
      const double angle = M_PI * i / spokes, half = random->Uniform(0.03, 0.1);
      const cv::Point2d along(0.3 * std::cos(angle), 0.3 * std::sin(angle));
      const cv::Point2d across(-half * std::sin(angle), half * std::cos(angle));
      const cv::Point2d middle(0.5, 0.5);
      drawing.Fill({middle + along + across, middle + along - across, middle - along - across,
                    middle - along + across},
                   dark);
    }
    drawing.RoundBox(0.42, 0.42, 0.58, 0.58, 0.08, light);
  });
  return drawing.Taken();
}

// Dark squares with strokes, triangles and blocks.
inline cv::Mat Logos(Random* random) {
  TaglessDrawing drawing(random);
  drawing.Place(random->Integer(2, 6), 25, 120, [&] {
    drawing.Box(0, 0, 1, 1, drawing.Dark());
    const double light = drawing.Light();
    for (int parts = random->Integer(1, 4); parts > 0; --parts) {
      const double x = random->Uniform(0.12, 0.7), y = random->Uniform(0.12, 0.7);
      const double right = random->Uniform(x + 0.1, 0.88), bottom = random->Uniform(y + 0.1, 0.88);
      if (random->Chance(0.6)) {
        drawing.Box(x, y, right, bottom, light);
      } else {
        drawing.Fill({{x, y}, {right, y}, {right, bottom}}, light);
      }
    }
  });
  return drawing.Taken();
}

// Rough ground, with scratches.
inline cv::Mat ScratchedGround(Random* random) {
  TaglessDrawing drawing(random);
  cv::Mat& image = drawing.image();
  const double grain = random->Uniform(2, 9);
  const double spread = random->Uniform(15, 45);
  cv::Mat small(image.rows / 2, image.cols / 2, CV_32FC1);
  for (int v = 0; v < small.rows; ++v) {
    for (int u = 0; u < small.cols; ++u) {
      small.at<float>(v, u) = static_cast<float>(random->Normal());
    }
  }
  cv::GaussianBlur(small, small, cv::Size(), grain / 2);
  cv::Mat rough;
  cv::resize(small, rough, image.size());
  image += spread * grain * 1.7 * rough;
  const double angle = random->Uniform(0, M_PI);
  for (int i = random->Integer(30, 300); i > 0; --i) {
    const cv::Point2d from(random->Uniform(0, image.cols), random->Uniform(0, image.rows));
    const double turn = angle + 0.1 * random->Normal(), length = random->Uniform(20, 200);
    cv::line(image, from, from + length * cv::Point2d(std::cos(turn), std::sin(turn)),
             cv::Scalar(random->Chance(0.7) ? drawing.Dark() : drawing.Light()),
             random->Integer(2, 9));
  }
  return drawing.Taken();
}

// Tiles of two colours, some of them missing.
inline cv::Mat Tiles(Random* random) {
  TaglessDrawing drawing(random);
  drawing.Place(random->Integer(1, 3), 60, 200, [&] {
    const double dark = drawing.Dark(), light = drawing.Light();
    const int cells = random->Integer(4, 10);
    const double missing = random->Chance(0.5) ? 0 : random->Uniform(0, 0.2);
    drawing.Box(0, 0, 1, 1, random->Chance(0.5) ? dark : light);
    for (int i = 0; i < cells * cells; ++i) {
      const int x = i % cells, y = i / cells;
      if (random->Chance(missing)) continue;
      drawing.Box(1.0 * x / cells, 1.0 * y / cells, (x + 1.0) / cells, (y + 1.0) / cells,
                  (x + y) % 2 == 0 ? dark : light);
    }
  });
  return drawing.Taken();
}

struct TaglessKind {
  const char* name;
  cv::Mat (*draw)(Random* random);
};

inline constexpr std::array<TaglessKind, 7> kTaglessKinds{{{"windows with lamps", WindowsWithLamps},
                                                           {"letters", Letters},
                                                           {"buttons", Buttons},
                                                           {"wheels", Wheels},
                                                           {"logos", Logos},
                                                           {"scratched ground", ScratchedGround},
                                                           {"tiles", Tiles}}};

}  // namespace kestrel
