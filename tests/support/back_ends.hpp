// Blum: one test body for every back end. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "field/backend.hpp"
#include "support/emulated_backend.hpp"

namespace blum::test {

/// The back end that computes the fields of a test.
enum class BackEnd : std::uint8_t {
  cpu,
  host,    ///< the CUDA kernels, blocks and lists, run on the CPU: slow
  device,  ///< the first CUDA device
};

inline std::string name_of(BackEnd back_end) {
  return back_end == BackEnd::cpu ? "Cpu" : back_end == BackEnd::host ? "Host" : "Device";
}
inline void PrintTo(BackEnd back_end, std::ostream* out) {
  *out << name_of(back_end);
}
inline std::string back_end_name(const testing::TestParamInfo<BackEnd>& info) {
  return name_of(info.param);
}
inline auto every_back_end() {
  return testing::Values(BackEnd::cpu, BackEnd::host, BackEnd::device);
}
inline auto cuda_back_ends() {
  return testing::Values(BackEnd::host, BackEnd::device);
}

/// Base of fixtures whose tests run on several back ends. SetUp() calls use().
class OnBackEnd : public testing::Test {
 protected:
  /// Makes context() select a back end until the test ends. Skips the test if the back end is not available.
  void use(BackEnd back_end) {
    back_end_ = back_end;
    if (back_end == BackEnd::host) emulated_.emplace();
    if (back_end != BackEnd::device) return;
    try {
      std::string reason;
      (void)make_field_backend(context(), 1, reason);
    } catch (const DeviceError& error) {
      GTEST_SKIP() << "no CUDA device: " << error.what();
    }
  }

  [[nodiscard]] Device device() const { return back_end_ == BackEnd::cpu ? Device::cpu() : Device::cuda(); }
  [[nodiscard]] Context context(Context other = {}) const {
    other.device = device();
    return other;
  }

  /// The amount of work of a test: less on the host, which is slow.
  template <class T>
  [[nodiscard]] T usually(T amount, T on_host) const {
    return back_end_ == BackEnd::host ? on_host : amount;
  }

 private:
  BackEnd back_end_ = BackEnd::cpu;
  std::optional<EmulatedCuda> emulated_;
};

/// Fixture of tests whose only parameter is the back end.
class BackEndTest : public OnBackEnd, public testing::WithParamInterface<BackEnd> {
 protected:
  void SetUp() override { use(GetParam()); }
};

using NameAndBackEnd = std::tuple<std::string, BackEnd>;

/// Fixture of tests whose parameters are the name of a shape or file, and the back end.
class NamedBackEndTest : public OnBackEnd, public testing::WithParamInterface<NameAndBackEnd> {
 protected:
  void SetUp() override { use(std::get<1>(GetParam())); }
  [[nodiscard]] const std::string& name() const { return std::get<0>(GetParam()); }
};

inline std::string name_and_back_end(const testing::TestParamInfo<NameAndBackEnd>& info) {
  std::string name = std::get<0>(info.param) + "_" + name_of(std::get<1>(info.param));
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

}  // namespace blum::test
