#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {

void check_claims(CertificateOptions& options, double diagonal, std::vector<std::string>& mismatches) {
  const auto check = [&](std::optional<double>& value, const char* what, double least, double most, const char* must) {
    if (!value || (*value >= least && *value <= most)) return;
    mismatches.push_back("the axis says that its " + std::string(what) + " is " + exact_text(*value) +
                         ", but it must be " + must);
    value.reset();
  };
  check(options.theta, "theta", 0, 180, "0 to 180 degrees");
  // No two points of the solid are further apart than the diagonal.
  check(options.lambda, "lambda", 0, diagonal, "at least 0, and no more than the diagonal of the solid");
  check(options.spacing, "spacing", 1e-9 * diagonal, diagonal, "above 0, and no more than the diagonal of the solid");
  check(options.deviation, "deviation", 0, diagonal, "at least 0, and no more than the diagonal of the solid");
}

}  // namespace blum::verifier
