#include <garment/drape/layer_order.hpp>

#include <sloper/base/parallel.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/materials.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double NEAR_SKIN = 0.5;  // m: cloth farther from the skin has no order
constexpr double LEAST_GAP = 5e-4; // m: inner cloth is not tucked nearer to the skin
constexpr double PUSH = 5e-4; // m: apart, of an edge and the face that it crosses, in one round
constexpr int ROUNDS = 200;

/// Moves what of `inner` lies beyond `outer` to below it. The distance from skin is the order; it
/// also shows cloth that is too near.
void tuck(std::vector<Vec3>& inner, const std::vector<Vec3>& outer,
          const std::vector<Triangle>& triangles, const collision::BodyCollider& body,
          double thickness, LayerOrder& order) {
  const collision::TriangleTree tree(outer, triangles);
  std::vector<double> moved(inner.size(), 0);
  parallel_for(inner.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const collision::SignedDistance d = body.signed_distance(inner[i], NEAR_SKIN);
      if (d.triangle < 0 || d.distance <= 0)
        continue;
      const double seen = d.distance + thickness,
                   hit = tree.first_hit(d.point, d.point + seen * d.normal) * seen;
      if (!(hit < seen))
        continue;
      const double keep =
          std::min(d.distance, std::max(hit - thickness, std::min(LEAST_GAP, 0.5 * hit)));
      moved[i] = hit < d.distance ? d.distance - keep : 0;
      inner[i] = d.point + keep * d.normal;
    }
  });
  for (double m : moved) {
    order.tucked += m > 0;
    order.farthest_m = std::max(order.farthest_m, m);
  }
}

/// One round: edges and faces of different layers that cross go apart square to the skin.
/// @return crossings found
std::size_t part_layers(std::vector<Vec3>& x, const std::vector<int>& layer,
                        const std::vector<Triangle>& triangles, const collision::Topology& topology,
                        const collision::TriangleTree& tree, const collision::BodyCollider& body) {
  std::vector<Vec3> move(x.size(), Vec3::Zero());
  std::size_t count = 0;
  for (const collision::EdgeFaceIntersection& hit :
       collision::edge_face_intersections(x, triangles, topology, tree)) {
    const auto& e = topology.edges[hit.edge];
    const Triangle& t = triangles[hit.triangle];
    const int of_edge = layer[e[0]], of_face = layer[t[0]];
    if (of_edge == of_face)
      continue;
    ++count;
    const collision::SignedDistance d = body.signed_distance(hit.point, NEAR_SKIN);
    if (d.triangle < 0)
      continue;
    const Vec3 push = (of_edge > of_face ? PUSH : -PUSH) * d.normal; // of the edge
    move[e[0]] += push;
    move[e[1]] += push;
    for (int v : t)
      move[v] -= push;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double length = move[i].norm();
    if (length <= 0)
      continue;
    x[i] += std::min(1.0, PUSH / length) * move[i];
    const collision::SignedDistance d = body.signed_distance(x[i], NEAR_SKIN);
    if (d.triangle >= 0 && d.distance < LEAST_GAP)
      x[i] = d.point + LEAST_GAP * d.normal;
  }
  return count;
}

} // namespace

std::string layer_prefix(std::size_t layer) {
  return "layer " + std::to_string(layer) + ": ";
}

