// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/channel_feed.h"

namespace kestrel {
namespace {

// Length of the queue; the console's thread empties it every few milliseconds.
constexpr std::size_t kMessages = 256;

}  // namespace

ChannelFeed::ChannelFeed(std::vector<LiveChannel> channels)
    : channels_(std::move(channels)), messages_(kMessages) {}

}  // namespace kestrel
