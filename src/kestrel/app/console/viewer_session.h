// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/app/console/viewer_hub.h"
#include "kestrel/app/console/web_socket.h"

namespace kestrel {

// The connection of a viewer that speaks Foxglove's WebSocket protocol.
class ViewerSession final : public ViewerClient, public WebSocket {
 public:
  // 'viewers' outlive the session.
  ViewerSession(boost::beast::tcp_stream stream, ConsoleHub* hub, ViewerHub* viewers,
                std::shared_ptr<void> slot);
  ~ViewerSession() override;

  ViewerFlow& flow() override { return flow_; }
  void SendNext() override;

 private:
  void Opened() override;
  void Closed() override { viewers_->Leave(this); }
  bool Take(std::string_view message, bool is_text, Time now) override;

  ViewerHub* viewers_;
  ViewerFlow flow_;
};

// Returns the first supported subprotocol of the viewer's comma-separated offer; nothing when there
// is none.
std::optional<std::string> ChooseSubprotocol(std::string_view offered);

}  // namespace kestrel
