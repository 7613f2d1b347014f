#include "view/view_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <system_error>
#include <vector>

#include "blum/core/error.hpp"
#include "view/view_page.hpp"

namespace blum::cli {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t longest_request = 16384;  // in bytes; only the head, because bodies are not read
constexpr std::size_t most_connections = 64;
constexpr auto patience = 10s;  // time within which a request must arrive
// Time within which the client must read a part of its answer.
constexpr auto reading_patience = 30s;
// Bytes sent on one connection before the other connections are served.
constexpr std::size_t most_at_a_time = std::size_t{4} << 20U;
constexpr int poll_milliseconds = 200;  // longest delay until Ctrl-C takes effect
constexpr auto rest = 500ms;            // pause if the system has no descriptor left

constexpr std::string_view policy =
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "connect-src 'self'; worker-src blob:; img-src data: blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'\r\n";

[[noreturn]] void fail(const std::string& what) {
  throw Error(what + ": " + std::system_category().message(errno));
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Parts of a request that the server uses.
struct Request {
  std::string method;
  std::string path;  ///< without the query after a question mark
  std::string host;  ///< empty if the header is missing or given more than once
};

Request parse(std::string_view text) {
  Request request;
  const std::string_view first = text.substr(0, text.find("\r\n"));
  const std::size_t after_method = first.find(' ');
  if (after_method == std::string_view::npos) return request;
  const std::size_t after_path = first.find(' ', after_method + 1);
  if (after_path == std::string_view::npos) return request;
  request.method = first.substr(0, after_method);
  const std::string_view target = first.substr(after_method + 1, after_path - after_method - 1);
  request.path = target.substr(0, target.find('?'));
  int hosts = 0;
  for (std::size_t at = first.size() + 2; at < text.size();) {
    const std::size_t end = std::min(text.find("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos && lower(line.substr(0, colon)) == "host") {
      request.host = lower(trimmed(line.substr(colon + 1)));
      ++hosts;
    }
    at = end + 2;
  }
  if (hosts != 1) request.host.clear();
  return request;
}

std::string head(std::string_view status, std::string_view type, std::size_t length) {
  return "HTTP/1.1 " + std::string(status) + "\r\nContent-Type: " + std::string(type) +
         "\r\nContent-Length: " + std::to_string(length) +
         "\r\nConnection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
         "Cross-Origin-Resource-Policy: same-origin\r\nReferrer-Policy: no-referrer\r\n" +
         std::string(policy) + "\r\n";
}

/// Connection: first receives a request, then sends the answer. The socket never blocks.
struct Connection {
  int socket;
  Clock::time_point until;  ///< if nothing is transferred until then, the connection is closed
  std::string received = {};
  std::string head = {};                      ///< head of the answer
  std::vector<std::string_view> answer = {};  ///< parts of the answer after the head
  /// Number of bytes sent of the current part (the head, or a part of the answer).
  std::size_t sent = 0;
  std::size_t parts_sent = 0;  ///< number of parts of the answer that were sent completely

  [[nodiscard]] bool is_answered() const { return !head.empty() || parts_sent < answer.size(); }
};

class Session {
 public:
  Session(const Scene& scene, std::uint16_t port)
      : port_(std::to_string(port)),
        page_(titled_page(scene)),
        scene_head_(SceneBlob::head(scene.header)),
        scene_{scene_head_} {
    for (const std::string_view array : scene.blob.arrays()) scene_.push_back(array);
    for (const std::string_view part : scene_) scene_size_ += part.size();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() = default;

  /// Receives or sends as much as possible without waiting. Returns true if the connection is finished.
  bool advance(Connection& connection) const {
    if (connection.is_answered()) return send_some(connection);
    std::string part(4096, '\0');
    const ssize_t count = recv(connection.socket, part.data(), part.size(), 0);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return false;
    if (count <= 0) return true;
    connection.received.append(part, 0, static_cast<std::size_t>(count));
    const std::size_t end = connection.received.find("\r\n\r\n");
    if (end != std::string::npos) {
      answer(connection, parse(std::string_view(connection.received).substr(0, end)));
    } else if (connection.received.size() > longest_request) {
      refuse(connection, "431 Request Header Fields Too Large");
    } else {
      return false;
    }
    connection.until = Clock::now() + reading_patience;
    return send_some(connection);
  }

 private:
  static void refuse(Connection& connection, std::string_view status) {
    const std::string text = std::string(status) + "\n";
    connection.head = head(status, "text/plain; charset=utf-8", text.size()) + text;
  }

  void answer(Connection& connection, const Request& request) const {
    if (request.host != "127.0.0.1:" + port_ && request.host != "localhost:" + port_) {
      return refuse(connection, "403 Forbidden");
    }
    const bool is_head = request.method == "HEAD";
    if (request.method != "GET" && !is_head) return refuse(connection, "405 Method Not Allowed");
    if (request.path == "/") {
      connection.answer = {page_};
      connection.head = head("200 OK", "text/html; charset=utf-8", page_.size());
    } else if (request.path == "/scene.bin") {
      connection.answer = scene_;
      connection.head = head("200 OK", "application/octet-stream", scene_size_);
    } else {
      return refuse(connection, "404 Not Found");
    }
    if (is_head) connection.answer.clear();
  }

  /// Sends a part of the answer. Returns true if everything is sent, or if the client has closed the connection.
  static bool send_some(Connection& connection) {
    for (std::size_t budget = most_at_a_time; connection.is_answered() && budget > 0;) {
      const bool is_head = !connection.head.empty();
      const std::string_view part =
          (is_head ? std::string_view(connection.head) : connection.answer[connection.parts_sent])
              .substr(connection.sent);
      const ssize_t sent =
          part.empty() ? 0 : send(connection.socket, part.data(), std::min(part.size(), budget), MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) return errno != EAGAIN;
      connection.sent += static_cast<std::size_t>(sent);
      budget -= static_cast<std::size_t>(sent);
      connection.until = Clock::now() + reading_patience;
      if (static_cast<std::size_t>(sent) < part.size()) continue;
      connection.sent = 0;
      if (is_head) {
        connection.head.clear();
      } else {
        ++connection.parts_sent;
      }
    }
    return !connection.is_answered();
  }

  std::string port_;
  std::string page_;
  std::string scene_head_;
  std::vector<std::string_view> scene_;
  std::size_t scene_size_ = 0;
};

/// Closes a connection after reading the rest of the request. Otherwise unread bytes would reset the connection before
/// the client has read its answer.
void close_connection(int socket) {
  shutdown(socket, SHUT_WR);
  std::string unread(longest_request, '\0');
  for (int k = 0; k < 16 && recv(socket, unread.data(), unread.size(), MSG_DONTWAIT) > 0; ++k) {
  }
  close(socket);
}

/// Closes one connection, to make room for another. Prefers those that send no request, then those that read no answer.
void make_room(std::vector<Connection>& connections) {
  const auto is_worse = [](const Connection& a, const Connection& b) {
    return a.is_answered() != b.is_answered() ? b.is_answered() : a.until < b.until;
  };
  const auto worst = std::min_element(connections.begin(), connections.end(), is_worse);
  close_connection(worst->socket);
  connections.erase(worst);
}

/// Accepts a connection. Returns false if the system has no descriptor left.
bool accept_into(std::vector<Connection>& connections, int listener) {
  const int socket = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (socket < 0) return errno == EINTR || errno == EAGAIN || errno == ECONNABORTED;
  if (connections.size() >= most_connections) make_room(connections);
  connections.push_back({socket, Clock::now() + patience});
  return true;
}

}  // namespace

ViewServer::ViewServer(std::uint16_t port) : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (listener_ < 0) fail("cannot make a socket");
  const int yes = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 || listen(listener_, 16) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    const int error = errno;
    close(listener_);
    errno = error;
    fail("port " + std::to_string(port) + " of this machine is not available");
  }
  port_ = ntohs(address.sin_port);
}

ViewServer::~ViewServer() {
  close(listener_);
}

std::string ViewServer::url() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/";
}

