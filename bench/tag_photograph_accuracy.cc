// SPDX-License-Identifier: BSD-3-Clause
// Detections of TagBoardDetector in images that others publish, with the truth that they come with,
// beside libapriltag: ViSP's (Debian: visp-images-data) and libapriltag's own photographs, whose
// truth lists what libapriltag finds in them, and no more. Sets that are not there are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "apriltag_peer.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "report_main.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr double kNearPx = 4;  // root mean square of the corners' distances from the truth

struct TrueTag {
  int id = 0;
  TagCorners corners;  // in any order around the tag
};

// An image with the tags of one family that it shows.
struct Photograph {
  std::string set;
  cv::Mat image;
  std::string family;
  CameraIntrinsics camera;  // no image of the sets is of a wide lens
  std::vector<TrueTag> tags;
};

struct Score {
  int images = 0, tags = 0, found = 0, wrong = 0;
  int peer_found = 0, peer_wrong = 0;
  std::vector<double> corner_px, peer_px;
};

CameraIntrinsics PinholeOf(const cv::Mat& image, double focal_px) {
  return {.width_px = image.cols,
          .height_px = image.rows,
          .fx_px = focal_px,
          .fy_px = focal_px,
          .cx_px = 0.5 * image.cols,
          .cy_px = 0.5 * image.rows,
          .distortion = {}};
}

// --- Sets ---

// Returns all numbers of a text, whatever is between them.
std::vector<double> NumbersIn(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return std::string_view("0123456789.-e").find(c) == std::string_view::npos; },
      ' ');
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

// Reads tags from a file in which each has its id and four corners, in nine numbers. Both sets
// count pixels from their borders, Kestrel from their centres.
std::vector<TrueTag> ReadTags(const fs::path& file, const std::string& prefix) {
  std::ifstream stream(file);
  std::string text;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(prefix)) line.erase(0, prefix.size());
    text += line + '\n';
  }
  const std::vector<double> numbers = NumbersIn(text);
  constexpr std::size_t kNumbers = 9;
  std::vector<TrueTag> tags;
  for (std::size_t first = 0; first + kNumbers <= numbers.size(); first += kNumbers) {
    TrueTag& tag = tags.emplace_back();
    tag.id = static_cast<int>(numbers[first]);
    for (std::size_t k = 0; k < tag.corners.size(); ++k) {
      tag.corners[k] = {numbers[first + 1 + 2 * k] - 0.5, numbers[first + 2 + 2 * k] - 0.5};
    }
  }
  return tags;
}

void AddVisp(const fs::path& folder, std::vector<Photograph>* photographs) {
  const std::pair<const char*, const char*> kFamilies[] = {
      {"tag16_05", "tag16h5"},          {"tag21_07", "tagCircle21h7"},
      {"tag25_09", "tag25h9"},          {"tag36_11", "tag36h11"},
      {"tag41_12", "tagStandard41h12"}, {"tag48_12", "tagCustom48h12"},
      {"tag49_12", "tagCircle49h12"},   {"tag52_13", "tagStandard52h13"}};
  const fs::path rendered = folder / "benchmark" / "640x480";
  for (const auto& [name, family] : kFamilies) {
    const fs::path file = rendered / fmt::format("{}_640x480.png", name);
    if (!fs::exists(file)) continue;
    const cv::Mat image = ReadGrayImage(file.string());
    constexpr double kFocalPx = 700;  // by its poses and corners
    photographs->push_back({"ViSP, rendered, 8 families", image, family, PinholeOf(image, kFocalPx),
                            ReadTags(rendered / fmt::format("corners_{}.txt", name), "")});
  }
  const fs::path photograph = folder / "AprilTag.pgm";
  if (!fs::exists(photograph)) return;
  const cv::Mat image = ReadGrayImage(photograph.string());
  constexpr double kFocalPx = 615;
  std::vector<TrueTag> tags = ReadTags(folder / "ground_truth_detection.txt", "36h11_id:_");
  for (TrueTag& tag : tags) {
    for (Eigen::Vector2d& corner : tag.corners) std::swap(corner.x(), corner.y());  // row, column
  }
  photographs->push_back(
      {"ViSP, photograph", image, "tag36h11", PinholeOf(image, kFocalPx), std::move(tags)});
}

void AddAprilTag(const fs::path& folder, std::vector<Photograph>* photographs) {
  if (!fs::is_directory(folder)) return;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".jpg") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const cv::Mat image = ReadGrayImage(file.string());
    photographs->push_back({"libapriltag, photographs", image, "tag36h11",
                            PinholeOf(image, image.cols),
                            ReadTags(fs::path(file).replace_extension(".txt"), "")});
  }
}

// --- What is measured ---

// Root mean square distance of corners, in the order that fits best.
double DistancePx(const TagCorners& a, const TagCorners& b) {
  double least = INFINITY;
  for (std::size_t first = 0; first < 4; ++first) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}}) {
      double squares = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        squares += (a[k] - b[(first + step * k) % 4]).squaredNorm();
      }
      least = std::min(least, std::sqrt(squares / 4));
    }
  }
  return least;
}

