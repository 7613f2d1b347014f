// Blum: the viewer's server. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "view/view_scene.hpp"

namespace blum::cli {

/// Serves the viewer's page as `/` and a scene as `/scene.bin`, on 127.0.0.1 and to nobody else: other paths do not
/// exist, and a request that names another host is refused, so that no web page reaches it through a name of its own.
class ViewServer {
 public:
  /// @param port  0 for any that is free.  @throws Error where it cannot be had.
  explicit ViewServer(std::uint16_t port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// "http://127.0.0.1:PORT/".
  [[nodiscard]] std::string url() const;
  /// Answers requests until a stop is asked for.
  void serve(const Scene& scene, const std::stop_token& stop);

 private:
  int listener_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace blum::cli
