// Proves that a solver stays usable after it ran out of memory between its two buffers. Once, the next frame wrote its
// sites through a null pointer.
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <fstream>

#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BLUM_TEST_HAS_SHADOW_MEMORY
#endif

namespace blum {
namespace {

/// Bytes of address space in use; 0 if the system does not report them.
std::size_t address_space() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(RegressionSolverMemory, StaysUsableAfterOnlyOneBufferFitted) {
#ifdef BLUM_TEST_HAS_SHADOW_MEMORY
  GTEST_SKIP() << "a sanitizer's shadow memory does not go with a limit on the address space";
#endif
#if defined(__GLIBC__)
  malloc_trim(0);  // memory of earlier tests would have room for the second buffer
#endif
  const std::size_t in_use = address_space();
  if (in_use == 0) GTEST_SKIP() << "the address space in use is not known here";
  const TriangleMesh box = make_box();
  GridSpec grid;
  grid.size = {256, 256, 256};
  grid.spacing = {0.01, 0.01, 0.01};
  FieldSolver solver(grid, {.sign = SignMode::none}, {.threads = 1});

  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit tight = before;
  tight.rlim_cur = in_use + grid.node_count() * 6;  // room for one buffer of 4 bytes a node, not for two
  ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
  EXPECT_THROW((void)solver.compute(box), OutOfMemory);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);

  const Field& field = solver.compute(box);
  EXPECT_EQ(field.distance.size(), grid.node_count());
  EXPECT_EQ(field.site.size(), grid.node_count());
}

}  // namespace
}  // namespace blum
