// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/console_feed.h"

#include <utility>

namespace kestrel {
namespace {

constexpr std::size_t kMaxUpdates = 1024;
constexpr std::size_t kMaxCommands = 64;
constexpr std::size_t kMaxExports = 8;
constexpr std::size_t kMaxColorJobs = 64;

}  // namespace

const char* ToString(OverlayLayer layer) {
  switch (layer) {
    case OverlayLayer::kDetection:
      return "detection";
    case OverlayLayer::kPrediction:
      return "prediction";
    case OverlayLayer::kRejected:
      return "rejected";
    case OverlayLayer::kTruth:
      return "truth";
    case OverlayLayer::kSecond:
      return "second";
  }
  return "";
}

const char* ToString(ConsoleSource source) {
  static constexpr const char* kNames[] = {"frames", "autopilot", "pose"};
  return kNames[static_cast<int>(source)];
}

ConsoleFeed::ConsoleFeed(Description description)
    : description_(std::move(description)),
      updates_(kMaxUpdates),
      commands_(kMaxCommands),
      exports_(kMaxExports),
      color_jobs_(kMaxColorJobs) {}

void ConsoleFeed::Export(PendingExport pending) {
  if (description_.has_colors && IsOfColors(pending.request)) {
    color_jobs_.Push(std::move(pending));
  } else {
    exports_.Push(std::move(pending));
  }
}

void ConsoleFeed::Ask(const ColorRequest& request) {
  if (description_.has_colors) color_jobs_.Push(request);
}

void ConsoleFeed::SetFrame(ConsoleFrame* frame) {
  frame->sequence = ++sequence_;
  frame_.Set(*frame);
}

}  // namespace kestrel
