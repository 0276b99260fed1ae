// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kestrel {

// Requests of a viewer by Foxglove's WebSocket protocol
// (github.com/foxglove/ws-protocol/blob/main/docs/spec.md).

// {"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 3}]}: the viewer chooses the id that
// comes with the channel's messages.
struct ViewerSubscription {
  std::uint32_t id = 0;
  std::uint32_t channel = 0;
};
struct SubscribeRequest {
  std::vector<ViewerSubscription> subscriptions;
};

// {"op": "unsubscribe", "subscriptionIds": [0]}
struct UnsubscribeRequest {
  std::vector<std::uint32_t> ids;
};

// Any other request of the protocol: to publish, to set parameters, to call services.
struct OtherRequest {
  std::string what;  // at most 64 letters
};

using ViewerRequest = std::variant<SubscribeRequest, UnsubscribeRequest, OtherRequest>;

// Return nothing for a message that is not of the protocol. They do not throw.
std::optional<ViewerRequest> ParseViewerText(std::string_view text);
std::optional<ViewerRequest> ParseViewerBytes(std::string_view bytes);

}  // namespace kestrel
