// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "kestrel/app/console/console_hub.h"

namespace kestrel {

// A connection by WebSocket: reads what comes, within limits, and sends one message at a time.
// Lives as long as an operation of it is under way. By the console's thread.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // Answers the request to upgrade, which the guard has let in. 'subprotocol': empty: none.
  void Accept(const Request& request, const std::string& subprotocol = "");

 protected:
  // 'slot': the connection's right to be. 'hub' outlives this.
  WebSocket(boost::beast::tcp_stream stream, ConsoleHub* hub, std::shared_ptr<void> slot);
  // Who derives from this calls Close before.
  virtual ~WebSocket() = default;

  ConsoleHub& hub() { return *hub_; }
  // Whether a message can be sent now.
  bool is_free() const { return is_open_ && !is_sending_; }
  // Sends a message in two parts, the second of which may be null. Only when it is free.
  void Write(std::string head, SharedMessage content, bool is_text);
  void Write(SharedMessage content, bool is_text) { Write("", std::move(content), is_text); }
  // Beyond it the system takes no more before the other side has taken something.
  void LimitSendBuffer(int bytes);
  void Close();

  // It is open now; it is not any more.
  virtual void Opened() = 0;
  virtual void Closed() = 0;
  // What has come. False: it is not understood, which ends the connection.
  virtual bool Take(std::string_view message, bool is_text, Time now) = 0;
  // The last message is sent.
  virtual void SendNext() = 0;

 private:
  void Read();
  bool IsTooBusy(Time now);

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  ConsoleHub* hub_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer received_;
  std::string head_;  // of what is on its way
  SharedMessage content_;
  bool is_sending_ = false;
  bool is_open_ = false;
  Time second_began_{};
  int received_in_second_ = 0;
};

}  // namespace kestrel
