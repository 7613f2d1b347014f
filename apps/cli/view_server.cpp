#include "view_server.hpp"

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
#include "view_page.hpp"

namespace blum::cli {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t longest_request = 16384;  // bytes, without a body: none is read
constexpr std::size_t most_connections = 64;
constexpr auto patience = 10s;          // for a request to come in
constexpr int poll_milliseconds = 200;  // how long Ctrl-C waits at most

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

/// The part of a request that is looked at.
struct Request {
  std::string method;
  std::string path;  ///< without what follows a question mark
  std::string host;  ///< empty where there is none, or more than one
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

/// Sends all of it; false where the other side has gone.
bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::string head(std::string_view status, std::string_view type, std::size_t length) {
  return "HTTP/1.1 " + std::string(status) + "\r\nContent-Type: " + std::string(type) +
         "\r\nContent-Length: " + std::to_string(length) +
         "\r\nConnection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
         "Cross-Origin-Resource-Policy: same-origin\r\nReferrer-Policy: no-referrer\r\n" +
         std::string(policy) + "\r\n";
}

void refuse(int socket, std::string_view status) {
  const std::string text = std::string(status) + "\n";
  send_all(socket, head(status, "text/plain; charset=utf-8", text.size()) + text);
}

/// One request that comes in.
struct Connection {
  int socket;
  Clock::time_point until;
  std::string received = {};
};

class Session {
 public:
  Session(const Scene& scene, std::uint16_t port) : scene_(scene), port_(std::to_string(port)) {}

  /// Reads what there is; true where the connection is done with.
  bool advance(Connection& connection) const {
    std::string part(4096, '\0');
    const ssize_t count = recv(connection.socket, part.data(), part.size(), 0);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return false;
    if (count <= 0) return true;
    connection.received.append(part, 0, static_cast<std::size_t>(count));
    const std::size_t end = connection.received.find("\r\n\r\n");
    if (end != std::string::npos) {
      answer(connection.socket, parse(std::string_view(connection.received).substr(0, end)));
      return true;
    }
    if (connection.received.size() <= longest_request) return false;
    refuse(connection.socket, "431 Request Header Fields Too Large");
    return true;
  }

 private:
  void answer(int socket, const Request& request) const {
    if (request.host != "127.0.0.1:" + port_ && request.host != "localhost:" + port_) {
      return refuse(socket, "403 Forbidden");
    }
    const bool is_head = request.method == "HEAD";
    if (request.method != "GET" && !is_head) return refuse(socket, "405 Method Not Allowed");
    if (request.path == "/") {
      const std::string_view page = viewer_page();
      if (send_all(socket, head("200 OK", "text/html; charset=utf-8", page.size())) && !is_head) send_all(socket, page);
    } else if (request.path == "/scene.bin") {
      bool is_there =
          send_all(socket, head("200 OK", "application/octet-stream", scene_.blob.size(scene_.header))) && !is_head;
      scene_.blob.finish(scene_.header,
                         [&](std::string_view bytes) { is_there = is_there && send_all(socket, bytes); });
    } else {
      refuse(socket, "404 Not Found");
    }
  }

  const Scene& scene_;
  std::string port_;
};

/// Lets the other side read what it got before the connection goes.
void close_connection(int socket) {
  shutdown(socket, SHUT_WR);
  close(socket);
}

void accept_into(std::vector<Connection>& connections, int listener) {
  const int socket = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
  if (socket < 0) return;
  const timeval longest_send{30, 0};
  setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &longest_send, sizeof longest_send);
  if (connections.size() >= most_connections) {
    close(socket);
  } else {
    connections.push_back({socket, Clock::now() + patience});
  }
}

}  // namespace

ViewServer::ViewServer(std::uint16_t port) : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (listener_ < 0) fail("no socket can be made");
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
    fail("port " + std::to_string(port) + " of this machine cannot be had");
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
  while (!stop.stop_requested()) {
    std::vector<pollfd> waiting{{listener_, POLLIN, 0}};
    for (const Connection& c : connections) waiting.push_back({c.socket, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), poll_milliseconds) < 0 && errno != EINTR) fail("waiting for requests");
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
    if ((waiting[0].revents & POLLIN) != 0) accept_into(connections, listener_);
  }
  for (const Connection& c : connections) close_connection(c.socket);
}

}  // namespace blum::cli
