// Blum: the viewer's server. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "view/view_scene.hpp"

namespace blum::cli {

/// Serves the viewer's page as `/` and a scene as `/scene.bin`, only on 127.0.0.1. All other paths are answered with an
/// error. Requests with another host name are rejected, so that no web page can reach the server through its own domain
/// name.
class ViewServer {
 public:
  /// @param port  port number; 0 chooses any free port. @throws Error if the port is not available.
  explicit ViewServer(std::uint16_t port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// Returns "http://127.0.0.1:PORT/".
  [[nodiscard]] std::string url() const;
  /// Answers requests until a stop is requested.
  void serve(const Scene& scene, const std::stop_token& stop);

 private:
  int listener_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace blum::cli