// Returns the distance to the nearest tag of that id.
double NearestPx(const Photograph& photograph, int id, const TagCorners& corners) {
  double nearest = INFINITY;
  for (const TrueTag& tag : photograph.tags) {
    if (tag.id == id) nearest = std::min(nearest, DistancePx(tag.corners, corners));
  }
  return nearest;
}

// One tag of a board as the target, in any image of a camera.
class TagFinder {
 public:
  TagFinder(const CameraModel& camera, const std::string& family, int id)
      : camera_(camera), detector_(camera, BoardOfTag(family, id, 2 * kHalf), {}) {}

  std::optional<TagCorners> Find(const cv::Mat& image) const {
    const auto workspace = detector_.MakeWorkspace();
    const TargetReport report = detector_.Detect(image, {}, *workspace);
    if (!report.detection) return std::nullopt;
    constexpr std::array<std::array<double, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    TagCorners corners;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector3d place(kHalf * kCorners[k][0], kHalf * kCorners[k][1], 0);
      camera_.Project(report.detection->camera_from_target * place, &corners[k]);
    }
    return corners;
  }

 private:
  static constexpr double kHalf = 0.1;  // m; without a scale any size serves

  CameraModel camera_;
  TagBoardDetector detector_;
};

// Paints a tag over.
void Hide(const TagCorners& tag, cv::Mat* image) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : tag) box.extend(corner);
  const cv::Rect part =
      cv::Rect(
          cv::Point(static_cast<int>(box.min().x()), static_cast<int>(box.min().y())),
          cv::Point(static_cast<int>(box.max().x()) + 1, static_cast<int>(box.max().y()) + 1)) &
      cv::Rect(cv::Point(), image->size());
  cv::Mat pixels = (*image)(part);
  pixels.setTo(cv::mean(pixels));
}

// A detector says one place, and some photographs show many tags of one id: what is found is
// hidden, until nothing is found.
void ScoreKestrel(const Photograph& photograph, Score* score) {
  const CameraModel camera(photograph.camera);
  std::set<int> ids;
  for (const TrueTag& tag : photograph.tags) ids.insert(tag.id);
  score->tags += static_cast<int>(photograph.tags.size());
  for (const int id : ids) {
    const TagFinder finder(camera, photograph.family, id);
    cv::Mat image = photograph.image.clone();
    constexpr int kMost = 100;
    for (int i = 0; i < kMost; ++i) {
      const auto found = finder.Find(image);
      if (!found) break;
      const double off = NearestPx(photograph, id, *found);
      ++(off < kNearPx ? score->found : score->wrong);
      if (off < kNearPx) score->corner_px.push_back(off);
      Hide(*found, &image);
    }
  }
}

void ScorePeer(const Photograph& photograph, Score* score) {
  const AprilTagPeer peer(photograph.family, 1);
  for (const AprilTagPeer::Tag& tag : peer.Find(photograph.image)) {
    const double off = NearestPx(photograph, tag.id, tag.corners);
    ++(off < kNearPx ? score->peer_found : score->peer_wrong);
    if (off < kNearPx) score->peer_px.push_back(off);
  }
}

std::string MedianOf(std::vector<double> values) {
  return values.empty() ? "-" : fmt::format("{:.2f}", MedianInPlace(values));
}

int Run(const std::string& visp, const std::string& apriltag) {
  std::vector<Photograph> photographs;
  AddVisp(visp, &photographs);
  AddAprilTag(apriltag, &photographs);
  if (photographs.empty()) {
    fmt::print("no photographs: neither {} nor {} is there\n", visp, apriltag);
    return 0;
  }
  std::vector<std::pair<std::string, Score>> scores;
  for (const Photograph& photograph : photographs) {
    if (scores.empty() || scores.back().first != photograph.set) {
      scores.emplace_back(photograph.set, Score{});
    }
    Score& score = scores.back().second;
    ++score.images;
    ScoreKestrel(photograph, &score);
    ScorePeer(photograph, &score);
  }
  fmt::print(
      "| set | images | tags | found | others | corners px | libapriltag: found | others | "
      "corners px |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [set, s] : scores) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", set, s.images, s.tags, s.found,
               s.wrong, MedianOf(s.corner_px), s.peer_found, s.peer_wrong, MedianOf(s.peer_px));
  }
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("What is found of tags in images that others publish, beside libapriltag");
  std::string visp = "/usr/share/visp-images-data/ViSP-images/AprilTag";
  std::string apriltag = "../apriltag/test/data";
  app.add_option("--visp", visp, "ViSP's folder AprilTag of images")->capture_default_str();
  app.add_option("--apriltag", apriltag, "libapriltag's folder of test images")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] { return kestrel::Run(visp, apriltag); });
}
