#pragma once  // SPDX-License-Identifier: MIT

#include <json-glib/json-glib.h>
#include <libsoup/soup.h>

#include <array>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "examples/live/ref.hpp"

// Clients of ellipse-live.
namespace support {

using live::Ref;
using live::share;

/// Timeout of these clients [s]. An idle machine answers at once, a busy one late.
inline constexpr int kMaxSeconds = 60;

/// Runs the main loop until a condition holds. @return false on timeout.
inline bool wait_until(const std::function<bool()>& is_so, int seconds = kMaxSeconds) {
  const gint64 deadline = g_get_monotonic_time() + seconds * G_USEC_PER_SEC;
  while (!is_so()) {
    if (g_get_monotonic_time() > deadline) return false;
    if (!g_main_context_iteration(nullptr, FALSE)) g_usleep(2000);
  }
  return true;
}

struct Answer {
  guint status = 0;
  std::string body;
  std::map<std::string, std::string> headers;

  /// The body as JSON; a null node if it is not JSON.
  [[nodiscard]] JsonNode* json() const {
    if (!parser_) {
      parser_.reset(json_parser_new());
      json_parser_load_from_data(parser_.get(), body.c_str(), -1, nullptr);
    }
    return json_parser_get_root(parser_.get());
  }
  [[nodiscard]] JsonObject* object() const {
    JsonNode* root = json();
    return root != nullptr && JSON_NODE_HOLDS_OBJECT(root) ? json_node_get_object(root) : nullptr;
  }

 private:
  mutable Ref<JsonParser> parser_;
};

/// A client that sends one request at a time.
class Client {
 public:
  explicit Client(std::string url) : url_(std::move(url)), session_(soup_session_new()) {}

  using Headers = std::map<std::string, std::string>;
  static constexpr guint kTooOften = 429;

