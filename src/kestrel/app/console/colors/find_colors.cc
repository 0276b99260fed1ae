// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/find_colors.h"

#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "kestrel/vision/objects/object_model.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// The three channels of a gray camera's images are equal, if it gives three.
bool HasColor(const cv::Mat& bgr) {
  constexpr double kMinDifference = 16;
  std::vector<cv::Mat> channels;
  cv::split(bgr, channels);
  return cv::norm(channels[0], channels[1], cv::NORM_INF) > kMinDifference ||
         cv::norm(channels[0], channels[2], cv::NORM_INF) > kMinDifference;
}

// Returns the given model, or the one that was saved last, or the built-in one.
ObjectModel FirstModel(const std::string& model, const std::string& folder) {
  if (!model.empty()) return ReadObjectModel(model);
  const std::string saved = (fs::path(folder) / "objects.yaml").string();
  return fs::exists(saved) ? ReadObjectModel(saved) : DefaultObjectModel();
}

}  // namespace

std::optional<ColorSource> FindColors(RecordingChoice choice, const std::string& model,
                                      const std::string& folder) {
  choice.format = PixelFormat::kBgr;
  const std::shared_ptr<FrameSource> source = OpenFrames(choice);
  Frame first;
  if (!source->Read(0, &first) || !HasColor(first.image)) return std::nullopt;
  const auto read = [source](std::size_t index) {
    Frame frame;
    source->Read(index, &frame);
    return frame.image;
  };
  std::vector<std::string> names;
  for (const std::string& name : choice.sources) {
    // A folder has the same name with and without a slash at the end.
    names.push_back((fs::absolute(name) / "").lexically_normal().parent_path().string());
  }
  return ColorSource{fmt::format("{}", fmt::join(names, " ")), source->frame_count().value_or(1),
                     read, FirstModel(model, folder), folder};
}

}  // namespace kestrel
