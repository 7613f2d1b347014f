// Blum: binary glTF files, read without tinygltf. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace blum::test {

/// The parts of a .glb file according to section 4.4 of the specification of glTF 2.0.
class ReadGlb {
 public:
  explicit ReadGlb(std::string bytes) : bytes_(std::move(bytes)) {
    check(bytes_.size() >= 20 && bytes_.starts_with("glTF") && word(4) == 2, "header");
    check(word(8) == bytes_.size() && bytes_.size() % 4 == 0, "length");
    const std::size_t json_size = word(12);
    check(word(16) == 0x4E4F534A && json_size % 4 == 0, "description");
    json = nlohmann::json::parse(bytes_.substr(20, json_size));
    data_ = 28 + json_size;
    if (bytes_.size() == 20 + json_size) return;
    check(word(24 + json_size) == 0x004E4942 && data_ + word(20 + json_size) == bytes_.size(), "data");
    check(json["buffers"][0]["byteLength"] <= bytes_.size() - data_, "buffer");
  }

  [[nodiscard]] std::string view(std::size_t index) const {
    const nlohmann::json& view = json["bufferViews"].at(index);
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    check(offset % 4 == 0, "alignment");
    return bytes_.substr(data_ + offset, view["byteLength"]);
  }
  template <class T>
  [[nodiscard]] std::vector<T> numbers(std::size_t accessor) const {
    const nlohmann::json& about = json["accessors"].at(accessor);
    check(about["componentType"] == (std::is_same_v<T, float> ? 5126 : 5125), "type");
    const std::string raw = view(about["bufferView"]);
    const std::map<std::string, std::size_t> sizes{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    check(raw.size() == sizes.at(about["type"]) * about["count"].get<std::size_t>() * sizeof(T), "count");
    std::vector<T> out(raw.size() / sizeof(T));
    std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  [[nodiscard]] const nlohmann::json& part(std::size_t index) const {
    return json["meshes"][0]["primitives"].at(index);
  }
  [[nodiscard]] std::vector<float> attribute(const std::string& name, std::size_t of_part = 0) const {
    return numbers<float>(part(of_part)["attributes"].at(name));
  }
  [[nodiscard]] std::vector<std::uint32_t> indices(std::size_t of_part = 0) const {
    return numbers<std::uint32_t>(part(of_part)["indices"]);
  }

  nlohmann::json json;

 private:
  static void check(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("no .glb file: ") + what);
  }
  [[nodiscard]] std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at, 4);
    return value;
  }

  std::string bytes_;
  std::size_t data_ = 0;
};

}  // namespace blum::test
