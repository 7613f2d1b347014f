// Blum: exceptions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace blum {

/// Base of every exception that Blum throws. what() states the problem, its place and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A mesh that cannot be used, for example because it has no vertices, non-finite coordinates or indices out of range.
class InvalidMesh : public Error {
 public:
  using Error::Error;
};

/// A grid that cannot be used, for example because its spacing is not positive, or it has no nodes or too many nodes.
class InvalidGrid : public Error {
 public:
  using Error::Error;
};

/// A voxel image that cannot be used.
class InvalidImage : public Error {
 public:
  using Error::Error;
};

/// An option out of its range, or options that exclude each other.
class InvalidOption : public Error {
 public:
  using Error::Error;
};

/// A call needs more memory than is available. The message gives the size of the request.
class OutOfMemory : public Error {
 public:
  using Error::Error;
};

/// A requested device is not available, or failed. The message names the device and the remedy.
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// The caller asked to stop (Context::cancel).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled by the caller") {}
};

/// A file that cannot be opened, read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// A file whose content does not follow its format. The message names the file and, if known, the line or byte.
class FormatError : public FileError {
 public:
  using FileError::FileError;
};

/// An axis is not certified, although the caller requested a certified axis. The text of what() lists all mismatches.
class NotCertified : public Error {
 public:
  /// @param mismatches  the reasons, one sentence each.  @param rest  text that follows the mismatches in what().
  explicit NotCertified(std::vector<std::string> mismatches, const std::string& rest = "")
      : Error("NOT certified: " + joined(mismatches) + rest), mismatches_(std::move(mismatches)) {}
  [[nodiscard]] const std::vector<std::string>& mismatches() const { return mismatches_; }

 private:
  static std::string joined(const std::vector<std::string>& mismatches) {
    std::string all;
    for (const std::string& mismatch : mismatches) all += (all.empty() ? "" : "; ") + mismatch;
    return all;
  }
  std::vector<std::string> mismatches_;
};

}  // namespace blum
