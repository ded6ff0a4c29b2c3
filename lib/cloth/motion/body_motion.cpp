#include <sloper/base/parallel.hpp>
#include <sloper/base/statistics.hpp>
#include <sloper/cloth/motion/body_motion.hpp>

#include <algorithm>
#include <chrono>
#include <limits>

namespace sloper::cloth {

namespace {

/// Substeps of one advance: so many, and one more for so long a displacement, m; then the rest of
/// it is made at once. Substeps are 0.5 to 2 mm long on the mean.
constexpr int MOST_PARTS = 100;
constexpr double SHORTEST_PART = 2e-4;
/// Time given to a part is at least this share of the advance's, however short its displacement.
/// Without it cloth that must be as fast as the skin at once would never be: parts, and the time in
/// which the contact speeds the cloth up, shrink with the distance.
constexpr double LEAST_TIME = 0.02;
/// m: cloth this near moves with the skin, farther off less and less.
constexpr double CARRIED_WHOLE = 0.006, NOT_CARRIED = 0.03;
constexpr double ASK_LESS =
    4; ///< times: where cloth cannot follow the whole step that was asked for

/// Of the longest predictor: where the mean one is shorter, most of the cloth stays.
constexpr double MOST_STAYS = 0.25;

/// The displacement that all cloth has in common when a body walks; 0 where most of the cloth
/// stays. @param predictor #P by 3, m
Vec3 common_displacement(const std::vector<Vec3>& predictor) {
  Vec3 mean = Vec3::Zero(), median = Vec3::Zero();
  double longest = 0;
  for (const Vec3& c : predictor) {
    mean += c / static_cast<double>(predictor.size());
    longest = std::max(longest, c.norm());
  }
  if (mean.norm() <= MOST_STAYS * longest)
    return median;
  std::vector<double> part;
  for (int a = 0; a < 3; ++a) { // of what is carried at all: cloth that hangs free is not
    part.clear();
    for (const Vec3& c : predictor)
      if (c != Vec3::Zero())
        part.push_back(c[a]);
    median[a] = upper_median(part);
  }
  return median;
}

double longest_of(const std::vector<Vec3>& displacement) {
  double longest = 0;
  for (const Vec3& w : displacement)
    longest = std::max(longest, w.norm());
  return longest;
}

} // namespace

BodyMotion::BodyMotion(ClothSolver& solver, BodyContactEffect& contact,
                       collision::BodyCollider& body, SelfContactEffect* self_contact)
    : m_solver(solver), m_contact(contact), m_body(body), m_self_contact(self_contact),
      m_nearest(solver.x().size(), -1) {}

/// Predictor of each particle: the displacement of the nearest skin triangle, at the barycentric
/// coordinates of the nearest point, blended with the particle's own velocity as the distance
/// grows. Cloth left behind would be torn from cloth that moves with the skin.
/// @param displacement  #V by 3, m: displacement of the skin   @param time  s, in which it happens
void BodyMotion::predict_from_skin(const std::vector<Vec3>& displacement, double time) {
  const std::vector<Vec3>& x = m_solver.x();
  m_predictor.assign(x.size(), Vec3::Zero());
  parallel_for(x.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const collision::SignedDistance d = m_body.signed_distance(x[i], NOT_CARRIED, m_nearest[i]);
      m_nearest[i] = d.triangle;
      m_predictor[i] = time * m_solver.v()[i];
      if (d.triangle < 0)
        continue;
      const double far = std::clamp((d.distance - CARRIED_WHOLE) / (NOT_CARRIED - CARRIED_WHOLE),
                                    0.0, 1.0),
                   share = (1 - far) * (1 - far);
      const Triangle& t = m_body.mesh().triangles[d.triangle];
      m_predictor[i] *= 1 - share;
      for (int k = 0; k < 3; ++k)
        m_predictor[i] += share * d.barycentric[k] * displacement[t[k]];
    }
  });
  m_contact.push_predictor_off_skin(x, displacement, m_predictor);
}

/// Limits the predictor so that scaling it by `share` causes no self-collision. A common
/// translation of all cloth is exempt.
/// @param limits  of the layers where they are: what they are kept apart by is added, since self
/// contact names it once
std::vector<Vec3> BodyMotion::limit_predictor_by_self_ccd(double share,
                                                          MotionLimits& limits) const {
  const std::vector<Vec3>& x = m_solver.x();
  const Vec3 common = common_displacement(m_predictor);
  limits.max_displacement.assign(x.size(),
                                 std::numeric_limits<double>::infinity()); // of a longer step
  std::vector<Vec3> wanted = m_predictor;
  for (Vec3& c : wanted)
    c = share * (c - common);
  std::vector<Vec3> limited = wanted;
  std::vector<char> held(x.size(), 0);
  limits.apply(x, limited, held);
  for (int round = 1; round <= MAX_CCD_ROUNDS; ++round) {
    if (!m_self_contact->add_separating_planes(x, limited, limits, round == MAX_CCD_ROUNDS))
      break;
    limits.apply(x, limited, held);
  }
  for (std::size_t i = 0; i < limited.size(); ++i)
    limited[i] = limited[i] == wanted[i] ? m_predictor[i] : Vec3(limited[i] / share + common);
  return limited;
}

