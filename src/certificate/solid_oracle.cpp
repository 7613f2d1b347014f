#include "certificate/solid_oracle.hpp"

#include <utility>

#include "certificate/drawn_balls.hpp"

namespace blum::verifier {

const Complement* SolidOracle::complement(const Context& context) const {
  return complement_.get([&] { return make_complement(context); }).get();
}

std::shared_ptr<const Samples> SolidOracle::samples(double step, const Context& context) const {
  const std::scoped_lock lock(samples_mutex_);
  if (samples_ == nullptr || step != step_of_samples_) {
    samples_ = std::make_shared<const Samples>(make_samples(step, context));
    step_of_samples_ = step;
  }
  return samples_;
}

struct KnownSolid::Later {
  Lazy<std::unique_ptr<DrawnBalls>> drawn_balls;
};

KnownSolid::KnownSolid(std::unique_ptr<SolidOracle> own, std::vector<BettiNumbers> betti)
    : solid(std::move(own)), bodies(std::move(betti)), later_(std::make_unique<Later>()) {}
KnownSolid::KnownSolid(KnownSolid&&) noexcept = default;
KnownSolid& KnownSolid::operator=(KnownSolid&&) noexcept = default;
KnownSolid::~KnownSolid() = default;

const DrawnBalls& KnownSolid::drawn_balls() const {
  const auto make = [&] { return std::make_unique<DrawnBalls>(*solid, static_cast<std::uint32_t>(bodies.size())); };
  return *later_->drawn_balls.get(make);
}

}  // namespace blum::verifier
