// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include "kestrel/app/console/console_options.h"

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
  explicit TestBrowser(int port);
  ~TestBrowser();

  test_browser::Request Get(const std::string& target) const;

  // Without waiting for the answer.
  void Ask(const test_browser::Request& request);
  // The answer; status 0 when the connection ends without one.
  test_browser::Response Send(const test_browser::Request& request);
  // The same for bytes after which no more come.
  test_browser::Response SendBytes(const std::string& bytes);
  // The next answer, as above.
  test_browser::Response ReadResponse();

 private:
  struct Line;

  int port_;
  std::unique_ptr<Line> line_;
};

// The page's WebSocket.
class TestSocket {
 public:
  // 'origin', 'cookie', 'subprotocol': empty: none.
  TestSocket(int port, const std::string& origin, const std::string& cookie = "",
             const std::string& target = "/live", const std::string& subprotocol = "");
  explicit TestSocket(int port);
  ~TestSocket();

  // Whether the server has let it in.
  bool is_open() const { return is_open_; }
  // That the server has chosen.
  const std::string& subprotocol() const { return subprotocol_; }
  // Whether the last message that was read is text.
  bool is_text() const { return is_text_; }

  void Send(const std::string& text, bool is_text = true);

  // The next message; nothing when the connection has ended, or nothing came for a long time.
  std::optional<std::string> Read();

  // The next message of a kind; images are "image". Nothing when the connection has ended.
  std::optional<nlohmann::json> Next(const std::string& kind);

  // Ends the connection; Read in another thread then returns.
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