/// The step fraction of the skin that is free of collisions, with the predictor of its whole
/// displacement. Cloth between skin and cloth cannot follow the predictor at once and would stop
/// the skin within a hair: where a smaller step is taken, it moves with the cloth over it.
double BodyMotion::free_fraction(const std::vector<Vec3>& displacement, double longest,
                                 double time) {
  const std::vector<Vec3>& x = m_solver.x();
  predict_from_skin(displacement, time);
  if (!m_self_contact)
    return m_contact.collision_free_step_fraction(x, displacement, m_predictor);
  MotionLimits limits;
  limits.planes_translate = true;
  limits.reset(x.size());
  std::vector<Vec3> force(x.size(), Vec3::Zero());
  std::vector<ContactElement> elements;
  BlockMatrix unused; // self contact adds elements only
  StepContext context{x, 1, force, unused, elements, &limits};
  m_self_contact->begin_step(x, 1);
  m_self_contact->add(context);
  std::vector<Vec3> best_predictor(x.size(), Vec3::Zero());
  double best = 0;
  for (double asked = std::min(1.0, ASK_LESS * m_last_asked);; asked /= ASK_LESS) {
    m_last_asked = asked;
    std::vector<Vec3> limited = limit_predictor_by_self_ccd(asked, limits);
    const bool whole =
        limited == m_predictor; // what else stops the skin does so in a shorter step too
    const double share =
        std::min(asked, m_contact.collision_free_step_fraction(x, displacement, limited));
    if (share > best) {
      best = share;
      best_predictor = std::move(limited);
    }
    if (whole || best >= asked / ASK_LESS || asked * longest < SHORTEST_PART)
      break;
  }
  m_predictor = std::move(best_predictor);
  return best;
}

StepResult BodyMotion::advance(const std::vector<Vec3>& target, const StepOptions& options,
                               const std::function<StepResult(const StepOptions&)>& step) {
  ++calls;
  StepResult result;
  std::vector<Vec3> displacement(target.size()), skin, velocity(m_solver.x().size(), Vec3::Zero());
  const std::vector<Vec3> nothing = velocity;
  double left = 1, moved = 0; // left: share of the displacement; moved: of all parts together, m
  int most_parts = 0;
  for (int part = 1;; ++part) {
    const auto began = std::chrono::steady_clock::now();
    skin = m_body.mesh().positions;
    for (std::size_t v = 0; v < displacement.size(); ++v)
      displacement[v] = target[v] - skin[v];
    const double longest = longest_of(displacement);
    if (part == 1) {
      m_last_asked = 1;
      largest_way_m = std::max(largest_way_m, longest);
      most_parts = MOST_PARTS + static_cast<int>(std::min(longest / SHORTEST_PART, 1e6));
    }
    m_predictor = nothing;
    double share =
        longest > 0 ? free_fraction(displacement, longest, options.inertia * left * options.h) : 1;
    const bool force = part >= most_parts && share < 1;
    if (force) {
      share = 1;
      m_predictor = nothing;
    }
    if (share > 0 && longest > 0) {
      for (std::size_t v = 0; v < displacement.size(); ++v)
        skin[v] = share < 1 ? Vec3(skin[v] + share * displacement[v]) : target[v];
      std::vector<Vec3> carried = m_predictor;
      for (Vec3& c : carried)
        c *= share;
      m_contact.move_body(skin, m_solver.x(), carried);
      if (m_self_contact)
        m_self_contact->moved_by(common_displacement(carried));
    }
    if (force) {
      ++forced;
      m_contact.refresh();
    }
    StepOptions o = options;
    const double time = share * left;
    if (options.inertia > 0)
      o.h = std::max(LEAST_TIME, time) * options.h;
    left -= time;
    for (std::size_t i = 0; i < m_predictor.size(); ++i) {
      m_predictor[i] *= share;
      velocity[i] = -m_predictor[i] / o.h;
    }
    const bool carried = longest > 0;
    if (carried)
      m_solver.shift(m_predictor, velocity);
    wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    result = step ? step(o) : m_solver.step(o);
    for (Vec3& v : velocity)
      v = -v;
    if (carried && result.finite)
      m_solver.shift(nothing, velocity);
    ++parts;
    moved += result.largest_move_m + longest_of(m_predictor);
    result.largest_move_m = moved;
    if (!result.finite || share >= 1)
      return result;
  }
}

} // namespace sloper::cloth
