// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/detect_tags.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/search/edge_place.h"
#include "kestrel/vision/tags/tag_reader.h"

namespace kestrel {
namespace {

using TagCorners = std::array<Eigen::Vector2d, 4>;

cv::Mat GrayOf(const cv::Mat& image) {
  if (image.empty()) throw InputError("the image is empty, expected pixels: was it read?");
  if (image.type() == CV_8UC1) return image;
  if (image.type() != CV_8UC3) {
    throw InputError(fmt::format("the image is {}, expected CV_8UC1 (gray) or CV_8UC3 (BGR)",
                                 cv::typeToString(image.type())));
  }
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

// A camera without distortion: the sides of a tag are straight for it whatever its focal length is.
CameraModel PlainCamera(const cv::Mat& image) {
  const double focal_px = std::max(image.cols, image.rows);
  CameraIntrinsics plain;
  plain.width_px = image.cols;
  plain.height_px = image.rows;
  plain.fx_px = plain.fy_px = focal_px;
  plain.cx_px = 0.5 * (image.cols - 1);
  plain.cy_px = 0.5 * (image.rows - 1);
  return CameraModel(plain);
}

// Returns all quads in the gray values and in their logarithms, as TagSearch steps through them.
std::vector<TagQuad> FindQuads(const cv::Mat& image, const CameraModel& camera) {
  const TagQuadFinder finder(camera);
  const cv::Rect whole(0, 0, image.cols, image.rows);
  TagQuadBuffers buffers;
  finder.Begin(image, whole, &buffers);
  for (int pass = 0; pass < PlaneBorders::kPasses; ++pass) finder.Find(whole, pass, &buffers);
  finder.BeginLinear(image, whole, &buffers);
  for (int pass = 0; pass < PlaneBorders::kPasses; ++pass) finder.Find(whole, pass, &buffers);
  return std::move(buffers.quads);
}

// Returns the distance along 'to_white' at which the image has the edge at a place; NaN without
// one up to 'reach' on either side, px.
double EdgeAt(const cv::Mat& image, const Eigen::Vector2d& place, const Eigen::Vector2d& to_white,
              double reach) {
  std::array<float, kEdgeProfile> gray;
  for (int i = 0; i < kEdgeProfile; ++i) {
    const Eigen::Vector2d at = place + reach * (2.0 * i / (kEdgeProfile - 1) - 1) * to_white;
    gray[i] = SampleGray(image, static_cast<float>(at.x()), static_cast<float>(at.y()));
  }
  return EdgePlace(gray, reach);
}

// Returns the line (homogeneous) through the edge in the image near the way from one corner to the
// next: the least squares of its distances; that way itself where too little of the edge is seen.
Eigen::Vector3d SideOf(const cv::Mat& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       bool dark_inside, double reach) {
  constexpr int kPoints = 24, kFewest = 12;
  constexpr double kTrim = 0.1;  // share of the side, at either end: corners are round
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d outward(along.y(), -along.x());
  const Eigen::Vector2d to_white = dark_inside ? outward : Eigen::Vector2d(-outward);
  Eigen::Matrix2d equations = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right_side = Eigen::Vector2d::Zero();
  int count = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double share = kTrim + (1 - 2 * kTrim) * i / (kPoints - 1);
    const double edge = EdgeAt(image, from + share * (to - from), to_white, reach);
    if (std::isnan(edge)) continue;
    const Eigen::Vector2d row(1 - share, share);
    equations += row * row.transpose();
    right_side += edge * row;
    ++count;
  }
  Eigen::Vector2d moved = Eigen::Vector2d::Zero();  // offsets of both ends
  if (count >= kFewest) moved = equations.inverse() * right_side;
  return (from + moved[0] * to_white).homogeneous().cross((to + moved[1] * to_white).homogeneous());
}

// Moves the corners of a quad to where the edges in the image meet.
void Refine(const cv::Mat& image, bool dark_inside, double side_px, TagCorners* corners) {
  constexpr double kLeastReachPx = 1.5;
  constexpr double kReach = 0.05;  // share of a side: half of a cell
  for (const double share : {1.0, 0.5, 0.5}) {
    const double reach = std::max(kLeastReachPx, share * kReach * side_px);
    std::array<Eigen::Vector3d, 4> sides;
    for (int k = 0; k < 4; ++k) {
      sides[k] = SideOf(image, (*corners)[k], (*corners)[(k + 1) % 4], dark_inside, reach);
    }
    for (int k = 0; k < 4; ++k) (*corners)[k] = sides[(k + 3) % 4].cross(sides[k]).hnormalized();
  }
}

// Refines a quad, and returns its corners in the image. Nothing where no camera sees them.
std::optional<TagCorners> RefinedCorners(const cv::Mat& image, const CameraModel& camera,
                                         TagQuad* quad) {
  TagCorners corners;
  for (int k = 0; k < 4; ++k) {
    if (camera.Project(quad->corners[k], &corners[k]) == ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
  }
  Refine(image, quad->dark_inside, quad->side_px, &corners);
  for (int k = 0; k < 4; ++k) {
    if (!corners[k].allFinite() ||
        camera.Unproject(corners[k], &quad->corners[k]) == ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
  }
  return corners;
}

bool AreSame(const TagDetection& a, const TagDetection& b) {
  if (a.id != b.id || a.family != b.family) return false;
  const double side = (a.corners_px[1] - a.corners_px[0]).norm();
  return (a.corners_px[0] - b.corners_px[0]).norm() < 0.5 * side;
}

// Adds a tag, once: several passes find the same one.
void Add(const TagDetection& tag, std::vector<TagDetection>* tags) {
  const auto same = std::find_if(tags->begin(), tags->end(),
                                 [&](const TagDetection& each) { return AreSame(each, tag); });
  if (same == tags->end()) {
    tags->push_back(tag);
  } else if (same->decision_margin < tag.decision_margin) {
    *same = tag;
  }
}

}  // namespace

const std::vector<std::string>& TagFamilies() { return TagFamily::Names(); }

std::vector<TagDetection> DetectTags(const cv::Mat& image,
                                     const std::vector<std::string>& families) {
  std::vector<TagReader> readers;
  PadSamples samples;
  for (const std::string& family : families) {
    readers.emplace_back(family, /*inverted=*/false);
    samples.Reserve(readers.back().cell_count());
  }
  const cv::Mat gray = GrayOf(image);
  constexpr int kLeastSidePx = 8;  // least side of an image; a tag needs more
  if (std::min(gray.cols, gray.rows) < kLeastSidePx) return {};
  const CameraModel camera = PlainCamera(gray);
  std::vector<std::vector<TagDetection>> found(families.size());
  for (TagQuad& quad : FindQuads(gray, camera)) {
    const std::optional<TagCorners> corners = RefinedCorners(gray, camera, &quad);
    if (!corners) continue;
    for (std::size_t i = 0; i < readers.size(); ++i) {
      const auto reading = readers[i].Read(gray, camera, quad, &samples);
      if (!reading) continue;
      TagDetection tag{families[i], reading->id, *corners, reading->decision_margin};
      std::rotate(tag.corners_px.begin(), tag.corners_px.begin() + reading->turn,
                  tag.corners_px.end());
      Add(tag, &found[i]);
    }
  }
  std::vector<TagDetection> tags;
  for (std::vector<TagDetection>& of_family : found) {
    std::stable_sort(of_family.begin(), of_family.end(),
                     [](const TagDetection& a, const TagDetection& b) { return a.id < b.id; });
    std::move(of_family.begin(), of_family.end(), std::back_inserter(tags));
  }
  return tags;
}

}  // namespace kestrel
