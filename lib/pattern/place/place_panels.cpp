#include <pattern/layout/leg_layout.hpp>
#include <pattern/panel_words.hpp>
#include <pattern/place/placer.hpp>
#include <pattern/place/tight_rings.hpp>
#include <pattern/roles/leg_roles.hpp>
#include <pattern/roles/panel_roles.hpp>
#include <sloper/base/text.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/pattern/place/place_panels.hpp>

#include <algorithm>
#include <set>

namespace sloper::pattern {

constexpr int ROUNDS = 60;
constexpr double MOST_ARM_SHIFT = 0.25; // m, by which sleeves are moved off the trunk
constexpr double SKIN_REACH = 0.05;     // m: what a face through the skin is that near to

Placer::Placer(const Pattern& pattern, const body::Body& body, PanelMesh& mesh,
               const Folding& folding)
    : m_pattern(pattern), m_mesh(mesh), m_folding(folding), m_space(body), m_graph(mesh),
      m_roles(panel_roles(pattern, mesh, m_graph)),
      m_spots(lay_out(pattern, mesh, m_graph, m_roles)), m_depth(m_roles.size(), 0),
      m_collider(body.skin) {
  const auto inner = [](const PanelInfo& a, const PanelInfo& b) { return a.layer < b.layer; };
  m_innermost = mesh.panels.empty()
                    ? 0
                    : std::min_element(mesh.panels.begin(), mesh.panels.end(), inner)->layer;
  for (std::size_t k = 0; k < m_depth.size(); ++k)
    m_depth[k] = mesh.panels[k].layer - m_innermost;
  for (const PanelInfo& p : mesh.panels)
    for (int t = 0; t < p.n_triangles; ++t)
      m_panel_of_triangle.push_back(static_cast<int>(&p - mesh.panels.data()));
}

PlacementReport Placer::run() {
  find_stated_skirts();
  make_groups();
  if (std::any_of(m_roles.begin(), m_roles.end(), [](const PanelRole& r) { return is_leg(r); }))
    level_trunk(m_mesh, m_graph, m_roles, m_spots);
  hang_sectors();
  anchor_trunk();
  anchor_neck();
  make_rings();
  place_all();
  PlacementReport report = push_free();
  for (std::size_t k = 0; k < m_roles.size(); ++k)
    m_mesh.panels[k].part =
        m_roles[k].part.empty() ? region_name(m_roles[k].region) : m_roles[k].part;
  measure_gaps(report);
  find_impossible(report);
  report.too_tight = tight_rings(m_pattern, m_mesh, m_space);
  const int unclassified = find_unclassified();
  report.is_guess =
      m_roles.size() > 1 &&
      (unclassified == std::ssize(m_roles) ||
       std::all_of(m_roles.begin(), m_roles.end(), [](const PanelRole& r) { return r.by_shape; }));
  return report;
}

int Placer::find_unclassified() {
  std::string names, shaped, fronts;
  int count = 0;
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    const Panel& panel = m_pattern.panels[k];
    if (m_roles[k].by_shape) {
      std::string side;
      if (m_roles[k].side == Side::FRONT)
        side = ", front";
      if (m_roles[k].side == Side::BACK)
        side = ", back";
      shaped +=
          (shaped.empty() ? "" : ", ") + panel.name + " (" + m_mesh.panels[k].part + side + ")";
      if (m_roles[k].unsure_front && m_roles[k].side == Side::FRONT)
        fronts += (fronts.empty() ? "" : ", ") + panel.name;
      continue;
    }
    if (panel.hint.rigid || !panel.hint.part.empty() || m_roles[k].side == Side::RING ||
        says_anything(words_of(m_pattern, k)))
      continue;
    names += (count++ ? ", " : "") + panel.name;
  }
  if (!fronts.empty())
    m_mesh.findings.push_back({"placement.front-unsure"_id,
                               "start: is " + fronts +
                                   " the front? Front and back differ too little to tell; if it is "
                                   "the back, put the word back into the name of one of them"});
  if (!shaped.empty())
    m_mesh.findings.push_back(
        {"placement.by-shape"_id, "start: placed by their shapes: " + shaped});
  if (count > 0)
    m_mesh.findings.push_back(
        {"placement.guessed"_id,
         "start: nothing says where " + names + (count > 1 ? " belong" : " belongs") +
             ": taken for the front, or for front and back where they are sewn to "
             "each other at both sides; put a word such as front, back, sleeve, "
             "cuff, collar, skirt or trousers into the name, or give a hint"});
  return count;
}

