#include "view/view_page.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"

namespace blum::cli {

// Variables in a file that cmake/embed.cmake generates.
extern const unsigned char viewer_page_bytes[];
extern const std::size_t viewer_page_size;

namespace {

/// Text in the page that is replaced by the scene.
constexpr std::string_view mark = "<!--scene-->";
constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Browsers limit texts to half a GiB, so a scene is divided into smaller elements. The size is a multiple of 3, as
/// base64 requires.
constexpr std::size_t most_in_element = std::size_t{48} << 20U;

/// Writes the bytes of a scene as base64 into elements of the page.
class SceneElements {
 public:
  explicit SceneElements(AtomicFile& file) : file_(file) {}

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t now = std::min(bytes.size(), most_in_element - waiting_.size());
      waiting_ += bytes.substr(0, now);
      bytes.remove_prefix(now);
      if (waiting_.size() == most_in_element) flush();
    }
  }
  void flush() {
    if (waiting_.empty()) return;
    file_.write(R"(<script type="application/octet-stream" class="scene">)");
    file_.write(base64(waiting_));
    file_.write("</script>\n");
    waiting_.clear();
  }

 private:
  static std::string base64(std::string_view bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t three = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        three = three << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
      }
      for (unsigned shift = 24; shift > 0; shift -= 6) text += digits[three >> (shift - 6) & 63U];
      for (std::size_t k = bytes.size(); k < i + 3; ++k) text[text.size() - (i + 3 - k)] = '=';
    }
    return text;
  }

  AtomicFile& file_;
  std::string waiting_;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string title_of(const Scene& scene) {
  const Json& items = scene.header["items"];
  if (items.empty()) return "Blum";
  std::string title = escaped(items.front()["name"].text());
  if (items.size() > 1) title += " and " + std::to_string(items.size() - 1) + " more";
  return title + " - Blum";
}

}  // namespace

std::string_view viewer_page() {
  return {reinterpret_cast<const char*>(viewer_page_bytes), viewer_page_size};
}

std::string titled_page(const Scene& scene) {
  constexpr std::string_view plain = "<title>Blum</title>";
  std::string page(viewer_page());
  const std::size_t at = page.find(plain);
  if (at != std::string::npos) page.replace(at, plain.size(), "<title>" + title_of(scene) + "</title>");
  return page;
}

void write_page(const std::filesystem::path& path, const Scene& scene) {
  const std::string titled = titled_page(scene);
  const std::string_view page = titled;
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos) throw Error("the viewer's page has no mark for the scene");
  AtomicFile file(path);
  file.write(page.substr(0, at));
  SceneElements elements(file);
  elements.write(SceneBlob::head(scene.header));
  for (const std::string_view bytes : scene.blob.arrays()) elements.write(bytes);
  elements.flush();
  file.write(page.substr(at + mark.size()));
  file.commit();
}

}  // namespace blum::cli
