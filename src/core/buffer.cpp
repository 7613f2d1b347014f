#include "blum/core/buffer.hpp"

#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "blum/core/error.hpp"
#include "blum/core/huge_pages.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t cache_line = 64;
constexpr std::size_t huge_page = std::size_t{2} << 20;

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  const std::size_t alignment = bytes >= 2 * huge_page ? huge_page : cache_line;
  void* memory = nullptr;
  if (bytes <= PTRDIFF_MAX - alignment) {
    memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  }
  if (memory == nullptr) {
    throw OutOfMemory("cannot allocate " + std::to_string(bytes) +
                      " bytes; use a coarser grid or a machine with more memory");
  }
  request_huge_pages(memory, bytes);
  return memory;
}

void request_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  if (bytes < 2 * huge_page) return;
  // The range must begin at a page. Only whole huge pages in the range are affected.
  const std::size_t before = (huge_page - reinterpret_cast<std::uintptr_t>(memory) % huge_page) % huge_page;
  if (before >= bytes) return;
  madvise(static_cast<char*>(memory) + before, bytes - before, MADV_HUGEPAGE);  // may fail: faults only cost more
#endif
}

void free_aligned(void* memory, std::size_t /*bytes*/) noexcept {
  std::free(memory);
}

}  // namespace blum::detail
