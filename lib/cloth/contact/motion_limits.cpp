#include <sloper/cloth/contact/motion_limits.hpp>

#include <algorithm>
#include <limits>

namespace sloper::cloth {

/// Displacements are put on the planes in this many rounds before what is left is shortened.
static constexpr int ROUNDS = 2;

void MotionLimits::reset(std::size_t n_particles) {
  planes.clear();
  max_displacement.assign(n_particles, std::numeric_limits<double>::infinity());
}

void MotionLimits::apply(const std::vector<Vec3>& x, std::vector<Vec3>& dx,
                         std::vector<char>& held) const {
  constexpr double ROUNDING = 1e-12; // m
  std::vector<double> share(dx.size()), length(dx.size());
  for (std::size_t i = 0; i < dx.size(); ++i)
    length[i] = dx[i].norm();
  // by how much particle k of a plane may still come towards the plane where it is, and its motion
  // towards it
  const auto room = [&](const SeparatingPlane& g, int k) {
    const double height = g.normal.dot(x[g.particle[k]]);
    return std::max(0.0, k < g.n_above ? height - g.above : g.below - height);
  };
  const auto toward = [&](const SeparatingPlane& g, int k) {
    const double along = g.normal.dot(dx[g.particle[k]]);
    return k < g.n_above ? -along : along;
  };
  struct Active {
    int plane; // of `planes`
    bool stays;
  };
  std::vector<Active>
      active; // planes that some particle's motion could reach; lengths never grow below
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const SeparatingPlane& g = planes[k];
    bool reach = false;
    for (int p = 0; p < g.n && !reach; ++p)
      reach = room(g, p) < length[g.particle[p]];
    if (reach)
      active.push_back(
          {static_cast<int>(k), !planes_translate || g.n_above == 0 || g.n_above == g.n});
  }
  // How far a plane may go along its normal: at least `least` for what is below it, at most `most`
  // for what is above.
  struct Interval {
    double least, most;
  };
  const auto free_interval = [&](const SeparatingPlane& g) {
    Interval free{-std::numeric_limits<double>::infinity(),
                  std::numeric_limits<double>::infinity()};
    for (int k = 0; k < g.n_above; ++k)
      free.most = std::min(free.most, room(g, k) - toward(g, k));
    for (int k = g.n_above; k < g.n; ++k)
      free.least = std::max(free.least, toward(g, k) - room(g, k));
    return free;
  };
  for (int round = 0; round < ROUNDS; ++round)
    for (const Active& at : active) {
      const SeparatingPlane& g = planes[at.plane];
      double shift = 0; // of the plane along its normal
      if (!at.stays) {
        const Interval free = free_interval(g);
        if (free.least <= free.most)
          continue;
        shift = std::clamp(0.0, free.most, free.least); // what is faster is cut
      }
      for (int k = 0; k < g.n; ++k) {
        const int i = g.particle[k];
        const double excess = toward(g, k) - room(g, k) + (k < g.n_above ? shift : -shift);
        if (excess <= 0)
          continue;
        dx[i] += (k < g.n_above ? excess : -excess) * g.normal;
        held[i] = 1;
      }
    }
  // Towards planes that stay, less of a displacement is free too. So where both sides of a pair
  // still pass it, its plane stays.
  for (bool more = true; more;) {
    more = false;
    std::fill(share.begin(), share.end(), 1);
    for (Active& at : active) {
      const SeparatingPlane& g = planes[at.plane];
      if (!at.stays) {
        const Interval free = free_interval(g);
        if (free.least <= free.most + ROUNDING)
          continue;
        at.stays = true;
      }
      for (int k = 0; k < g.n; ++k) {
        const double have = room(g, k), along = toward(g, k);
        if (along > have + ROUNDING)
          share[g.particle[k]] = std::min(share[g.particle[k]], have / along);
      }
    }
    for (std::size_t i = 0; i < dx.size(); ++i) {
      more = more || share[i] < 1;
      dx[i] *= share[i];
      const double move = dx[i].norm();
      if (move > max_displacement[i]) {
        more = more || move > (1 + ROUNDING) * max_displacement[i];
        dx[i] *= max_displacement[i] / move;
      }
    }
    more = more && planes_translate; // else all stayed
  }
}

} // namespace sloper::cloth
