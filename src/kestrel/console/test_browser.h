// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kestrel/console/console_options.h"

namespace kestrel {

namespace test_browser {
namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = boost::asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
}  // namespace test_browser

inline constexpr char kSecret[] = "0123456789abcdef";

inline ConsoleOptions AnyPort(const std::string& token = "") {
  ConsoleOptions options;
  options.port = 0;
  options.token = token;
  return options;
}

// Whether the condition holds before long.
template <class Condition>
bool Eventually(Condition condition) {
  for (int i = 0; i < 1000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// Asks a server on this computer, as a browser or as somebody who is none.
class TestBrowser {
 public:
  explicit TestBrowser(int port) : port_(port), stream_(context_) {
    stream_.connect(
        {boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
  }

  test_browser::Request Get(const std::string& target) const {
    namespace http = test_browser::http;
    test_browser::Request request(http::verb::get, target, 11);
    request.set(http::field::host, fmt::format("127.0.0.1:{}", port_));
    return request;
  }

  // Without waiting for the answer.
  void Ask(const test_browser::Request& request) {
    test_browser::beast::error_code error;
    test_browser::http::write(stream_, request, error);
  }
  // The answer; status 0 when the connection ends without one.
  test_browser::Response Send(const test_browser::Request& request) {
    Ask(request);
    return ReadResponse();
  }
  // The same for bytes after which no more come.
  test_browser::Response SendBytes(const std::string& bytes) {
    test_browser::beast::error_code error;
    boost::asio::write(stream_, boost::asio::buffer(bytes), error);
    stream_.socket().shutdown(test_browser::Tcp::socket::shutdown_send, error);
    return ReadResponse();
  }
  // The next answer, as above.
  test_browser::Response ReadResponse() {
    test_browser::beast::error_code error;
    test_browser::beast::flat_buffer buffer;
    test_browser::Response response;
    test_browser::http::read(stream_, buffer, response, error);
    if (error) {
      response = {};
      response.result(0u);
    }
    return response;
  }

 private:
  int port_;
  boost::asio::io_context context_;
  test_browser::beast::tcp_stream stream_;
};

// The page's WebSocket.
class TestSocket {
 public:
  // 'origin', 'cookie', 'subprotocol': empty: none.
  TestSocket(int port, const std::string& origin, const std::string& cookie = "",
             const std::string& target = "/live", const std::string& subprotocol = "")
      : stream_(context_) {
    namespace beast = test_browser::beast;
    namespace websocket = beast::websocket;
    beast::get_lowest_layer(stream_).connect(
        {boost::asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
    stream_.set_option(websocket::stream_base::decorator([=](websocket::request_type& request) {
      if (!origin.empty()) request.set("Origin", origin);
      if (!cookie.empty()) request.set("Cookie", cookie);
      if (!subprotocol.empty()) request.set("Sec-WebSocket-Protocol", subprotocol);
    }));
    stream_.read_message_max(64 << 20);
    beast::error_code error;
    beast::websocket::response_type response;
    stream_.handshake(response, fmt::format("127.0.0.1:{}", port), target, error);
    is_open_ = !error;
    subprotocol_ = std::string(response["Sec-WebSocket-Protocol"]);
  }
  explicit TestSocket(int port) : TestSocket(port, fmt::format("http://127.0.0.1:{}", port)) {}

  // Whether the server has let it in.
  bool is_open() const { return is_open_; }
  // That the server has chosen.
  const std::string& subprotocol() const { return subprotocol_; }
  // Whether the last message that was read is text.
  bool is_text() const { return is_text_; }

  void Send(const std::string& text, bool is_text = true) {
    test_browser::beast::error_code error;
    stream_.text(is_text);
    stream_.write(boost::asio::buffer(text), error);
  }

  // The next message; nothing when the connection has ended, or nothing came for a long time.
  std::optional<std::string> Read() {
    test_browser::beast::flat_buffer buffer;
    std::optional<test_browser::beast::error_code> error;
    stream_.async_read(
        buffer, [&](test_browser::beast::error_code result, std::size_t) { error = result; });
    context_.restart();
    context_.run_for(kPatience);
    if (!error) {
      Shutdown();
      context_.run();
    }
    if (*error) return std::nullopt;
    is_text_ = stream_.got_text();
    return test_browser::beast::buffers_to_string(buffer.data());
  }

  // The next message of a kind; images are "image". Nothing when the connection has ended.
  std::optional<nlohmann::json> Next(const std::string& kind) {
    while (const auto message = Read()) {
      if (!is_text_ && kind == "image") return Header(*message);
      if (!is_text_) continue;
      nlohmann::json json = nlohmann::json::parse(*message);
      if (json["kind"] == kind) return json;
    }
    return std::nullopt;
  }

  // Ends the connection; Read in another thread then returns.
  void Shutdown() {
    test_browser::beast::error_code error;
    test_browser::beast::get_lowest_layer(stream_).socket().shutdown(
        test_browser::Tcp::socket::shutdown_both, error);
  }

  // Reads until the connection ends.
  bool IsEnded() {
    while (Read()) {
    }
    return true;
  }

 private:
  static nlohmann::json Header(const std::string& message) {
    std::size_t size = 0;
    for (int i = 0; i < 4; ++i) {
      size |= static_cast<std::size_t>(static_cast<unsigned char>(message[i])) << 8 * i;
    }
    return nlohmann::json::parse(message.substr(4, size));
  }

  static constexpr std::chrono::seconds kPatience{60};

  boost::asio::io_context context_;
  test_browser::beast::websocket::stream<test_browser::beast::tcp_stream> stream_;
  bool is_open_ = false;
  std::string subprotocol_;
  bool is_text_ = false;
};

}  // namespace kestrel
