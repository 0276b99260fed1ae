// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "kestrel/app/web_server/console_options.h"
#include "kestrel/core/base/test_eventually.h"

namespace kestrel {

namespace test_browser {
namespace http = boost::beast::http;
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

// Sends requests to a server on this computer, as a browser or as any other program.
class TestBrowser {
 public:
  explicit TestBrowser(int port);
  ~TestBrowser();

  test_browser::Request Get(const std::string& target) const;

  // Sends a request without waiting for the answer.
  void SendRequest(const test_browser::Request& request);
  // Sends a request and returns the answer; status 0 when the connection ends without one.
  test_browser::Response Send(const test_browser::Request& request);
  // Sends bytes, ends the sending side, and returns the answer as Send does.
  test_browser::Response SendBytes(const std::string& bytes);
  // Returns the next answer, as Send does.
  test_browser::Response ReadResponse();

 private:
  struct Line;

  int port_;
  std::unique_ptr<Line> line_;
};

// The page's WebSocket, from the browser's side.
class TestSocket {
 public:
  // 'origin', 'cookie', 'subprotocol': none when empty.
  TestSocket(int port, const std::string& origin, const std::string& cookie = "",
             const std::string& target = "/live", const std::string& subprotocol = "");
  explicit TestSocket(int port);
  ~TestSocket();

  // True when the server has accepted it.
  bool is_open() const { return is_open_; }
  // The subprotocol that the server has chosen.
  const std::string& subprotocol() const { return subprotocol_; }
  // True when the last message that was read is text.
  bool is_text() const { return is_text_; }

  void Send(const std::string& text, bool is_text = true);

  // Returns the next message; nothing when the connection has ended or no message comes for long.
  std::optional<std::string> Read();

  // Returns the next message of a kind; images are "image". Nothing when the connection has ended.
  std::optional<nlohmann::json> Next(const std::string& kind);

  // The same, and throws when the connection has ended.
  nlohmann::json Await(const std::string& kind) {
    const std::optional<nlohmann::json> message = Next(kind);
    if (!message) throw std::runtime_error("no message of kind " + kind);
    return *message;
  }

  // Ends the connection; a Read in another thread then returns.
  void Shutdown();

  // Reads until the connection ends.
  bool IsEnded();

 private:
  struct Line;

  std::unique_ptr<Line> line_;
  bool is_open_ = false;
  std::string subprotocol_;
  bool is_text_ = false;
};

}  // namespace kestrel