  /// Repeats a request that the rate limit rejected, as polling clients do.
  Answer ask(const char* method,
             const std::string& path,
             const std::string& body = "",
             const Headers& headers = {}) const {
    Answer answer = ask_once(method, path, body, headers);
    for (int i = 0; i < 10 * kMaxSeconds && answer.status == kTooOften; ++i) {
      g_usleep(100'000);
      answer = ask_once(method, path, body, headers);
    }
    return answer;
  }
  [[nodiscard]] Answer get(const std::string& path) const { return ask("GET", path); }
  [[nodiscard]] Answer put(const std::string& path, const std::string& body) const {
    return ask("PUT", path, body);
  }
  [[nodiscard]] Answer post(const std::string& path, const std::string& body = "") const {
    return ask("POST", path, body);
  }
  /// NaN without an answer, so that every comparison fails.
  [[nodiscard]] double stat(const char* name) const {
    const Answer answer = get("api/stats");
    return answer.object() != nullptr ? json_object_get_double_member(answer.object(), name)
                                      : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  [[nodiscard]] Answer ask_once(const char* method,
                                const std::string& path,
                                const std::string& body,
                                const Headers& headers) const {
    const Ref<SoupMessage> message(soup_message_new(method, (url_ + path).c_str()));
    soup_message_add_flags(message.get(), SOUP_MESSAGE_NO_REDIRECT);
    for (const auto& [name, value] : headers) {
      soup_message_headers_replace(
          soup_message_get_request_headers(message.get()), name.c_str(), value.c_str());
    }
    if (!body.empty()) {
      const Ref<GBytes> bytes(g_bytes_new(body.data(), body.size()));
      soup_message_set_request_body_from_bytes(message.get(), "application/json", bytes.get());
    }
    const Ref<GBytes> bytes(
        soup_session_send_and_read(session_.get(), message.get(), nullptr, nullptr));
    Answer answer;
    answer.status = soup_message_get_status(message.get());
    if (bytes) {
      gsize size = 0;
      const auto* data = static_cast<const char*>(g_bytes_get_data(bytes.get(), &size));
      if (data != nullptr) answer.body.assign(data, size);
    }
    SoupMessageHeadersIter iter;
    soup_message_headers_iter_init(&iter, soup_message_get_response_headers(message.get()));
    const char* name = nullptr;
    const char* value = nullptr;
    while (soup_message_headers_iter_next(&iter, &name, &value)) answer.headers[name] = value;
    return answer;
  }

  std::string url_;
  Ref<SoupSession> session_;
};

/// A property in the answer of api/properties, or null.
inline JsonObject* property(const Answer& answer, const std::string& name) {
  JsonArray* all = json_node_get_array(answer.json());
  for (guint i = 0; i < json_array_get_length(all); ++i) {
    JsonObject* each = json_array_get_object_element(all, i);
    if (name == json_object_get_string_member(each, "name")) return each;
  }
  return nullptr;
}

inline double value_of(const Client& client, const std::string& name) {
  return json_object_get_double_member(property(client.get("api/properties"), name), "value");
}

/// Reads an endless answer until it contains a part this number of times, or until the timeout.
inline std::string read_stream(const std::string& url, const std::string& part, int times) {
  const Ref<SoupSession> session(soup_session_new_with_options("timeout", kMaxSeconds, nullptr));
  const Ref<SoupMessage> message(soup_message_new("GET", url.c_str()));
  const Ref<GInputStream> stream(soup_session_send(session.get(), message.get(), nullptr, nullptr));
  std::string text;
  std::array<char, 4096> bytes;
  for (int found = 0; stream && found < times;) {
    const gssize size =
        g_input_stream_read(stream.get(), bytes.data(), bytes.size(), nullptr, nullptr);
    if (size <= 0) break;
    text.append(bytes.data(), static_cast<std::size_t>(size));
    found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++found;
    }
  }
  return text;
}

/// A WebSocket that stores the messages it receives.
class SocketClient {
 public:
  /// @param origin  The browser's origin; empty = no browser.
  SocketClient(const std::string& url,
               const std::string& path,
               const std::string& origin = "",
               const std::string& token = "")
      : session_(soup_session_new()) {
    const Ref<SoupMessage> message(soup_message_new("GET", ("ws" + url.substr(4) + path).c_str()));
    if (!token.empty()) {
      soup_message_headers_replace(soup_message_get_request_headers(message.get()),
                                   "Authorization",
                                   ("Bearer " + token).c_str());
    }
    soup_session_websocket_connect_async(session_.get(),
                                         message.get(),
                                         origin.empty() ? nullptr : origin.c_str(),
                                         nullptr,
                                         G_PRIORITY_DEFAULT,
                                         nullptr,
                                         on_connected,
                                         this);
    wait_until([this] { return is_done_; });
  }
  ~SocketClient() {
    if (!connection_) return;
    g_signal_handlers_disconnect_by_data(connection_.get(), this);
    if (is_open()) {
      soup_websocket_connection_close(connection_.get(), SOUP_WEBSOCKET_CLOSE_NORMAL, nullptr);
    }
    wait_until(
        [this] {
          return soup_websocket_connection_get_state(connection_.get()) ==
                 SOUP_WEBSOCKET_STATE_CLOSED;
        },
        5);
  }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  [[nodiscard]] bool is_open() const {
    return connection_ &&
           soup_websocket_connection_get_state(connection_.get()) == SOUP_WEBSOCKET_STATE_OPEN;
  }
  /// The code and text with which it was closed.
  [[nodiscard]] std::string closing() const {
    const char* why = soup_websocket_connection_get_close_data(connection_.get());
    return std::to_string(soup_websocket_connection_get_close_code(connection_.get())) + " " +
           (why != nullptr ? why : "");
  }
  void send(const std::string& text) {
    soup_websocket_connection_send_text(connection_.get(), text.c_str());
  }
  /// Waits for a message and removes it; empty on timeout.
  std::string next(int seconds = kMaxSeconds) {
    if (!wait_until([this] { return !messages_.empty(); }, seconds)) return "";
    std::string message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  [[nodiscard]] std::size_t waiting() const { return messages_.size(); }
  [[nodiscard]] const std::deque<std::string>& messages() const { return messages_; }
  /// From now on acknowledges, counts and discards each picture.
  void watch() { watches_ = true; }
  [[nodiscard]] std::size_t watched() const { return watched_; }

  [[nodiscard]] static guint64 pts_of(const std::string& message) {
    guint64 pts = 0;
    if (message.size() >= sizeof pts) std::memcpy(&pts, message.data(), sizeof pts);
    return GUINT64_FROM_LE(pts);
  }
  void acknowledge(const std::string& message) {
    send("{\"ack\":" + std::to_string(pts_of(message)) + "}");
  }

 private:
  static void on_connected(GObject* session, GAsyncResult* result, gpointer data) {
    auto* self = static_cast<SocketClient*>(data);
    self->is_done_ = true;
    self->connection_.reset(
        soup_session_websocket_connect_finish(SOUP_SESSION(session), result, nullptr));
    if (!self->connection_) return;
    soup_websocket_connection_set_max_incoming_payload_size(self->connection_.get(), 0);
    g_signal_connect(self->connection_.get(), "message", G_CALLBACK(on_message), self);
  }
  static void on_message(SoupWebsocketConnection*, gint, GBytes* bytes, gpointer data) {
    auto* self = static_cast<SocketClient*>(data);
    gsize size = 0;
    const auto* text = static_cast<const char*>(g_bytes_get_data(bytes, &size));
    std::string message(text, size);
    if (self->watches_) {
      ++self->watched_;
      self->acknowledge(message);
      return;
    }
    self->messages_.push_back(std::move(message));
  }

  Ref<SoupSession> session_;
  Ref<SoupWebsocketConnection> connection_;
  std::deque<std::string> messages_;
  std::size_t watched_ = 0;
  bool is_done_ = false;
  bool watches_ = false;
};

/// A line of metadata.
class Line {
 public:
  explicit Line(const std::string& text) : parser_(json_parser_new()) {
    json_parser_load_from_data(parser_.get(), text.c_str(), -1, nullptr);
    JsonNode* root = json_parser_get_root(parser_.get());
    if (root != nullptr && JSON_NODE_HOLDS_OBJECT(root)) object_ = json_node_get_object(root);
  }
  [[nodiscard]] bool is_valid() const { return object_ != nullptr; }
  [[nodiscard]] gint64 number(const char* name) const {
    return object_ != nullptr ? json_object_get_int_member(object_, name) : -1;
  }
  /// The first ellipse with this role, or null.
  [[nodiscard]] JsonObject* ellipse(const std::string& role) const {
    const int index = index_of(role);
    if (index < 0) return nullptr;
    JsonArray* all = json_object_get_array_member(object_, "targets");
    return json_array_get_object_element(all, static_cast<guint>(index));
  }
  /// Index of the first ellipse with this role; -1 if there is none.
  [[nodiscard]] int index_of(const std::string& role) const {
    if (object_ == nullptr) return -1;
    JsonArray* all = json_object_get_array_member(object_, "targets");
    for (guint i = 0; i < json_array_get_length(all); ++i) {
      JsonObject* each = json_array_get_object_element(all, i);
      if (role == json_object_get_string_member(each, "role")) return static_cast<int>(i);
    }
    return -1;
  }

 private:
  Ref<JsonParser> parser_;
  JsonObject* object_ = nullptr;
};

}  // namespace support
