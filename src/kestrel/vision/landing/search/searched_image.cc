// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/search/searched_image.h"

#include <algorithm>
#include <utility>

namespace kestrel {
namespace {

// Number of borders of a pass that are examined, those of the highest contrast: black on white
// stands out of texture, which may be unlimited.
constexpr std::size_t kMinBorders = 24;
constexpr std::size_t kPixelsPerBorder = 8192;

BorderLimits LimitsOf(const SearchPass& pass) {
  const double scale = 1 << pass.image_level;
  BorderLimits limits;
  limits.min_extent =
      std::max(4, static_cast<int>(SearchPass::kThinnest * pass.min_ring_px / scale));
  limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
  limits.max_extent =
      static_cast<int>(std::min(16000.0, SearchPass::kWidest * pass.max_ring_px / scale));
  limits.narrow = pass.narrow;
  return limits;
}

}  // namespace

void Binarize(const SearchPass& pass, SearchedImageBuffers* buffers) {
  const cv::Mat image = buffers->pyramid.ImageAt(pass.image_level);
  buffers->threshold.Measure(buffers->pyramid, pass.image_level, pass.tile_level);
  const int contrast = std::clamp(buffers->threshold.ContrastQuantile(0.7), 12, 32);
  using Dark = LocalThreshold::Dark;
  if (pass.top_hat) {
    buffers->top_hat.Binarize(image, contrast, &buffers->binary);
  } else {
    buffers->threshold.Binarize(image, contrast, &buffers->binary,
                                pass.black ? Dark::kBlack : Dark::kBelowMean);
  }
  if (pass.not_bright) InvertBits(buffers->binary.bright, &buffers->binary.dark);
}

bool SearchedImageBuffers::Reserve(const cv::Mat& image) {
  if (width_px == image.cols && height_px == image.rows) return false;
  width_px = image.cols;
  height_px = image.rows;
  noise.Reserve(image.size());
  // Runs the parts that depend on the size alone; reserves for those that depend on the content.
  pyramid.Build(image);
  for (std::size_t i = 0; i < kPasses.size(); ++i) {
    const cv::Mat at_level = pyramid.ImageAt(kPasses[i].image_level);
    tracers[i].Reserve(at_level.cols, at_level.rows);
    if (!at_level.empty()) Binarize(kPasses[i], this);
  }
  return true;
}

std::size_t SearchedImageBuffers::most_points() const {
  std::size_t most = 0;
  for (std::size_t i = 0; i < kPasses.size(); ++i) {
    if (kPasses[i].image_level > 0) most = std::max(most, tracers[i].capacity());
  }
  return most;
}

SearchedImage::SearchedImage(const cv::Mat& image, SearchedImageBuffers* buffers, SearchLog* log)
    : image_(image),
      buffers_(*buffers),
      without_noise_(buffers->noise.Filter(image)),
      chosen_(&image),
      log_(*log) {}

void SearchedImage::Choose(const cv::Rect& part, RingSize size) {
  const cv::Mat* const chosen = size == RingSize::kNear ? &without_noise_ : &image_;
  if (part == part_ && chosen == chosen_) return;
  part_ = part;
  chosen_ = chosen;
  prepared_level_ = -1;
  is_traced_.fill(false);
}

void SearchedImage::Prepare(int last_level) {
  if (last_level <= prepared_level_) return;
  const SearchLog::Timer timer = log_.Time(LandingStage::kBinarize);
  buffers_.pyramid.Build(whole()(part_), last_level);
  prepared_level_ = last_level;
}

const BorderTracer& SearchedImage::Borders(std::size_t pass) {
  BorderTracer& tracer = buffers_.tracers[pass];
  if (std::exchange(is_traced_[pass], true)) return tracer;
  const cv::Mat image = At(kPasses[pass].image_level);
  if (image.empty()) {
    tracer.Clear();
    return tracer;
  }
  {
    const SearchLog::Timer timer = log_.Time(LandingStage::kBinarize);
    Binarize(kPasses[pass], &buffers_);
  }
  const SearchLog::Timer timer = log_.Time(LandingStage::kAreas);
  tracer.Trace(buffers_.binary, cv::Rect(0, 0, image.cols, image.rows), LimitsOf(kPasses[pass]));
  tracer.KeepStrongest(image, std::max(kMinBorders, image.total() / kPixelsPerBorder));
  return tracer;
}

}  // namespace kestrel