void ViewServer::serve(const Scene& scene, const std::stop_token& stop) {
  const Session session(scene, port_);
  std::vector<Connection> connections;
  Clock::time_point rests_until = {};
  while (!stop.stop_requested()) {
    const bool accepts = Clock::now() >= rests_until;
    std::vector<pollfd> waiting{{listener_, static_cast<short>(accepts ? POLLIN : 0), 0}};
    for (const Connection& c : connections) {
      waiting.push_back({c.socket, static_cast<short>(c.is_answered() ? POLLOUT : POLLIN), 0});
    }
    if (poll(waiting.data(), waiting.size(), poll_milliseconds) < 0) {
      if (errno != EINTR) fail("cannot wait for requests");
      continue;
    }
    std::vector<Connection> left;
    for (std::size_t i = 0; i < connections.size(); ++i) {
      Connection& connection = connections[i];
      const bool is_done = waiting[i + 1].revents != 0 ? session.advance(connection) : Clock::now() > connection.until;
      if (is_done) {
        close_connection(connection.socket);
      } else {
        left.push_back(std::move(connection));
      }
    }
    connections = std::move(left);
    if ((waiting[0].revents & POLLIN) != 0 && !accept_into(connections, listener_)) rests_until = Clock::now() + rest;
  }
  for (const Connection& c : connections) close_connection(c.socket);
}

}  // namespace blum::cli