void Placer::make_groups() {
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    std::size_t g = 0;
    const std::string leg = is_leg(m_roles[k]) ? m_roles[k].part : "";
    while (g < m_groups.size() &&
           (m_groups[g].region != m_roles[k].region || m_groups[g].leg != leg ||
            (leg.empty() && m_groups[g].side != m_roles[k].side)))
      ++g;
    if (g == m_groups.size())
      m_groups.push_back({m_roles[k].region, m_roles[k].side, {}, 0, 0, leg});
    m_groups[g].panels.push_back(k);
    m_group_of.push_back(g);
  }
}

void Placer::place_all() {
  for (const PanelGroup& g : m_groups)
    place_group(g);
  for (std::size_t ring = 0; ring < m_rings.size(); ++ring)
    place_gores(ring);
}

void Placer::make_rings() {
  m_in_ring.assign(m_roles.size(), 0);
  m_rings = GoreRow::find(m_mesh, m_graph, m_roles, m_spots);
  std::vector<Vec3> skin;
  for (std::size_t v = 0; v < m_space.parts().size() && !m_rings.empty(); ++v)
    if (const body::Part part = m_space.parts()[v];
        part == body::Part::TORSO || part == body::Part::LEG_L || part == body::Part::LEG_R)
      skin.push_back(m_space.body().skin.positions[v]);
  for (const GoreRow& ring : m_rings) {
    m_ring_tubes.emplace_back(ring, skin);
    for (const Gore& g : ring.gores)
      m_in_ring[g.panel] = 1;
  }
}

std::map<std::pair<int, int>, int> Placer::crossings() const {
  const collision::TriangleTree tree(m_mesh.placed, m_mesh.triangles);
  std::map<std::pair<int, int>, int> count;
  for (const auto& pair : collision::self_intersections(m_mesh.placed, m_mesh.triangles, tree)) {
    const int p = m_panel_of_triangle[pair[0]], q = m_panel_of_triangle[pair[1]];
    ++count[{std::min(p, q), std::max(p, q)}];
  }
  return count;
}

bool Placer::meets_trunk(const PanelGroup& group, const std::vector<Triangle>& triangles,
                         const std::vector<int>& through) const {
  const bool left = group.region == Region::ARM_L;
  if ((!left && group.region != Region::ARM_R) || m_arm_shift[left] < -MOST_ARM_SHIFT)
    return false;
  const body::Part arm = left ? body::Part::ARM_L : body::Part::ARM_R;
  int elsewhere = 0;
  for (const int t : through) {
    const Triangle& corner = triangles[t];
    Vec3 middle = Vec3::Zero();
    for (const int v : corner)
      middle += m_mesh.placed[v] / 3;
    const int skin = m_collider.signed_distance(middle, SKIN_REACH, -1).triangle;
    if (skin >= 0 && m_space.body().face_part[skin] != arm)
      ++elsewhere;
  }
  return 2 * elsewhere > std::ssize(through);
}

