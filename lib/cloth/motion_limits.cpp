#include <cloth/motion_limits.hpp>

#include <algorithm>
#include <limits>

namespace sloper::cloth {

/// Displacements are put on the planes in this many rounds before what is left is shortened.
static constexpr int ROUNDS = 2;

void MotionLimits::reset(std::size_t n_particles) {
  guards.clear();
  most.assign(n_particles, std::numeric_limits<double>::infinity());
}

void MotionLimits::apply(const std::vector<Vec3>& x, std::vector<Vec3>& dx, std::vector<char>& held) const {
  std::vector<double> share(dx.size(), 1), length(dx.size());
  for (std::size_t i = 0; i < dx.size(); ++i) length[i] = dx[i].norm();
  // by how much particle k of a guard may still come towards the plane, and its motion that way
  const auto room = [&](const PlaneGuard& g, int k) {
    const double height = g.normal.dot(x[g.particle[k]]);
    return std::max(0.0, k < g.n_above ? height - g.above : g.below - height);
  };
  const auto toward = [&](const PlaneGuard& g, int k) {
    const double along = g.normal.dot(dx[g.particle[k]]);
    return k < g.n_above ? -along : along;
  };
  std::vector<int> active; // guards that some particle's motion could reach; lengths never grow below
  for (std::size_t k = 0; k < guards.size(); ++k) {
    const PlaneGuard& g = guards[k];
    bool reach = false;
    for (int p = 0; p < g.n && !reach; ++p) reach = room(g, p) < length[g.particle[p]];
    if (reach) active.push_back(static_cast<int>(k));
  }
  for (int round = 0; round < ROUNDS; ++round)
    for (int index : active) {
      const PlaneGuard& g = guards[index];
      for (int k = 0; k < g.n; ++k) {
        const int i = g.particle[k];
        const double excess = toward(g, k) - room(g, k);
        if (excess <= 0) continue;
        dx[i] += (k < g.n_above ? excess : -excess) * g.normal;
        held[i] = 1;
      }
    }
  for (int index : active) {
    const PlaneGuard& g = guards[index];
    for (int k = 0; k < g.n; ++k) {
      const double have = room(g, k), along = toward(g, k);
      if (along > have + 1e-12) share[g.particle[k]] = std::min(share[g.particle[k]], have / along);
    }
  }
  for (std::size_t i = 0; i < dx.size(); ++i) {
    dx[i] *= share[i];
    const double move = dx[i].norm();
    if (move > most[i]) dx[i] *= most[i] / move;
  }
}

} // namespace sloper::cloth
