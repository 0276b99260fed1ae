// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "kestrel/app/web_server/export_answer.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// Content as it is sent, shared by all clients that get it.
using SharedMessage = std::shared_ptr<const std::string>;

// A message on its way to a client: a head for this client only, and content that all share; null
// when there is none.
struct WebMessage {
  std::string head;
  SharedMessage content;
  bool is_text = false;
};

// A conversation with one client over a WebSocket. Used by the server's thread.
class WebConversation {
 public:
  virtual ~WebConversation() = default;

  // Handles a message. Returns false when it is not understood; the connection is then closed.
  virtual bool Take(std::string_view message, bool is_text, Time now) = 0;
  // Returns the message to be sent next; nothing when none waits.
  virtual std::optional<WebMessage> Next(Time now) = 0;
};

// A page with live data. Used by the server's thread.
class LivePage {
 public:
  virtual ~LivePage() = default;

  virtual std::string title() const = 0;

  // Begins a conversation with a browser. It ends before the page.
  virtual std::unique_ptr<WebConversation> Begin() = 0;
  // Gives new messages to the conversations.
  virtual void Tick(Time now) = 0;

  // Returns the time within which the page makes the file of this path; nothing for other paths.
  virtual std::optional<Duration> TimeToExport(std::string_view path) const = 0;
  // Requests such a file. Any thread may call 'answer', once. 'is_wanted' may be called by any
  // thread; true while the browser still waits for the answer.
  virtual void Export(std::string_view path, std::function<void(const ExportAnswer&)> answer,
                      std::function<bool()> is_wanted) = 0;
};

}  // namespace kestrel
