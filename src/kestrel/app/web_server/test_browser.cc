// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/test_browser.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <fmt/format.h>

namespace kestrel {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using test_browser::Request;
using test_browser::Response;

constexpr std::chrono::seconds kPatience{60};

tcp::endpoint Loopback(int port) {
  return {boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)};
}

// The text at the beginning of an image's message.
nlohmann::json HeaderOf(const std::string& message) {
  std::size_t size = 0;
  for (int i = 0; i < 4; ++i) {
    size |= static_cast<std::size_t>(static_cast<unsigned char>(message[i])) << 8 * i;
  }
  return nlohmann::json::parse(message.substr(4, size));
}

}  // namespace

struct TestBrowser::Line {
  boost::asio::io_context context;
  beast::tcp_stream stream{context};
};

TestBrowser::TestBrowser(int port) : port_(port), line_(std::make_unique<Line>()) {
  line_->stream.connect(Loopback(port));
}

TestBrowser::~TestBrowser() = default;

Request TestBrowser::Get(const std::string& target) const {
  Request request(http::verb::get, target, 11);
  request.set(http::field::host, fmt::format("127.0.0.1:{}", port_));
  return request;
}

void TestBrowser::SendRequest(const Request& request) {
  beast::error_code error;
  http::write(line_->stream, request, error);
}

Response TestBrowser::Send(const Request& request) {
  SendRequest(request);
  return ReadResponse();
}

Response TestBrowser::SendBytes(const std::string& bytes) {
  beast::error_code error;
  boost::asio::write(line_->stream, boost::asio::buffer(bytes), error);
  line_->stream.socket().shutdown(tcp::socket::shutdown_send, error);
  return ReadResponse();
}

Response TestBrowser::ReadResponse() {
  beast::error_code error;
  beast::flat_buffer buffer;
  Response response;
  http::read(line_->stream, buffer, response, error);
  if (error) {
    response = {};
    response.result(0u);
  }
  return response;
}

struct TestSocket::Line {
  boost::asio::io_context context;
  websocket::stream<beast::tcp_stream> stream{context};
};

TestSocket::TestSocket(int port, const std::string& origin, const std::string& cookie,
                       const std::string& target, const std::string& subprotocol)
    : line_(std::make_unique<Line>()) {
  beast::get_lowest_layer(line_->stream).connect(Loopback(port));
  line_->stream.set_option(websocket::stream_base::decorator([=](websocket::request_type& request) {
    if (!origin.empty()) request.set("Origin", origin);
    if (!cookie.empty()) request.set("Cookie", cookie);
    if (!subprotocol.empty()) request.set("Sec-WebSocket-Protocol", subprotocol);
  }));
  line_->stream.read_message_max(64 << 20);
  beast::error_code error;
  websocket::response_type response;
  line_->stream.handshake(response, fmt::format("127.0.0.1:{}", port), target, error);
  is_open_ = !error;
  subprotocol_ = std::string(response["Sec-WebSocket-Protocol"]);
}

TestSocket::TestSocket(int port) : TestSocket(port, fmt::format("http://127.0.0.1:{}", port)) {}

TestSocket::~TestSocket() = default;

void TestSocket::Send(const std::string& text, bool is_text) {
  beast::error_code error;
  line_->stream.text(is_text);
  line_->stream.write(boost::asio::buffer(text), error);
}

std::optional<std::string> TestSocket::Read() {
  beast::flat_buffer buffer;
  std::optional<beast::error_code> error;
  line_->stream.async_read(buffer, [&](beast::error_code result, std::size_t) { error = result; });
  line_->context.restart();
  line_->context.run_for(kPatience);
  if (!error) {
    Shutdown();
    line_->context.run();
  }
  if (*error) return std::nullopt;
  is_text_ = line_->stream.got_text();
  return beast::buffers_to_string(buffer.data());
}

std::optional<nlohmann::json> TestSocket::Next(const std::string& kind) {
  while (const auto message = Read()) {
    if (!is_text_ && kind == "image") return HeaderOf(*message);
    if (!is_text_) continue;
    nlohmann::json json = nlohmann::json::parse(*message);
    if (json["kind"] == kind) return json;
  }
  return std::nullopt;
}

void TestSocket::Shutdown() {
  beast::error_code error;
  beast::get_lowest_layer(line_->stream).socket().shutdown(tcp::socket::shutdown_both, error);
}

bool TestSocket::IsEnded() {
  while (Read()) {
  }
  return true;
}

}  // namespace kestrel
