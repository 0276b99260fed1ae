// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <optional>
#include <string>

#include "kestrel/app/web_server/web_hub.h"

namespace kestrel {

// A connection that serves the page's files, or becomes a WebSocket. It lives as long as one of its
// operations is pending.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  // 'slot': the connection's slot of the hub, held until the end. 'hub' outlives the session.
  HttpSession(boost::asio::ip::tcp::socket socket, WebHub* hub, std::shared_ptr<void> slot);

  // Reads the next request.
  void Read();

 private:
  using Body = boost::beast::http::empty_body;
  using Request = boost::beast::http::request<Body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;
  using Status = boost::beast::http::status;

  void Answer(const Request& request);
  void AnswerAdmitted(const Request& request);
  void Upgrade(const Request& request);
  void SendAsset(const Request& request, const WebAsset& asset);
  void SendExport(const Request& request, Duration limit);
  void SendAnswer(const ExportAnswer& answer, bool keep_alive, bool is_head);
  void EndWaitWithBrowser();
  void SignIn(const Request& request);
  // Answers with an error and closes the connection.
  void Refuse(Status status, const std::string& why);
  void Send(Response response, bool is_head);
  struct Download;
  void SendFile(const ExportAnswer& answer, bool keep_alive, bool is_head);
  void SendPiece(const std::shared_ptr<Download>& download);
  // Reads the next request, or closes the connection.
  void GoOn(bool keep_alive);

  boost::beast::tcp_stream stream_;
  WebHub* hub_;
  std::shared_ptr<void> slot_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<Body>> parser_;
  // Keeps the session alive while it waits for an answer, for a limited time.
  boost::asio::steady_timer patience_;
};

}  // namespace kestrel
