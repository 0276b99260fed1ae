// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/segmentation/segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kestrel {

void SegmentationWorkspace::Start(const cv::Size& size) {
  const bool is_worn_out = stamp_ == std::numeric_limits<std::uint16_t>::max();
  if (size != size_ || is_worn_out) {
    size_ = size;
    stamps_.assign(size.area(), 0);
    queue_.resize(size.area());
    rows_.resize(size.height);
    columns_.resize(size.width);
    stamp_ = 0;
  }
  ++stamp_;
}

SegmentSearch::SegmentSearch(const cv::Mat& image, const ColorGrid& grid,
                             SegmentationWorkspace* workspace)
    : image_(image), grid_(grid), workspace_(workspace) {
  CV_DbgAssert(image.type() == CV_8UC3 && std::max(image.rows, image.cols) <= kMaxImageSide);
  workspace_->Start(image.size());
}

void SegmentSearch::SearchAll(int step) {
  step_ = step;
  v_ = step / 2;
  u_ = 0;
}

bool SegmentSearch::Next(Segment* segment) {
  for (; v_ < image_.rows; v_ += step_) {
    const std::uint8_t* row = image_.ptr(v_);
    const int shift = v_ / step_ % 2 == 0 ? 0 : step_ / 2;
    for (u_ = std::max(u_, shift); u_ < image_.cols; u_ += step_) {
      const ColorLabel label = grid_.At(row + 3 * u_);
      if (label == kBackgroundLabel || label == kAmbiguousLabel) continue;
      if (StampAt(u_, v_) == workspace_->stamp_) continue;
      FloodFill(u_, v_, label, segment);
      return true;
    }
    u_ = 0;
  }
  return false;
}

bool SegmentSearch::IsNewObject(int u, int v, ColorLabel* label) const {
  if (u < 0 || v < 0 || u >= image_.cols || v >= image_.rows) return false;
  *label = LabelAt(u, v);
  return *label != kBackgroundLabel && *label != kAmbiguousLabel &&
         StampAt(u, v) != workspace_->stamp_;
}

bool SegmentSearch::FindNear(int u, int v, int radius_px, std::optional<ColorLabel> label,
                             Segment* segment) {
  constexpr int kStep = 2;  // objects are wider
  ColorLabel found = kBackgroundLabel;
  const auto try_pixel = [&](int x, int y) {
    if (!IsNewObject(x, y, &found) || (label && found != *label)) return false;
    FloodFill(x, y, found, segment);
    return true;
  };
  if (try_pixel(u, v)) return true;
  for (int r = kStep; r <= radius_px; r += kStep) {
    for (int i = -r; i <= r; i += kStep) {
      if (try_pixel(u + i, v - r) || try_pixel(u + i, v + r) || try_pixel(u - r, v + i) ||
          try_pixel(u + r, v + i)) {
        return true;
      }
    }
  }
  return false;
}

void SegmentSearch::Push(int u, int v, ColorLabel label, int* end) {
  std::uint16_t& stamp = StampAt(u, v);
  if (stamp == workspace_->stamp_ || LabelAt(u, v) != label) return;
  stamp = workspace_->stamp_;
  workspace_->queue_[(*end)++] = {static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)};
}

// Algorithm 3: a queue with two pointers. The pixels between them still need a visit; at the end
// the whole queue is the segment.
void SegmentSearch::FloodFill(int u, int v, ColorLabel label, Segment* segment) {
  *segment = Segment();
  segment->label = label;
  segment->min_u = segment->max_u = u;
  segment->min_v = segment->max_v = v;
  const int last_u = image_.cols - 1;
  const int last_v = image_.rows - 1;
  int end = 0;
  Push(u, v, label, &end);
  for (int start = 0; start < end; ++start) {
    const PixelPosition at = workspace_->queue_[start];
    segment->min_u = std::min<int>(segment->min_u, at.u);
    segment->max_u = std::max<int>(segment->max_u, at.u);
    segment->min_v = std::min<int>(segment->min_v, at.v);
    segment->max_v = std::max<int>(segment->max_v, at.v);
    if (at.u > 0) Push(at.u - 1, at.v, label, &end);
    if (at.u < last_u) Push(at.u + 1, at.v, label, &end);
    if (at.v > 0) Push(at.u, at.v - 1, label, &end);
    if (at.v < last_v) Push(at.u, at.v + 1, label, &end);
  }
  segment->pixels = {workspace_->queue_.data(), static_cast<std::size_t>(end)};
  segment->touches_border = segment->min_u == 0 || segment->min_v == 0 ||
                            segment->max_u == last_u || segment->max_v == last_v;
}

void SegmentSearch::JoinAmbiguous(Segment* segment) {
  using Extent = SegmentationWorkspace::Extent;
  constexpr Extent kEmpty{std::numeric_limits<int>::max(), -1};
  auto& rows = workspace_->rows_;
  auto& columns = workspace_->columns_;
  std::fill_n(rows.begin() + segment->min_v, segment->height(), kEmpty);
  std::fill_n(columns.begin() + segment->min_u, segment->width(), kEmpty);
  const auto extend = [](Extent* extent, int x) {
    extent->min = std::min(extent->min, x);
    extent->max = std::max(extent->max, x);
  };
  for (const PixelPosition& at : segment->pixels) {
    extend(&rows[at.v], at.u);
    extend(&columns[at.u], at.v);
  }
  int end = static_cast<int>(segment->pixels.size());
  const int before = end;
  for (int v = segment->min_v; v <= segment->max_v; ++v) {
    for (int u = rows[v].min + 1; u < rows[v].max; ++u) {
      if (v > columns[u].min && v < columns[u].max) Push(u, v, kAmbiguousLabel, &end);
    }
  }
  segment->pixels = {workspace_->queue_.data(), static_cast<std::size_t>(end)};
  segment->ambiguous_pixels = end - before;
}

int SearchStep(int min_pixels) {
  const double shorter_axis_px = std::sqrt(2 * min_pixels / std::numbers::pi);
  return std::max(1, static_cast<int>(shorter_axis_px / 1.3));
}

}  // namespace kestrel