PlacementReport Placer::push_free() {
  PlacementReport report;
  for (int round = 0; round < ROUNDS; ++round) {
    bool changed = false;
    report.crossings = report.vertices_inside = report.faces_through = 0;
    std::set<int> moved_arms;
    std::set<std::size_t> grow, widen;
    bool raise_neck = false;
    for (const auto& [pair, n] : crossings()) {
      report.crossings += n;
      const std::size_t p = static_cast<std::size_t>(pair.first),
                        q = static_cast<std::size_t>(pair.second);
      if (m_roles[p].region == Region::NECK || m_roles[q].region == Region::NECK) {
        if (m_roles[p].region == m_roles[q].region) {
          if (p != q) { // what lies over the other goes farther out, else the smaller one
            const bool over =
                m_depth[p] == m_depth[q] ? area(p) > area(q) : m_depth[q] > m_depth[p];
            ++m_depth[over ? q : p];
            changed = true;
          }
        } else
          raise_neck = true;
      } else if (is_arm(p) != is_arm(q)) {
        // Out along the arm first; a hanging arm never leaves the wings of a wide skirt that way,
        // so then they make room.
        const bool left = m_roles[is_arm(p) ? p : q].region == Region::ARM_L;
        PanelGroup& trunk = m_groups[m_group_of[is_arm(p) ? q : p]];
        if (m_arm_shift[left] > -0.2 || trunk.side == Side::RING || trunk.wing > 0.2)
          moved_arms.insert(left);
        else
          widen.insert(m_group_of[is_arm(p) ? q : p]);
      } else if (is_arm(p)) {
        if (m_group_of[p] != m_group_of[q]) {
          grow.insert(m_group_of[p]);
          grow.insert(m_group_of[q]);
        } else
          grow.insert(m_group_of[p]);
      } else if (m_group_of[p] == m_group_of[q] && p != q && m_roles[p].side == m_roles[q].side) {
        if (m_depth[p] == m_depth[q]) {
          ++m_depth[area(p) > area(q) ? q : p];
          changed = true;
        } else {
          ++m_depth[m_depth[p] > m_depth[q] ? p : q];
          changed = true;
        }
      } else {
        grow.insert(m_group_of[p]);
        grow.insert(m_group_of[q]);
      }
    }
    for (std::size_t g : widen) {
      m_groups[g].wing += 0.01;
      changed = true;
    }
    if (raise_neck && m_raised < 0.15) {
      m_raised += 0.01;
      changed = true;
      for (std::size_t k = 0; k < m_roles.size(); ++k)
        if (m_roles[k].region == Region::NECK)
          m_spots[k].offset.y() += 0.01;
    }
    for (std::size_t g = 0; g < m_groups.size(); ++g) {
      int inside = 0;
      std::vector<Triangle> triangles;
      for (std::size_t k : m_groups[g].panels) {
        const PanelInfo& info = m_mesh.panels[k];
        for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v)
          inside += m_collider.is_inside(m_mesh.placed[v]);
        triangles.insert(triangles.end(), m_mesh.triangles.begin() + info.first_triangle,
                         m_mesh.triangles.begin() + info.first_triangle + info.n_triangles);
      }
      const std::vector<int> through = m_collider.faces_through(m_mesh.placed, triangles);
      report.vertices_inside += inside;
      report.faces_through += static_cast<int>(through.size());
      if (inside == 0 && through.empty())
        continue;
      if (meets_trunk(m_groups[g], triangles, through))
        moved_arms.insert(m_groups[g].region == Region::ARM_L);
      else
        grow.insert(g);
    }
    for (int left : moved_arms)
      if (m_arm_shift[left] > -0.4) {
        m_arm_shift[left] -= 0.01;
        changed = true;
      }
    for (std::size_t g : grow)
      if (m_groups[g].extra < 0.25) {
        m_groups[g].extra += 0.005;
        changed = true;
      }
    if (!changed)
      break;
    place_all();
  }
  if (report.crossings)
    for (const auto& [pair, n] : crossings())
      m_mesh.findings.push_back(
          {"placement.not-free"_id, "start: " + m_mesh.panels[pair.first].name + " and " +
                                        m_mesh.panels[pair.second].name + " cross in " +
                                        std::to_string(n) + " pairs of triangles"});
  if (report.vertices_inside + report.faces_through)
    m_mesh.findings.push_back(
        {"placement.not-free"_id,
         "start: " + std::to_string(report.vertices_inside) + " vertices inside the body, " +
             std::to_string(report.faces_through) + " faces through its skin"});
  return report;
}

double Placer::share_below_floor(const PanelInfo& panel) const {
  double all = 0, below = 0;
  for (int t = panel.first_triangle; t < panel.first_triangle + panel.n_triangles; ++t) {
    const auto& [a, b, c] = m_mesh.triangles[t];
    const double size =
        (m_mesh.placed[b] - m_mesh.placed[a]).cross(m_mesh.placed[c] - m_mesh.placed[a]).norm();
    all += size;
    if (m_mesh.placed[a].y() + m_mesh.placed[b].y() + m_mesh.placed[c].y() < 0)
      below += size;
  }
  return all > 0 ? below / all : 0;
}

