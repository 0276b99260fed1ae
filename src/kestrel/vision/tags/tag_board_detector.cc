// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_board_detector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kestrel/core/base/options.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_quads.h"
#include "kestrel/vision/tags/tag_search.h"

namespace kestrel {
namespace {

// The square of a tag, with points along its sides: a lens bends lines.
std::vector<Eigen::Vector3d> OutlineOf(const PrintedTag& tag) {
  constexpr int kPerSide = 8;
  const double low = tag.grid.margin();
  const double side = tag.grid.border_width;
  std::vector<Eigen::Vector3d> outline;
  for (int k = 0; k < 4 * kPerSide; ++k) {
    const double along = side * (k % kPerSide) / kPerSide;
    const double x[] = {along, side, side - along, 0};
    const double y[] = {0, along, side, side - along};
    const Eigen::Vector2d place = tag.OnBoard(low + x[k / kPerSide], low + y[k / kPerSide]);
    outline.emplace_back(place.x(), place.y(), 0);
  }
  return outline;
}

}  // namespace

TargetShape ShapeOf(const TagBoard& board) {
  constexpr double kSightPx = 20;  // side of a tag that nearly all images show
  TargetShape shape{};
  for (const PrintedTag& tag : board.Printed()) {
    shape.outlines.push_back(OutlineOf(tag));
    const double reach = 0.5 * tag.grid.width * tag.cell_m;
    shape.diameter_m = std::max(shape.diameter_m, 2 * (tag.center.norm() + M_SQRT2 * reach));
    shape.board_size_m =
        std::max(shape.board_size_m, 2 * (tag.center.lpNorm<Eigen::Infinity>() + reach));
    shape.max_pixel_m = std::max(shape.max_pixel_m, 2 * reach / kSightPx);
  }
  for (const BoardTag& tag : board.tags) {
    shape.tags.push_back({tag.family, tag.id, tag.size_m, tag.board_from_tag});
  }
  const auto size = [](const std::vector<Eigen::Vector3d>& outline) {
    return (outline[1] - outline[0]).norm();
  };
  std::stable_sort(shape.outlines.begin(), shape.outlines.end(),
                   [&](const auto& a, const auto& b) { return size(a) > size(b); });
  return shape;
}

struct TagBoardDetector::Impl {
  Impl(const CameraModel& of_image, const TagBoard& tags, const TagBoardDetectorOptions& how)
      : camera(of_image),
        board(Checked(tags)),
        options(Checked(how)),
        finder(camera),
        alignment(camera, board.tags),
        shape(ShapeOf(tags)) {}

  CameraModel camera;
  BoardModel board;
  TagBoardDetectorOptions options;
  TagQuadFinder finder;
  PadAlignment alignment;
  TargetShape shape;
};

TagBoardDetector::TagBoardDetector(const CameraModel& camera, const TagBoard& board,
                                   const TagBoardDetectorOptions& options)
    : impl_(std::make_unique<const Impl>(camera, board, options)) {}
TagBoardDetector::~TagBoardDetector() = default;
TagBoardDetector::TagBoardDetector(TagBoardDetector&&) noexcept = default;
TagBoardDetector& TagBoardDetector::operator=(TagBoardDetector&&) noexcept = default;

TargetReport TagBoardDetector::Detect(const cv::Mat& image, const TargetHint& hint,
                                      TargetWorkspace& workspace) const {
  constexpr double kPartFactor = 1.3, kPartMarginPx = 8;
  const TagSearchModels models{{impl_->camera, impl_->alignment, impl_->board.radius_m,
                                impl_->options.level_sigma_deg, kPartFactor, kPartMarginPx},
                               impl_->board,
                               impl_->finder,
                               impl_->options.min_quality};
  return TagSearch(models, image, hint, &dynamic_cast<TagSearchBuffers&>(workspace)).Run();
}

std::unique_ptr<TargetWorkspace> TagBoardDetector::MakeWorkspace() const {
  auto workspace = std::make_unique<TagSearchBuffers>();
  workspace->pad.samples.Reserve(impl_->board.most_cells);
  impl_->alignment.Reserve(&workspace->pad.alignment);
  return workspace;
}

const CameraModel& TagBoardDetector::camera() const { return impl_->camera; }
const TargetShape& TagBoardDetector::shape() const { return impl_->shape; }

}  // namespace kestrel
