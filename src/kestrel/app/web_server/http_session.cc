// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/http_session.h"

#include <boost/asio/post.hpp>
#include <boost/beast/websocket.hpp>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/web_server/deflate.h"
#include "kestrel/app/web_server/web_socket.h"

namespace kestrel {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr std::uint32_t kMaxHeaderBytes = 8 * 1024;
// Limit for a whole request, so that single bytes do not keep a connection, and for an answer.
constexpr std::chrono::seconds kTimeout(10);
constexpr std::string_view kSocketPath = "/live";
// On a slow link a larger buffer would only delay a viewer's messages.
constexpr int kViewerBufferBytes = 256 * 1024;

constexpr std::string_view kContentPolicy =
    "default-src 'self'; img-src 'self' blob:; base-uri 'none'; form-action 'self'; "
    "frame-ancestors 'none'";

constexpr std::string_view kSignInPage = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Kestrel: sign in</title>
<meta name="viewport" content="width=device-width">
<h1>Kestrel</h1>
<p>This page is for who has its token: open the link that the program printed, or enter the token here.</p>
<form action="/"><label>Token <input name="token" type="password" autofocus></label>
<button>Open</button></form></html>
)";

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

template <class Request>
std::optional<std::string_view> Field(const Request& request, beast::string_view name) {
  const auto field = request.find(name);
  if (field == request.end()) return std::nullopt;
  return View(field->value());
}

template <class Request>
RequestHead HeadOf(const Request& request) {
  return {.target = View(request.target()),
          .host = View(request[http::field::host]),
          .origin = Field(request, "Origin"),
          .fetch_site = Field(request, "Sec-Fetch-Site"),
          .fetch_mode = Field(request, "Sec-Fetch-Mode"),
          .cookies = View(request[http::field::cookie]),
          .is_web_socket = beast::websocket::is_upgrade(request)};
}

// Headers that identify the sender must occur once only: two readers could interpret them
// differently.
template <class Request>
bool IsAmbiguous(const Request& request) {
  return request.count(http::field::host) != 1 || request.count("Origin") > 1 ||
         request.count(http::field::cookie) > 1 || request.count("Sec-Fetch-Site") > 1 ||
         request.count("Sec-Fetch-Mode") > 1;
}

void SetPolicy(http::fields* fields) {
  fields->set("Content-Security-Policy",
              beast::string_view(kContentPolicy.data(), kContentPolicy.size()));
  fields->set("X-Content-Type-Options", "nosniff");
  fields->set("Referrer-Policy", "no-referrer");
  fields->set("Cross-Origin-Opener-Policy", "same-origin");
  fields->set("Cross-Origin-Resource-Policy", "same-origin");
  if (fields->find(http::field::cache_control) == fields->end()) {
    fields->set(http::field::cache_control, "no-store");
  }
}

// Returns the first supported subprotocol of a viewer's comma-separated offer; nothing when there
// is none.
std::optional<std::string> ChooseSubprotocol(std::string_view offered) {
  for (const auto& name : http::token_list({offered.data(), offered.size()})) {
    if (name == "foxglove.sdk.v1" || name == "foxglove.websocket.v1") {
      return std::string(name.data(), name.size());
    }
  }
  return std::nullopt;
}

void SetAttachment(const ExportAnswer& answer, http::fields* fields) {
  fields->set(http::field::content_type, answer.type);
  if (!answer.coding.empty()) fields->set(http::field::content_encoding, answer.coding);
  fields->set(http::field::content_disposition,
              fmt::format("attachment; filename=\"{}\"", answer.name));
}

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, WebHub* hub,
                         std::shared_ptr<void> slot)
    : stream_(std::move(socket)),
      hub_(hub),
      slot_(std::move(slot)),
      patience_(stream_.get_executor()) {}

void HttpSession::Read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(0);
  stream_.expires_after(kTimeout);
  http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](beast::error_code error, std::size_t) {
        if (!error && !self->parser_->is_done()) {
          return self->Refuse(Status::bad_request, "a request has no body here");
        }
        if (!error) return self->Answer(self->parser_->get());
        const bool is_malformed =
            error.category() == http::make_error_code(http::error::bad_method).category() &&
            error != http::error::end_of_stream && error != http::error::partial_message;
        if (is_malformed) self->Refuse(Status::bad_request, error.message());
      });
}

