// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/web_server/console_options.h"
#include "kestrel/flight/onboard/video_server.h"

namespace kestrel {

// Returns the server of "rtsp://ADDRESS:PORT/PATH". Who may look is as with the page: everybody on
// this computer; at any other address the page's token is the password, or a new one. Throws
// InputError for any other text.
VideoServerOptions ParseVideoUrl(const std::string& url, const ConsoleOptions& console);

// Returns the addresses of the video with the password, those for other devices last. 'port': at
// which it is served.
std::vector<std::string> VideoUrls(const VideoServerOptions& options, int port);

}  // namespace kestrel
