// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/console_feed.h"

#include <utility>

namespace kestrel {
namespace {

constexpr std::size_t kMaxUpdates = 1024;
constexpr std::size_t kMaxCommands = 64;
constexpr std::size_t kMaxExports = 8;
constexpr std::size_t kMaxColorJobs = 64;

}  // namespace

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

void ConsoleFeed::Request(const ColorRequest& request) {
  if (description_.has_colors) color_jobs_.Push(request);
}

void ConsoleFeed::SetFrame(ConsoleFrame* frame) {
  frame->sequence = ++sequence_;
  frame_.Set(*frame);
}

}  // namespace kestrel
