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

namespace blum::cli {
namespace {

constexpr int exit_failure = 1;
constexpr int exit_usage = 2;
constexpr int exit_not_certified = 3;

constexpr const char* examples = R"(Examples:
  blum make torus_knot -o knot.ply                 a shape to start from
  blum info knot.ply                               what it is
  blum field knot.ply -o knot.nrrd                 its exact signed distance field
  blum slice knot.nrrd -o knot.png                 a picture of it
  blum slice knot.nrrd -o cells.png --show sites   the Voronoi diagram
  blum medial knot.ply -o axis.vtp                 its medial axis, certified
  blum view knot.ply knot.nrrd axis.vtp --open     all of it in a browser

`blum COMMAND --help` says more. Exit status: 0 done, 2 bad usage, 3 not certified, 1 any
other failure; Ctrl-C ends by SIGINT (130 in a shell).
Existing output files are only ever replaced by complete ones.)";

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

/// Each step of the long computations takes and gives back arrays of megabytes. By default, glibc gives these back to
/// the system at once, which then clears their pages for the next step: a tenth of the time. Kept, they may be a
/// quarter more.
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
