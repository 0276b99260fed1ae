// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/console/console_hub.h"
#include "kestrel/app/console/web_socket.h"

namespace kestrel {

// The WebSocket of a browser that shows the page.
class SocketSession final : public ConsoleClient, public WebSocket {
 public:
  SocketSession(boost::beast::tcp_stream stream, ConsoleHub* hub, std::shared_ptr<void> slot);
  ~SocketSession() override;

  void Push(const SharedMessage& message) override { messages_.Push(message); }
  void SendNext() override;
  void PushLinkReport(int clients) override;

 private:
  void Opened() override { hub().Join(this); }
  void Closed() override { hub().Leave(this); }
  bool Take(std::string_view text, bool is_text, Time now) override;

  TelemetryChannel messages_;
  ImageFlow images_;
  bool was_image_ = false;
};

}  // namespace kestrel
