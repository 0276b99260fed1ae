// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/socket_session.h"

#include <string>
#include <utility>

#include "kestrel/app/console/console_json.h"

namespace kestrel {

SocketSession::SocketSession(boost::beast::tcp_stream stream, ConsoleHub* hub,
                             std::shared_ptr<void> slot)
    : WebSocket(std::move(stream), hub, std::move(slot)), messages_(hub->options().message_queue) {}

SocketSession::~SocketSession() { Close(); }

bool SocketSession::Take(std::string_view text, bool is_text, Time now) {
  if (!is_text) return false;
  const std::optional<ClientMessage> message = ParseClientMessage(text);
  if (!message) return false;
  if (const auto* ack = std::get_if<ImageAck>(&*message)) {
    images_.Acknowledged(ack->sequence, now);
    SendNext();
  } else if (const auto* wish = std::get_if<ImageWish>(&*message)) {
    const std::optional<std::size_t> view = hub().images().FindView(wish->view);
    if (!view) return false;
    images_.SetWish(wish->is_wanted, *view, wish->is_held);
  } else if (const auto* request = std::get_if<ColorRequest>(&*message)) {
    hub().Ask(*request);
  } else {
    hub().Command(std::get<ConsoleCommand>(*message));
  }
  return true;
}

void SocketSession::SendNext() {
  if (!is_free()) return;
  // Images and messages alternate, so that neither delays the other on a slow link.
  const auto send_image = [this] {
    const auto image = hub().images().NextFor(images_, Now());
    if (!image) return false;
    images_.Sent(*image);
    was_image_ = true;
    Write(image->message, /*is_text=*/false);
    return true;
  };
  if (!was_image_ && send_image()) return;
  if (SharedMessage message = messages_.Pop()) {
    was_image_ = false;
    return Write(std::move(message), /*is_text=*/true);
  }
  send_image();
}

void SocketSession::PushLinkReport(int clients) {
  Push(std::make_shared<const std::string>(
      ToJson({messages_.dropped(), images_.count(), images_.draw_time(), clients})));
}

}  // namespace kestrel
