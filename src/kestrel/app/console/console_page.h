// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/web_assets.h"
#include "kestrel/app/web_server/web_server.h"

namespace kestrel {

// Starts a server of the console's page, which shows what comes through 'feed'. 'feed', 'assets'
// and 'channels' outlive it. 'channels': messages that viewers can subscribe to; null: none. Throws
// InputError as WebServer does.
WebServer ServeConsole(const ConsoleOptions& options, ConsoleFeed* feed,
                       std::span<const WebAsset> assets = WebAssets(),
                       ChannelFeed* channels = nullptr);

}  // namespace kestrel
