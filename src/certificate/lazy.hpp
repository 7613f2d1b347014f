// Blum: what is made when it is first asked for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>

namespace blum::verifier {

/// A value that is made when it is first asked for, and then kept. Many threads may ask at once: one makes it, the
/// others wait. Where making it throws, the next one that asks tries again.
template <class T>
class Lazy {
 public:
  /// @param make  gives the value, the same whoever asks. It must not ask for the same one.
  template <class Make>
  const T& get(const Make& make) const {
    const std::scoped_lock lock(mutex_);
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
};

}  // namespace blum::verifier
