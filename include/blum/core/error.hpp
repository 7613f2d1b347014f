// Blum: exceptions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace blum {

/// Base of every exception that Blum throws. what() says what was wrong, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A mesh that cannot be used: no vertices, non-finite coordinates, indices out of range.
class InvalidMesh : public Error {
 public:
  using Error::Error;
};

/// A grid that cannot be used: non-positive spacing, no nodes, too many nodes.
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

/// The memory that a call needs is not there; the message says how much it asked for.
class OutOfMemory : public Error {
 public:
  using Error::Error;
};

/// A device that was asked for is not there, or failed; the message says which and what to do.
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

/// A file whose content is not what its format asks for; the message names the file and, where known, line or byte.
class FormatError : public FileError {
 public:
  using FileError::FileError;
};

/// An axis that is not certified, where one that is was asked for. what() names all that does not hold.
class NotCertified : public Error {
 public:
  /// @param mismatches  why not, one sentence each.  @param rest  goes on after them.
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