void HttpSession::Answer(const Request& request) {
  if (IsAmbiguous(request)) return Refuse(Status::bad_request, "the sender is not named once");
  switch (hub_->guard().Admit(HeadOf(request))) {
    case Admission::kServed:
      return AnswerAdmitted(request);
    case Admission::kSignedIn:
      return SignIn(request);
    case Admission::kNoToken: {
      hub_->CountRefusal();
      Response response(Status::unauthorized, 11, std::string(kSignInPage));
      response.set(http::field::content_type, "text/html; charset=utf-8");
      return Send(std::move(response), request.method() == http::verb::head);
    }
    case Admission::kWrongHost:
      return Refuse(Status::misdirected_request,
                    "this name is not known here: use the address, or set console.host_names");
    case Admission::kForeignOrigin:
      return Refuse(Status::forbidden, "another site's page has no access");
  }
}

void HttpSession::AnswerAdmitted(const Request& request) {
  if (beast::websocket::is_upgrade(request)) return Upgrade(request);
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return Refuse(Status::method_not_allowed, "only GET and HEAD");
  }
  const std::string_view path = View(request.target());
  // The token is not needed any more, as when the link is opened again.
  if (path.starts_with("/?token=")) return SignIn(request);
  if (const auto limit = hub_->page().TimeToExport(path)) return SendExport(request, *limit);
  const WebAsset* asset = hub_->FindAsset(path == "/" ? "/index.html" : path);
  if (asset == nullptr) return Refuse(Status::not_found, "no such page");
  SendAsset(request, *asset);
}

void HttpSession::Upgrade(const Request& request) {
  const std::string_view target = View(request.target());
  if (target == kSocketPath) {
    return std::make_shared<WebSocket>(std::move(stream_), hub_, std::move(slot_),
                                       [hub = hub_] { return hub->page().Begin(); })
        ->Accept(request);
  }
  ViewerHub* const viewers = hub_->viewer_hub();
  if (viewers == nullptr || target.substr(0, target.find('?')) != kViewerPath) {
    return Refuse(Status::not_found, "no such socket");
  }
  const auto protocol = ChooseSubprotocol(View(request[http::field::sec_websocket_protocol]));
  if (!protocol) {
    return Refuse(Status::bad_request,
                  "expected the subprotocol foxglove.sdk.v1 or foxglove.websocket.v1");
  }
  const auto socket = std::make_shared<WebSocket>(std::move(stream_), hub_, std::move(slot_),
                                                  [viewers] { return viewers->Begin(); });
  socket->LimitSendBuffer(kViewerBufferBytes);
  socket->Accept(request, *protocol);
}

void HttpSession::SendAsset(const Request& request, const WebAsset& asset) {
  const bool takes_gzip =
      View(request[http::field::accept_encoding]).find("gzip") != std::string_view::npos;
  const bool is_unpacked = asset.is_gzipped && !takes_gzip;
  Response response(Status::ok, 11,
                    is_unpacked ? Gunzip(asset.content) : std::string(asset.content));
  response.set(http::field::content_type, beast::string_view(asset.type.data(), asset.type.size()));
  if (asset.is_gzipped && takes_gzip) response.set(http::field::content_encoding, "gzip");
  // File names below /assets/ contain the hash of their content.
  if (asset.path.starts_with("/assets/")) {
    response.set(http::field::cache_control, "private, max-age=31536000, immutable");
  }
  response.keep_alive(request.keep_alive());
  Send(std::move(response), request.method() == http::verb::head);
}

// Another thread makes the answer; until then this connection reads and sends nothing.
void HttpSession::SendExport(const Request& request, Duration limit) {
  // A link on another site may open pages, but must not cause work.
  const auto site = Field(request, "Sec-Fetch-Site");
  if (site && *site != "same-origin" && *site != "none") {
    return Refuse(Status::forbidden, "another site's page has no access");
  }
  stream_.expires_never();
  const bool is_head = request.method() == http::verb::head;
  const bool keep_alive = request.keep_alive();
  patience_.expires_after(limit);
  patience_.async_wait([self = shared_from_this()](beast::error_code error) {
    if (error) return;       // it was answered, or the browser has gone
    self->stream_.cancel();  // ends the wait for the browser's close
    self->Refuse(Status::service_unavailable, "not ready, or too many requests at once");
  });
  EndWaitWithBrowser();
  const std::weak_ptr<HttpSession> weak = weak_from_this();
  const auto answer = [weak, keep_alive, is_head](const ExportAnswer& made) {
    const auto self = weak.lock();
    if (!self) return;
    boost::asio::post(self->stream_.get_executor(), [self, made, keep_alive, is_head] {
      self->SendAnswer(made, keep_alive, is_head);
    });
  };
  hub_->page().Export(View(request.target()), answer, [weak] { return !weak.expired(); });
}

