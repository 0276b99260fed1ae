// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <memory>
#include <string>

#include "kestrel/app/web_server/web_hub.h"

namespace kestrel {

// A connection by WebSocket. It reads messages within limits and sends one message at a time. It
// lives as long as one of its operations is pending. Used by the server's thread.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;
  using Begin = std::function<std::unique_ptr<WebConversation>()>;

  // 'slot': the connection's slot of the hub, held until the end. 'hub' outlives this. 'begin': its
  // conversation, called when the connection is open.
  WebSocket(boost::beast::tcp_stream stream, WebHub* hub, std::shared_ptr<void> slot, Begin begin);
  ~WebSocket() { Close(); }
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // Limits the system's send buffer. When it is full, sending waits for the other side to read.
  void LimitSendBuffer(int bytes);
  // Answers the request to upgrade that the guard has admitted. 'subprotocol': none when empty.
  void Accept(const Request& request, const std::string& subprotocol = "");

  // Sends the next message, unless one is on its way.
  void SendNext();

 private:
  void Open();
  void Read();
  bool IsTooBusy(Time now);
  void Close();

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  WebHub* hub_;
  std::shared_ptr<void> slot_;
  Begin begin_;
  std::unique_ptr<WebConversation> conversation_;  // null unless the connection is open
  boost::beast::flat_buffer received_;
  WebMessage sent_;  // the message on its way
  bool is_sending_ = false;
  Time second_began_{};
  int received_in_second_ = 0;
};

}  // namespace kestrel
