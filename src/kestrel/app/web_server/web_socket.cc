// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/web_socket.h"

#include <array>
#include <utility>

namespace kestrel {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

// A browser sends acknowledgements and commands, a viewer its subscriptions.
constexpr std::size_t kMaxMessageBytes = 16 * 1024;
constexpr int kMaxMessagesPerSecond = 500;
constexpr std::chrono::seconds kHandshakeTimeout(5);

}  // namespace

WebSocket::WebSocket(beast::tcp_stream stream, WebHub* hub, std::shared_ptr<void> slot, Begin begin)
    : stream_(std::move(stream)), hub_(hub), slot_(std::move(slot)), begin_(std::move(begin)) {}

void WebSocket::LimitSendBuffer(int bytes) {
  beast::error_code ignored;  // then the system's own limit holds
  beast::get_lowest_layer(stream_).socket().set_option(
      boost::asio::socket_base::send_buffer_size(bytes), ignored);
}

void WebSocket::Accept(const Request& request, const std::string& subprotocol) {
  // The WebSocket has timeouts of its own.
  beast::get_lowest_layer(stream_).expires_never();
  const Duration idle = DurationFromSeconds(hub_->options().idle_timeout_s);
  stream_.set_option(websocket::stream_base::timeout{kHandshakeTimeout, idle, true});
  stream_.set_option(
      websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
        if (!subprotocol.empty()) {
          response.set(beast::http::field::sec_websocket_protocol, subprotocol);
        }
      }));
  stream_.read_message_max(kMaxMessageBytes);
  stream_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (!error) self->Open();
  });
}

void WebSocket::Open() {
  hub_->Join(this);
  conversation_ = begin_();
  SendNext();
  Read();
}

// A message that is not understood ends the connection: neither our page nor a viewer sends one.
void WebSocket::Read() {
  stream_.async_read(received_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    const Time now = Now();
    if (!self->conversation_) return;
    if (error || self->IsTooBusy(now)) return self->Close();
    const auto data = self->received_.cdata();
    if (!self->conversation_->Take({static_cast<const char*>(data.data()), data.size()},
                                   self->stream_.got_text(), now)) {
      self->hub_->CountRefusal();
      return self->Close();
    }
    self->received_.clear();
    self->SendNext();
    self->Read();
  });
}

bool WebSocket::IsTooBusy(Time now) {
  if (now - second_began_ >= std::chrono::seconds(1)) {
    second_began_ = now;
    received_in_second_ = 0;
  }
  if (++received_in_second_ <= kMaxMessagesPerSecond) return false;
  hub_->CountRefusal();
  return true;
}

void WebSocket::SendNext() {
  if (!conversation_ || is_sending_) return;
  std::optional<WebMessage> next = conversation_->Next(Now());
  if (!next) return;
  is_sending_ = true;
  sent_ = std::move(*next);
  stream_.text(sent_.is_text);
  const std::array<boost::asio::const_buffer, 2> parts = {
      boost::asio::buffer(sent_.head),
      sent_.content ? boost::asio::buffer(*sent_.content) : boost::asio::const_buffer()};
  stream_.async_write(parts, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->sent_ = {};
    self->is_sending_ = false;
    if (error) return self->Close();
    self->SendNext();
  });
}

void WebSocket::Close() {
  if (!conversation_) return;
  conversation_.reset();
  hub_->Leave(this);
  beast::get_lowest_layer(stream_).close();
}

}  // namespace kestrel
