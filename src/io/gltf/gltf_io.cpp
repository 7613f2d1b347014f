#include "blum/io/gltf_io.hpp"

#include <functional>
#include <new>
#include <ostream>
#include <streambuf>
#include <string>

#include "blum/io/atomic_file.hpp"
#include "io/bytes/field_sink.hpp"
#include "io/gltf/gltf_model.hpp"

namespace blum {
namespace {

using Put = std::function<void(std::span<const std::byte>)>;

/// Passes on what is written to a stream.
class PutBuffer : public std::streambuf {
 public:
  explicit PutBuffer(Put put) : put_(std::move(put)) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    put_(std::as_bytes(std::span(text, static_cast<std::size_t>(count))));
    return count;
  }
  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    const char one = traits_type::to_char_type(character);
    put_(std::as_bytes(std::span(&one, 1)));
    return character;
  }

 private:
  Put put_;
};

std::uint64_t size_of(const gltf_library::Model& model) {
  return model.buffers.empty() ? 0 : model.buffers.front().data.size();
}

/// @param put  gets the bytes of the file, piece by piece; what it throws comes through.
void write_model(const gltf_library::Model& model, const Put& put) {
  PutBuffer buffer(put);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);
  gltf_library::TinyGLTF library;
  if (!library.WriteGltfSceneToStream(&model, stream, false, true)) {
    throw FileError("tinygltf does not write what should be a mesh");
  }
}

template <class Use>
void with_model(const GltfMesh& mesh, const Context& context, Use use) {
  try {
    use(gltf_files::model_of(mesh, context));
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to write a mesh as glTF");
  }
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const GltfMesh& mesh, const Context& context) {
  with_model(mesh, context, [&](const gltf_library::Model& model) {
    AtomicFile file(path);
    volume_io::FieldSink sink(size_of(model), context);
    write_model(model, [&](std::span<const std::byte> bytes) { sink.write(file, bytes); });
    file.commit();
  });
}

std::vector<std::byte> encode_gltf(const GltfMesh& mesh, const Context& context) {
  std::vector<std::byte> out;
  with_model(mesh, context, [&](const gltf_library::Model& model) {
    write_model(model, [&](std::span<const std::byte> bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); });
  });
  return out;
}

}  // namespace blum
