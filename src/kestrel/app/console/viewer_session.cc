// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/viewer_session.h"

#include <utility>

namespace kestrel {
namespace {

// On a slow link a larger buffer would only delay messages.
constexpr int kSendBufferBytes = 256 * 1024;

}  // namespace

ViewerSession::ViewerSession(boost::beast::tcp_stream stream, ConsoleHub* hub, ViewerHub* viewers,
                             std::shared_ptr<void> slot)
    : WebSocket(std::move(stream), hub, std::move(slot)),
      viewers_(viewers),
      flow_(&viewers->channels(), hub->options().message_queue) {}

ViewerSession::~ViewerSession() { Close(); }

void ViewerSession::Opened() {
  LimitSendBuffer(kSendBufferBytes);
  viewers_->Join(this);
}

bool ViewerSession::Take(std::string_view message, bool is_text, Time) {
  const auto request = is_text ? ParseViewerText(message) : ParseViewerBytes(message);
  if (!request) return false;
  flow_.Take(*request);
  viewers_->CountSubscriptions();
  SendNext();
  return true;
}

void ViewerSession::SendNext() {
  if (!is_free()) return;
  if (auto message = flow_.Pop()) {
    Write(std::move(message->head), std::move(message->content), message->is_text);
  }
}

std::optional<std::string> ChooseSubprotocol(std::string_view offered) {
  for (const auto& name : boost::beast::http::token_list({offered.data(), offered.size()})) {
    if (name == "foxglove.sdk.v1" || name == "foxglove.websocket.v1") {
      return std::string(name.data(), name.size());
    }
  }
  return std::nullopt;
}

}  // namespace kestrel