Garment merge_layers(const std::vector<Garment>& garments) {
  Garment all;
  pattern::PanelMesh& p = all.panels;
  bool scaled = false;
  for (const Garment& g : garments)
    scaled |= !g.rest_scale.empty();
  for (std::size_t k = 0; k < garments.size(); ++k) {
    const Garment& g = garments[k];
    const std::string prefix = layer_prefix(k);
    const int vertices = static_cast<int>(p.pattern.size()),
              triangles = static_cast<int>(p.triangles.size()),
              particles = static_cast<int>(all.position.size());
    const int panels = std::ssize(p.panels);
    for (pattern::PanelInfo info : g.panels.panels) {
      all.materials[prefix + info.material] = material_of(g, info.material);
      info.material.insert(0, prefix);
      info.name.insert(0, prefix);
      info.layer = static_cast<int>(k);
      info.first_vertex += vertices;
      info.first_triangle += triangles;
      for (int& v : info.outline)
        v += vertices;
      p.panels.push_back(std::move(info));
    }
    for (pattern::MeshSeam seam : g.panels.seams) {
      for (int& v : seam.a)
        v += vertices;
      for (int& v : seam.b)
        v += vertices;
      p.seams.push_back(std::move(seam));
    }
    p.pattern.insert(p.pattern.end(), g.panels.pattern.begin(), g.panels.pattern.end());
    for (pattern::StableId id : g.panels.ids) {
      id.panel += panels;
      p.ids.push_back(id);
    }
    for (int i : g.particle_of)
      all.particle_of.push_back(i + particles);
    for (std::size_t v = 0; v < g.particle_of.size(); ++v)
      p.placed.push_back(g.position[g.particle_of[v]]);
    for (const Triangle& t : g.panels.triangles)
      p.triangles.push_back({t[0] + vertices, t[1] + vertices, t[2] + vertices});
    all.position.insert(all.position.end(), g.position.begin(), g.position.end());
    if (scaled) {
      all.rest_scale.insert(all.rest_scale.end(), g.rest_scale.begin(), g.rest_scale.end());
      all.rest_scale.resize(p.triangles.size(), {1, 1, 1});
    }
    const auto add = [&](const auto& from, auto& to, auto&& panel) {
      for (auto item : from) {
        if (!panel(item).empty())
          panel(item).insert(0, prefix);
        to.push_back(std::move(item));
      }
    };
    const auto of_run = [](auto& item) -> std::string& { return item.run.panel; };
    add(g.scene.pins, all.scene.pins, of_run);
    add(g.scene.bands, all.scene.bands, of_run);
    add(g.scene.attachments, all.scene.attachments, of_run);
    add(g.scene.creases, all.scene.creases, of_run);
    add(g.scene.weights, all.scene.weights, of_run);
    for (SceneClosure closure : g.scene.closures) {
      closure.run.panel.insert(0, prefix);
      closure.with.panel.insert(0, prefix);
      all.scene.closures.push_back(std::move(closure));
    }
    for (const pattern::PanelInfo& info :
         g.panels.panels) // a shrink without a panel is of all panels of its garment
      for (SceneShrink s : g.scene.shrink) {
        if (!s.panel.empty() && s.panel != info.name)
          continue;
        s.panel = prefix + info.name;
        all.scene.shrink.push_back(s);
      }
    if (all.scene.membrane.empty())
      all.scene.membrane = g.scene.membrane;
    if (all.scene.bending.empty())
      all.scene.bending = g.scene.bending;
    if (g.scene.air) {
      all.scene.air = true;
      all.scene.wind_m_s = g.scene.wind_m_s;
    }
  }
  all.materials[""] = material_of(garments.front(), "");
  p.name = garments.back().panels.name;
  p.edge_length = garments.back().panels.edge_length;
  p.seam_length = garments.back().panels.seam_length;
  return all;
}

void split_layers(const Garment& merged, std::vector<Garment>& garments) {
  auto from = merged.position.begin();
  for (Garment& g : garments) {
    std::copy(from, from + static_cast<long>(g.position.size()), g.position.begin());
    from += static_cast<long>(g.position.size());
    g.converged = merged.converged;
    g.offset_m = merged.offset_m;
  }
}

LayerOrder order_layers(std::vector<Garment>& garments, const collision::BodyCollider& body,
                        double thickness_m) {
  LayerOrder order;
  for (std::size_t k = garments.size();
       k-- > 1;) // from outside: what is tucked below one layer is tucked below the next with it
    for (std::size_t i = 0; i < k; ++i)
      tuck(garments[i].position, garments[k].position, garments[k].particle_triangles(), body,
           thickness_m * static_cast<double>(k - i), order);
  std::vector<Vec3> x;
  std::vector<int> layer;
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < garments.size(); ++k) {
    const int first = std::ssize(x);
    for (const Triangle& t : garments[k].particle_triangles())
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    x.insert(x.end(), garments[k].position.begin(), garments[k].position.end());
    layer.resize(x.size(), static_cast<int>(k));
  }
  const collision::Topology topology = collision::make_topology(x.size(), triangles);
  collision::TriangleTree tree(x, triangles);
  std::vector<Vec3> best = x;
  for (int round = 0; round <= ROUNDS; ++round) {
    std::vector<Vec3> next = x;
    const std::size_t count = part_layers(next, layer, triangles, topology, tree, body);
    if (round == 0)
      order.crossed = order.remain = count;
    if (count <= order.remain) {
      order.remain = count;
      best = x;
    }
    if (count == 0)
      break;
    x = std::move(next);
    tree.refit(x);
  }
  std::size_t at = 0;
  for (Garment& g : garments)
    for (Vec3& p : g.position)
      p = best[at++];
  return order;
}

std::vector<std::size_t> order_violations(const std::vector<Garment>& garments,
                                          const collision::BodyCollider& body) {
  std::vector<std::size_t> count(garments.size(), 0);
  for (std::size_t k = 1; k < garments.size(); ++k) {
    const std::vector<Vec3>& outer = garments[k].position;
    const std::vector<Triangle> triangles = garments[k].particle_triangles();
    const collision::TriangleTree tree(outer, triangles);
    for (std::size_t i = 0; i < k; ++i)
      for (const Vec3& p : garments[i].position) {
        const collision::SignedDistance d = body.signed_distance(p, NEAR_SKIN);
        count[i] += d.triangle >= 0 && d.distance > 0 && tree.first_hit(d.point, p) < 1;
      }
  }
  return count;
}

} // namespace sloper::garment
