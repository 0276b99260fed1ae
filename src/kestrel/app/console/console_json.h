// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/console/console_feed.h"

namespace kestrel {

// Messages for the page, as web/src/protocol.ts has them: an object whose "kind" says what it is.
// Times are text, whole nanoseconds: they are beyond what JavaScript's numbers hold. A number that
// is not known is null; text that is not UTF-8 gets replacement characters.

std::string ToJson(const ConsoleFeed::Description& description);
std::string ToJson(const ConsoleUpdate& update);

// Of a frame without its pixels. 'view': the name of what is seen of it, empty: the camera's image.
// 'age': since its light was collected, where that is known.
std::string FrameJson(const ConsoleFrame& frame, const std::string& view,
                      std::optional<Duration> age);

// How one browser's connection is.
struct LinkReport {
  std::uint64_t dropped_messages = 0;  // for want of its reading them
  std::uint64_t images = 0;            // sent
  std::optional<Duration> draw_time;   // from capture until it said that the image is drawn
  int clients = 0;                     // all that look
};
std::string ToJson(const LinkReport& report);

}  // namespace kestrel