// Notices that the browser has closed the connection; then nothing keeps the session alive.
void HttpSession::EndWaitWithBrowser() {
  stream_.socket().async_wait(boost::asio::ip::tcp::socket::wait_read,
                              [self = shared_from_this()](beast::error_code error) {
                                if (error) return;
                                const bool has_sent_more =
                                    self->stream_.socket().available(error) > 0;
                                if (!has_sent_more) self->patience_.cancel();
                              });
}

void HttpSession::SendAnswer(const ExportAnswer& answer, bool keep_alive, bool is_head) {
  if (patience_.cancel() == 0) return;  // too late
  stream_.cancel();                     // ends the wait for the browser's close
  if (!answer.refusal.empty()) return Refuse(Status::conflict, answer.refusal);
  if (answer.file) return SendFile(answer, keep_alive, is_head);
  if (answer.content.empty()) return Refuse(Status::not_found, "there is none");
  Response response(Status::ok, 11, answer.content);
  SetAttachment(answer, &response);
  response.keep_alive(keep_alive);
  Send(std::move(response), is_head);
}

void HttpSession::SignIn(const Request& request) {
  Response response(Status::see_other, 11);
  response.set(http::field::location, "/");
  if (!hub_->options().token.empty()) {
    response.set(http::field::set_cookie, hub_->guard().CookieHeader());
  }
  response.keep_alive(request.keep_alive());
  Send(std::move(response), request.method() == http::verb::head);
}

void HttpSession::Refuse(Status status, const std::string& why) {
  hub_->CountRefusal();
  Response response(status, 11, why + "\n");
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.keep_alive(false);
  Send(std::move(response), /*is_head=*/false);
}

void HttpSession::Send(Response response, bool is_head) {
  SetPolicy(&response);
  response.prepare_payload();
  if (is_head) response.body().clear();  // the length stays as for GET
  stream_.expires_after(kTimeout);
  const auto shared = std::make_shared<Response>(std::move(response));
  const auto serializer = std::make_shared<http::response_serializer<http::string_body>>(*shared);
  const auto done = [self = shared_from_this(), shared, serializer](beast::error_code error,
                                                                    std::size_t) {
    if (!error) self->GoOn(shared->keep_alive());
  };
  if (is_head) return http::async_write_header(stream_, *serializer, done);
  http::async_write(stream_, *serializer, done);
}

void HttpSession::GoOn(bool keep_alive) {
  if (keep_alive) return Read();
  beast::error_code ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
}

// A file that is being sent. One piece of it is in memory at a time.
struct HttpSession::Download {
  Download(std::shared_ptr<const ExportFile> of, http::response<http::file_body> with)
      : file(std::move(of)), response(std::move(with)), serializer(response) {}

  std::shared_ptr<const ExportFile> file;  // keeps the file until the end
  http::response<http::file_body> response;
  http::response_serializer<http::file_body> serializer;
};

void HttpSession::SendFile(const ExportAnswer& answer, bool keep_alive, bool is_head) {
  http::file_body::value_type body;
  beast::error_code error;
  body.open(answer.file->path.c_str(), beast::file_mode::scan, error);
  if (error) return Refuse(Status::not_found, "the file is gone");
  http::response<http::file_body> response(Status::ok, 11, std::move(body));
  SetAttachment(answer, &response);
  SetPolicy(&response);
  response.keep_alive(keep_alive);
  response.prepare_payload();
  const auto download = std::make_shared<Download>(answer.file, std::move(response));
  if (!is_head) return SendPiece(download);
  stream_.expires_after(kTimeout);
  http::async_write_header(
      stream_, download->serializer,
      [self = shared_from_this(), download](beast::error_code failed, std::size_t) {
        if (!failed) self->GoOn(download->response.keep_alive());
      });
}

// The time limit holds for each piece, as the time of the whole depends on the network.
void HttpSession::SendPiece(const std::shared_ptr<Download>& download) {
  stream_.expires_after(kTimeout);
  http::async_write_some(
      stream_, download->serializer,
      [self = shared_from_this(), download](beast::error_code error, std::size_t) {
        if (error) return;
        if (!download->serializer.is_done()) return self->SendPiece(download);
        self->GoOn(download->response.keep_alive());
      });
}

}  // namespace kestrel
