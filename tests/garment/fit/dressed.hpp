#pragma once
/// A garment on a body, and its fit, for tests of the fit.
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/fit.hpp>

namespace sloper::garment {

struct Dressed {
  body::Body body;
  Garment garment;
  FitReport report;
};

inline Dressed dressed(body::Body body, Garment garment,
                       const FitPolicy& policy = standard_fit_policy()) {
  bind_garment(garment, body);
  const collision::BodyCollider skin(body.skin);
  FitReport report = fit_garment(garment, body, skin, policy);
  return {std::move(body), std::move(garment), std::move(report)};
}

} // namespace sloper::garment
