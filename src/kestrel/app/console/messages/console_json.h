// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/app/console/messages/console_feed.h"

namespace kestrel {

// Messages for the page, as defined in web/src/protocol.ts: an object whose "kind" names its type.
// Times are strings of whole nanoseconds, as they exceed the integers that JavaScript's numbers
// hold. An unknown number is null; bytes that are not UTF-8 become replacement characters.

std::string ToJson(const ConsoleFeed::Description& description);
std::string ToJson(const ConsoleUpdate& update);

// Returns the message of a frame without its pixels. 'view': name of the view, empty for the
// camera's image. 'age': time since the exposure, where it is known.
std::string FrameJson(const ConsoleFrame& frame, const std::string& view,
                      std::optional<Duration> age);

// State of one browser's connection.
struct LinkReport {
  std::uint64_t dropped_messages = 0;  // dropped because it did not read them in time
  std::uint64_t images = 0;            // sent
  std::optional<Duration> draw_time;   // from capture until the browser reported the image as drawn
  int clients = 0;                     // number of browsers that look
};
std::string ToJson(const LinkReport& report);

}  // namespace kestrel