void Placer::find_impossible(PlacementReport& report) const {
  constexpr double WIDEST_GAP = 1, ABOVE_HEAD = 0.3; // m
  // Long skirts and their flounces start a little below the floor: 17 cm at most in 120 random
  // garments of GarmentCode and 12 of Garment-Pattern-Generator.
  constexpr double BELOW_FLOOR = 0.3, MOST_OF_PANEL = 0.5; // m, of its area
  for (const PanelInfo& info : m_mesh.panels) {
    double low = 1e300, high = -1e300;
    for (int v : info.outline) {
      const double y = m_mesh.placed[v].y();
      low = std::min(low, y);
      high = std::max(high, y);
    }
    const double below = low < -BELOW_FLOOR ? share_below_floor(info) : 0;
    if (high < -BELOW_FLOOR)
      report.impossible.push_back(info.name + " starts below the floor, down to " +
                                  centimetres(low));
    else if (below > MOST_OF_PANEL)
      report.impossible.push_back(info.name + " starts with " + whole_percent(below) +
                                  " of its area below the floor, down to " + centimetres(low));
    if (low > m_space.stature() + ABOVE_HEAD)
      report.impossible.push_back(info.name + " starts above the head, at " + centimetres(low));
  }
  for (const MeshSeam& s : m_mesh.seams) {
    double sum = 0;
    for (std::size_t k = 0; k < s.a.size(); ++k)
      sum += (m_mesh.placed[s.a[k]] - m_mesh.placed[s.b[k]]).norm();
    const double gap = sum / static_cast<double>(s.a.size());
    if (gap > WIDEST_GAP)
      report.impossible.push_back("the sides of seam " + s.name + " start " + centimetres(gap) +
                                  " apart");
  }
}

void Placer::measure_gaps(PlacementReport& report) const {
  double sum = 0;
  int n = 0;
  for (const MeshSeam& s : m_mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k) {
      const double gap = (m_mesh.placed[s.a[k]] - m_mesh.placed[s.b[k]]).norm();
      sum += gap;
      ++n;
      report.seam_gap_max = std::max(report.seam_gap_max, gap);
    }
  report.seam_gap_mean = n ? sum / n : 0;
}

PlacementReport place_panels(const Pattern& pattern, const body::Body& body, PanelMesh& mesh) {
  mesh.placement = Placement::BODY;
  // Pleats are laid, collars and lapels turned over, before the panels are placed: their cloth is
  // where it will be sewn and worn.
  const Folding folding = fold_panels(pattern, mesh);
  if (folding.shift.empty())
    return Placer(pattern, body, mesh, folding).run();
  const std::vector<Vec2> flat = mesh.pattern;
  std::vector<int> layers;
  for (std::size_t v = 0; v < flat.size(); ++v)
    mesh.pattern[v] += folding.shift[v];
  for (std::size_t k = 0; k < mesh.panels.size(); ++k) {
    layers.push_back(mesh.panels[k].layer);
    if (turned_whole(pattern.panels[k]))
      ++mesh.panels[k].layer; // it lies over its stand
  }
  const PlacementReport report = Placer(pattern, body, mesh, folding).run();
  mesh.pattern = flat;
  for (std::size_t k = 0; k < layers.size(); ++k)
    mesh.panels[k].layer = layers[k];
  return report;
}

void lay_flat(const Pattern& pattern, PanelMesh& mesh) {
  const bool stated = std::all_of(pattern.panels.begin(), pattern.panels.end(),
                                  [](const Panel& p) { return p.hint.rigid.has_value(); });
  mesh.placement = stated ? Placement::STATED : Placement::FLAT;
  if (stated)
    return;
  double x = 0;
  for (const PanelInfo& info : mesh.panels) {
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (int v : info.outline) {
      low = low.cwiseMin(mesh.pattern[v]);
      high = high.cwiseMax(mesh.pattern[v]);
    }
    for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
      const Vec2 p = mesh.pattern[v] - low;
      mesh.placed[v] = Vec3(x + p.x(), p.y(), 0);
    }
    x += high.x() - low.x() + 0.05;
  }
  mesh.findings.emplace_back("placement.flat"_id,
                             "no body is given: the panels lie flat side by side");
}

} // namespace sloper::pattern
