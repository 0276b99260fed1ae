// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/color_marks.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/yaml_reader.h"
#include "kestrel/io/recording/media/image_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

cv::Rect ParseRectangle(const YamlReader& reader) {
  constexpr double kMaxSide = 1e6;
  const std::vector<double> numbers = reader.Numbers(4);
  for (const double number : numbers) {
    if (number < 0 || number > kMaxSide || number != std::floor(number)) {
      reader.Fail("expected whole numbers of pixels, [x, y, width, height]");
    }
  }
  const cv::Rect rectangle(static_cast<int>(numbers[0]), static_cast<int>(numbers[1]),
                           static_cast<int>(numbers[2]), static_cast<int>(numbers[3]));
  if (rectangle.empty()) reader.Fail("the rectangle is empty");
  return rectangle;
}

// Returns a mask of the marked pixels, with the image's size.
cv::Mat MaskOf(const ColorMark& mark, const cv::Size& size) {
  if (!mark.mask.empty()) {
    cv::Mat mask = ReadImage(mark.mask, PixelFormat::kGray);
    if (mask.size() != size) {
      throw InputError(fmt::format("{}: the mask has {} x {} px, but {} has {} x {}", mark.mask,
                                   mask.cols, mask.rows, mark.image, size.width, size.height));
    }
    return mask;
  }
  const cv::Rect& r = mark.rectangle;
  if ((r & cv::Rect({}, size)) != r) {
    throw InputError(fmt::format(
        "{}: the rectangle [{}, {}, {}, {}] of {} is not inside of the image, which has {} x {} px",
        mark.image, r.x, r.y, r.width, r.height, mark.color, size.width, size.height));
  }
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  mask(r).setTo(255);
  return mask;
}

}  // namespace

std::vector<ColorMark> ParseColorMarks(const std::string& yaml, const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  std::vector<ColorMark> marks;
  const YamlReader root(yaml, file);
  for (const YamlReader& item : root.Items()) {
    item.RequireKeys({"image", "color", "rectangle", "mask"});
    if (item.Has("rectangle") == item.Has("mask")) item.Fail("expected a rectangle or a mask");
    ColorMark& mark = marks.emplace_back();
    mark.image = (folder / item["image"].Text()).string();
    mark.color = item["color"].Text();
    if (item.Has("mask")) {
      mark.mask = (folder / item["mask"].Text()).string();
    } else {
      mark.rectangle = ParseRectangle(item["rectangle"]);
    }
  }
  if (marks.empty()) root.Fail("no marks");
  return marks;
}

std::map<std::string, std::vector<Hsv>> ReadMarkedColors(const std::vector<ColorMark>& marks) {
  std::map<std::string, std::vector<Hsv>> colors;
  for (const ColorMark& mark : marks) {
    const cv::Mat image = ReadImage(mark.image, PixelFormat::kBgr);
    const cv::Mat mask = MaskOf(mark, image.size());
    std::vector<Hsv>& samples = colors[mark.color];
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        if (mask.at<uchar>(v, u) == 0) continue;
        const auto& bgr = image.at<cv::Vec3b>(v, u);
        samples.push_back(HsvFromBgr(bgr[0], bgr[1], bgr[2]));
      }
    }
  }
  return colors;
}

}  // namespace kestrel
