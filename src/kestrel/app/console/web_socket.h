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

// A connection by WebSocket. It reads messages within limits and sends one message at a time. It
// lives as long as one of its operations is pending. Used by the console's thread.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // Answers the request to upgrade that the guard has admitted. 'subprotocol': none when empty.
  void Accept(const Request& request, const std::string& subprotocol = "");

 protected:
  // 'slot': the connection's slot of the hub, held until the end. 'hub' outlives this.
  WebSocket(boost::beast::tcp_stream stream, ConsoleHub* hub, std::shared_ptr<void> slot);
  // A derived class must call Close before its destructor ends.
  virtual ~WebSocket() = default;

  ConsoleHub& hub() { return *hub_; }
  // True when a message can be sent now.
  bool is_free() const { return is_open_ && !is_sending_; }
  // Sends a message of two parts; the second may be null. Call it only when is_free().
  void Write(std::string head, SharedMessage content, bool is_text);
  void Write(SharedMessage content, bool is_text) { Write("", std::move(content), is_text); }
  // Limits the system's send buffer. When it is full, sending waits for the other side to read.
  void LimitSendBuffer(int bytes);
  void Close();

  // Called when the connection is open, and when it is closed.
  virtual void Opened() = 0;
  virtual void Closed() = 0;
  // Handles a message. Returns false when it is not understood; the connection is then closed.
  virtual bool Take(std::string_view message, bool is_text, Time now) = 0;
  // Called when the last message has been sent.
  virtual void SendNext() = 0;

 private:
  void Read();
  bool IsTooBusy(Time now);

  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  ConsoleHub* hub_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer received_;
  std::string head_;  // head of the message on its way
  SharedMessage content_;
  bool is_sending_ = false;
  bool is_open_ = false;
  Time second_began_{};
  int received_in_second_ = 0;
};

}  // namespace kestrel
