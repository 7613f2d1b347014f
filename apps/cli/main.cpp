#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "commands.hpp"
#include "common/command_line.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "planning/no_path.hpp"

namespace blum::cli {
namespace {

constexpr int exit_failure = 1;
constexpr int exit_usage = 2;
constexpr int exit_not_certified = 3;

constexpr const char* examples = R"(Examples:
  blum make torus_knot -o knot.ply                 write a sample mesh
  blum info knot.ply                               report its properties
  blum field knot.ply -o knot.nrrd                 compute its signed distance field
  blum slice knot.nrrd -o knot.png                 draw one layer of the field
  blum slice knot.nrrd -o cells.png --show sites   draw its Voronoi regions
  blum medial knot.ply -o axis.vtp                 compute its certified medial axis
  blum view knot.ply knot.nrrd axis.vtp --open     show all three in a browser

`blum COMMAND --help` lists options and examples. Exit status: 0 success, 2 invalid usage,
3 not certified or no path found, 1 any other failure. Ctrl-C ends the process by SIGINT (130 in a shell).
An output file replaces an existing one only when it is complete.)";

int fail(const std::string& message, int status) {
  std::fflush(stdout);
  std::fprintf(stderr, "blum: error: %s\n", message.c_str());
  return status;
}

int run(std::vector<std::string> arguments) {
  const ToolTexts texts{.name = "blum",
                        .about = "Exact distance fields, Voronoi diagrams and medial axes of meshes and voxel images",
                        .version = "blum " BLUM_VERSION,
                        .footer = examples};
  const auto add_commands = [&](const Command& tool) {
    for (const auto& add : commands) add({tool, arguments});
    prepare_weld(arguments);
  };
  try {
    run_command_line(texts, add_commands, arguments);
    return 0;
  } catch (const NotCertified& error) {
    return fail(error.what(), exit_not_certified);
  } catch (const NoPath& error) {
    return fail(error.what(), exit_not_certified);
  } catch (const UsageError& error) {
    return fail(error.what(), exit_usage);
  } catch (const InvalidOption& error) {
    return fail(error.what(), exit_usage);
  } catch (const Cancelled&) {
    static_cast<void>(fail("cancelled", exit_failure));
    end_by_last_signal();
    return exit_failure;
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a coarser grid or a machine with more memory", exit_failure);
  } catch (const std::exception& error) {
    return fail(error.what(), exit_failure);
  }
}

/// Long computations allocate and free arrays of megabytes in each step. By default, glibc returns freed memory to the
/// system at once. The system must then clear its pages for the next step, which takes a tenth of the total time. So
/// freed memory is kept. The peak memory may be a quarter larger.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int mebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 1024 * mebibyte);
  mallopt(M_TRIM_THRESHOLD, 2047 * mebibyte);
  mallopt(M_TOP_PAD, 128 * mebibyte);
#endif
}

}  // namespace
}  // namespace blum::cli

int main(int count, char** values) {
  try {
    blum::cli::keep_freed_memory();
    return blum::cli::run(std::vector<std::string>(values + std::min(count, 1), values + count));
  } catch (...) {
    std::fputs("blum: error: unexpected failure\n", stderr);
    return 1;
  }
}
