// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>

#include "kestrel/console/console_hub.h"

namespace kestrel {

// A browser that is connected by the WebSocket. Lives as long as an operation of it is under way.
class SocketSession : public ConsoleClient, public std::enable_shared_from_this<SocketSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  // 'slot': the connection's right to be. 'hub' outlives the session.
  SocketSession(boost::beast::tcp_stream stream, ConsoleHub* hub, std::shared_ptr<void> slot);
  ~SocketSession() override;

  // Answers the request to upgrade, which the guard has let in.
  void Accept(const Request& request);

  void Push(const SharedMessage& message) override { messages_.Push(message); }
  void SendNext() override;
  void PushLinkReport(int clients) override;

 private:
  void Read();
  void Take(std::string_view text, Time now);
  bool IsTooBusy(Time now);
  void Write(const SharedMessage& message, bool is_text);
  void Close();

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  ConsoleHub* hub_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer received_;
  TelemetryChannel messages_;
  ImageFlow images_;
  SharedMessage on_its_way_;
  bool was_image_ = false;
  bool is_open_ = false;
  Time second_began_{};
  int received_in_second_ = 0;
};

}  // namespace kestrel
