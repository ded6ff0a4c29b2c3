#include <sloper/garment/bind/bind.hpp>

#include <garment/bind/bind_frames.hpp>
#include <garment/bind/bind_weights.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

/// The girths that the fit report compares: limb girths by their name, trunk levels as
/// "level:NAME".
std::map<std::string, double> girths_of(const body::Body& body) {
  std::map<std::string, double> girths;
  for (const auto& [name, girth] : body.girths)
    if (girth.value_m > 0)
      girths[name] = girth.value_m;
  for (const auto& [name, level] : body.levels)
    if (level.girth_m > 0)
      girths["level:" + name] = level.girth_m;
  return girths;
}

} // namespace

void bind_garment(Garment& garment, const body::Body& body) {
  if (garment.particle_of.empty() || garment.position.empty())
    throw input_error("garment.not-sewn"_id, "", "",
                      "the garment is not sewn, so it hangs on nothing", "drape it first");
  BindFrames frames = make_bind_frames(body);
  const auto weights = bind_weights(garment, body, frames);
  std::vector<char> needed(frames.frames.size(), 0);
  for (const auto& of_particle : weights)
    for (const auto& [k, weight] : of_particle)
      needed[k] = 1;
  fit_profiles(frames, body, needed);
  Bind bind;
  for (const BindFrame& f : frames.frames) {
    bind.frames.push_back(f.name);
    bind.lengths_m.push_back(f.frame.length());
    bind.marks.push_back(f.marks);
  }
  bind.particles.resize(garment.position.size());
  for (std::size_t i = 0; i < garment.position.size(); ++i)
    for (const auto& [k, weight] : weights[i]) {
      const BindFrame& f = frames.frames[k];
      const PartCoordinates c = f.frame.coordinates(garment.position[i]);
      bind.particles[i].push_back({k, weight, c.theta, c.z, c.r - f.profile.at(c.theta, c.z)});
    }
  garment.bind = std::move(bind);
  garment.body_girths_m = girths_of(body);
}

std::vector<Vec3> place_garment(const Garment& garment, const body::Body& body, Waist waist,
                                double lower_m) {
  const Bind& bind = garment.bind;
  if (bind.empty())
    throw input_error("garment.not-bound"_id, "", "/bind", "the garment is not bound to a body",
                      "drape it on a body first");
  BindFrames frames = make_bind_frames(body);
  std::vector<int> target(bind.frames.size(), -1);
  std::vector<MarkMap> maps;
  for (std::size_t k = 0; k < bind.frames.size(); ++k) {
    target[k] = frames.index(bind.frames[k]);
    const BindFrame* to = target[k] < 0 ? nullptr : &frames.frames[target[k]];
    auto marks = std::pair(bind.marks[k], to ? to->marks : Marks());
    if (waist == Waist::OF_ALL)
      marks = with_one_waist(std::move(marks.first), std::move(marks.second));
    maps.emplace_back(marks.first, bind.lengths_m[k], marks.second,
                      to ? to->frame.length() : bind.lengths_m[k]);
  }
  std::vector<char> needed(frames.frames.size(), 0);
  for (const std::vector<BindWeight>& weights : bind.particles)
    for (const BindWeight& w : weights)
      if (target[w.frame] >= 0)
        needed[target[w.frame]] = 1;
  fit_profiles(frames, body, needed);
  std::vector<Vec3> placed(bind.particles.size(), Vec3::Zero());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    double there = 0; // a collar does without the head, as long as it hangs on the torso as well
    for (const BindWeight& w : bind.particles[i])
      if (target[w.frame] >= 0)
        there += w.weight;
    if (there < 0.5)
      for (const BindWeight& w : bind.particles[i])
        if (target[w.frame] < 0)
          throw input_error("garment.part-missing"_id, "", "",
                            "the garment hangs on " + bind.frames[w.frame] +
                                ", which the body lacks",
                            "give a body with that part, or another garment");
    for (const BindWeight& w : bind.particles[i]) {
      if (target[w.frame] < 0)
        continue;
      const BindFrame& to = frames.frames[target[w.frame]];
      const double lowered =
          lower_m * (to.frame.upper - to.frame.lower).normalized().y() / to.frame.length();
      const double z = maps[w.frame](w.z) - lowered;
      const double r = std::max(to.profile.at(w.theta, z) + w.gap, 0.0);
      placed[i] += w.weight / there * to.frame.point({r, w.theta, z});
    }
  }
  return placed;
}

} // namespace sloper::garment
