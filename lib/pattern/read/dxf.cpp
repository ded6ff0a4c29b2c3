/// AAMA / ASTM D6673 DXF: one block per piece. Layers: 1 cut line, 14 sew line, 2 turn and 3 curve
/// points, 4 and 80-83 notches, 6 mirror line, 7 grain, 8 internal lines, 11 cut-outs, 15
/// annotation. Pieces are drawn face up, so every outline is taken counter-clockwise whatever its
/// drawing order.
#include <pattern/panel_words.hpp>
#include <pattern/read/choose_pieces.hpp>
#include <pattern/read/dxf_blocks.hpp>
#include <pattern/read/dxf_rings.hpp>
#include <pattern/read/dxf_sewing.hpp>
#include <pattern/read/outline_json.hpp>
#include <pattern/read/piece_fold.hpp>
#include <pattern/read/piece_notes.hpp>
#include <pattern/read/ring_repair.hpp>
#include <sloper/base/units.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/read/grade_rules.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace sloper::pattern {
namespace {

class PieceReader {
public:
  PieceReader(const DxfFile& dxf, const DxfChoice& choice, const std::string& file)
      : m_dxf(dxf), m_choice(choice), m_file(file) {}

  Pattern run() {
    m_pattern.source_format = "dxf";
    m_unit = unit();
    m_pattern.name = find_value(m_dxf.texts, "Style Name");
    if (m_choice.rules) {
      m_size =
          m_choice.size.empty() ? m_choice.rules->sample : m_choice.rules->find_size(m_choice.size);
      std::string list;
      for (const std::string& size : m_choice.rules->sizes)
        list += (list.empty() ? "" : ", ") + size;
      if (m_size < 0)
        throw input_error("dxf.no-size"_id, m_file, "", "there is no size '" + m_choice.size + "'",
                          "the grade rule table has " + list);
    }
    const std::vector<const DxfBlock*> blocks = chosen_blocks();
    m_any_wanted = std::any_of(blocks.begin(), blocks.end(),
                               [](const DxfBlock* b) { return piece_notes(*b).copies > 0; });
    for (const DxfBlock* block : blocks) {
      for (const DxfText& t : block->texts)
        m_states_seams = m_states_seams || (t.layer == 15 && t.text.rfind("SEW ", 0) == 0);
    }
    for (const DxfBlock* block : blocks)
      read_piece(*block);
    if (m_pattern.panels.empty())
      throw input_error("dxf.no-outline"_id, m_file, "",
                        "no block has a closed outline on layer 14 or 1",
                        "export the pieces as AAMA or ASTM DXF");
    m_sewing.make_seams(m_pattern, m_file);
    leave_out();
    return std::move(m_pattern);
  }

private:
  double unit() {
    if (m_choice.unit > 0)
      return m_choice.unit;
    std::string word = find_value(m_dxf.texts, "Units");
    for (const DxfBlock& b : m_dxf.blocks)
      if (word.empty())
        word = find_value(b.texts, "Units");
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (word.rfind("METRIC", 0) == 0)
      return metric_unit();
    if (word.rfind("MM", 0) == 0)
      return units::MM;
    if (word.rfind("CM", 0) == 0)
      return units::CM;
    if (word.rfind("ENGLISH", 0) == 0 || word.rfind("INCH", 0) == 0 ||
        word.rfind("IMPERIAL", 0) == 0)
      return units::INCH;
    switch (m_dxf.insunits) {
    case 1: return units::INCH;
    case 4: return units::MM;
    case 5: return units::CM;
    case 6: return 1;
    default: break;
    }
    const double guess = m_dxf.measurement == 0 ? units::INCH : units::MM;
    m_pattern.findings.push_back(
        {"dxf.unit-assumed"_id, std::string("the file states no unit; ") +
                                    (guess == units::MM ? "millimetres" : "inches") +
                                    " are assumed"});
    return guess;
  }

  /// METRIC means millimetres; CLO writes it over centimetres too. Then no piece would be as large
  /// as a hand.
  double metric_unit() {
    constexpr double SMALLEST = 0.1; // m, of the largest piece of a garment for people
    double largest = 0;              // file units
    for (const DxfBlock& block : m_dxf.blocks) {
      Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
      for (const DxfLine& line : block.lines)
        for (const Vec2& p : line.points) {
          low = low.cwiseMin(p);
          high = high.cwiseMax(p);
        }
      largest = std::max(largest, (high - low).maxCoeff());
    }
    if (largest * units::MM >= SMALLEST || largest * units::CM < SMALLEST)
      return units::MM;
    m_pattern.findings.push_back(
        {"dxf.unit-assumed"_id,
         "the file says METRIC: in millimetres its largest piece would "
         "measure " +
             centimetres(largest * units::MM) +
             ", so centimetres are taken; give --unit mm if it is so small"});
    return units::CM;
  }

  /// What orders the pieces, whatever their order in the file: name, then size of the drawing, then
  /// its place.
  std::vector<double> shape_of(const DxfBlock& block) const {
    double length = 0;
    Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
    for (const DxfLine& line : block.lines)
      for (std::size_t k = 0; k < line.points.size(); ++k) {
        low = low.cwiseMin(line.points[k]);
        high = high.cwiseMax(line.points[k]);
        if (k > 0)
          length += (line.points[k] - line.points[k - 1]).norm();
      }
    return {-length, high.x() - low.x(), high.y() - low.y(), low.x(), low.y()};
  }

  /// One block per piece: of a graded nest the size asked for, else the sample size, else the
  /// middle one.
  std::vector<const DxfBlock*> chosen_blocks() {
    std::map<std::string, std::vector<const DxfBlock*>> by_piece;
    const std::string sample = find_value(m_dxf.texts, "Sample Size");
    std::vector<std::string> known; // sizes
    for (const DxfBlock& b : m_dxf.blocks) {
      if (b.lines.empty())
        continue;
      std::string piece = find_value(b.texts, "Piece Name");
      if (piece.empty())
        piece = b.name;
      by_piece[piece].push_back(&b);
    }
    std::vector<const DxfBlock*> out;
    for (auto& [piece, blocks] : by_piece) {
      std::map<std::string, int> sizes;
      for (const DxfBlock* b : blocks)
        ++sizes[find_value(b->texts, "Size")];
      if (blocks.size() == 1 ||
          sizes.size() < blocks.size()) { // the same name and size twice: two pieces
        std::stable_sort(blocks.begin(), blocks.end(), [&](const DxfBlock* a, const DxfBlock* b) {
          return shape_of(*a) < shape_of(*b);
        });
        out.insert(out.end(), blocks.begin(), blocks.end());
        continue;
      }
      for (const auto& [size, n] : sizes)
        if (std::find(known.begin(), known.end(), size) == known.end())
          known.push_back(size);
      const DxfBlock* pick = nullptr;
      for (const std::string& wanted :
           {m_choice.size, m_choice.size.empty() ? sample : std::string()})
        for (const DxfBlock* b : blocks)
          if (!pick && !wanted.empty() && find_value(b->texts, "Size") == wanted)
            pick = b;
      if (!pick && !m_choice.size.empty() && !m_choice.rules) {
        std::string list;
        for (const auto& [size, n] : sizes)
          list += (list.empty() ? "" : ", ") + size;
        throw input_error("dxf.no-size"_id, m_file, piece,
                          "there is no size '" + m_choice.size + "'", "its sizes are " + list);
      }
      if (!pick)
        pick = blocks[blocks.size() / 2];
      out.push_back(pick);
      m_pattern.findings.push_back(
          {"dxf.size-taken"_id, piece + ": " + std::to_string(blocks.size()) + " sizes; size " +
                                    find_value(pick->texts, "Size") + " is taken"});
    }
    if (!m_choice.size.empty() && known.empty() && !m_choice.rules)
      throw input_error("dxf.no-size"_id, m_file, "",
                        "size '" + m_choice.size +
                            "' was asked for, but the file has only one size",
                        "give its grade rule table too");
    return out;
  }

  /// Moves a ring to the size asked for by the rule numbers written at its points ("# 7").
  void grade(const DxfBlock& block, PointRing& ring, const std::string& panel) {
    if (!m_choice.rules || m_size == m_choice.rules->sample)
      return;
    constexpr double AT_POINT = 1e-3,
                     AT_CORNER =
                         0.07; // m: on the ring, or on the cut line beside a corner of the sew line
    std::vector<int> rule(ring.size(), 0);
    std::vector<double> nearest(ring.size(), 1e300);
    int n_texts = 0;
    for (const DxfText& t : block.texts) {
      int number = 0;
      if (t.text.empty() || t.text[0] != '#' || !(std::istringstream(t.text.substr(1)) >> number) ||
          number <= 0)
        continue;
      ++n_texts;
      if (!m_choice.rules->moves.count(number))
        throw input_error("grading.no-rule"_id, m_file, panel,
                          "uses grade rule " + std::to_string(number) + ", which the table lacks",
                          "give the table that belongs to the file");
      std::size_t best = 0;
      for (std::size_t k = 1; k < ring.size(); ++k)
        if ((ring[k] - t.p * m_unit).norm() < (ring[best] - t.p * m_unit).norm())
          best = k;
      if ((ring[best] - t.p * m_unit).norm() > AT_POINT) {
        const std::vector<std::size_t> corners = corners_of(ring, {});
        best = corners[0];
        for (std::size_t k : corners)
          if ((ring[k] - t.p * m_unit).norm() < (ring[best] - t.p * m_unit).norm())
            best = k;
      }
      const double distance = (ring[best] - t.p * m_unit).norm();
      if (distance < AT_CORNER && distance < nearest[best]) {
        nearest[best] = distance;
        rule[best] = number;
      }
    }
    if (n_texts == 0)
      m_pattern.findings.push_back(
          {"grading.not-used"_id,
           panel + ": no grade rules at its points; it is taken in the sample size"});
    grade_ring(ring, rule, *m_choice.rules, m_size);
  }

  /// Notches, as points or as short lines into the piece; lines side by side are one notch.
  void read_notches(const DxfBlock& block, const PointRing& cut, const std::vector<Vec2>& cut_slits,
                    Panel& panel) const {
    constexpr double SIDE_BY_SIDE = 0.004; // m
    const double reach = 0.01 + m_choice.allowance;
    const auto is_notch = [](int layer) { return layer == 4 || (layer >= 80 && layer <= 83); };
    std::vector<std::pair<Vec2, int>> marks;
    for (const DxfPoint& p : block.points)
      if (is_notch(p.layer))
        marks.push_back({p.p * m_unit, p.layer});
    for (const Vec2& p : cut_slits)
      marks.push_back({p, 4});
    std::vector<std::vector<Vec2>> slits;
    std::vector<int> layers;
    for (const DxfLine& line : block.lines) {
      if (!is_notch(line.layer) || line.points.size() < 2)
        continue;
      const Vec2 a = line.points.front() * m_unit, b = line.points.back() * m_unit,
                 p = distance_to_ring(cut, a) <= distance_to_ring(cut, b) ? a : b;
      if (!slits.empty() && layers.back() == line.layer &&
          (slits.back().back() - p).norm() < SIDE_BY_SIDE)
        slits.back().push_back(p);
      else {
        slits.push_back({p});
        layers.push_back(line.layer);
      }
    }
    for (std::size_t k = 0; k < slits.size(); ++k) {
      Vec2 sum = Vec2::Zero();
      for (const Vec2& p : slits[k])
        sum += p;
      const Vec2 at = sum / static_cast<double>(slits[k].size());
      if (std::none_of(marks.begin(), marks.end(),
                       [&](const auto& m) { return (m.first - at).norm() < SIDE_BY_SIDE; }))
        marks.push_back({at, layers[k]});
    }
    for (const auto& [p, layer] : marks) {
      const int e = edge_near(panel, p);
      const ArcLength arc(panel.edge(e).path);
      double best = 1e300, at = 0;
      for (int k = 0; k <= 1000; ++k) {
        const double d = (arc.at(arc.length() * k / 1000) - p).norm();
        if (d < best) {
          best = d;
          at = k / 1000.0;
        }
      }
      if (best < reach)
        panel.notches.push_back({e, at, "layer " + std::to_string(layer)});
    }
  }

  void read_piece(const DxfBlock& block) {
    Panel panel;
    panel.name = find_value(block.texts, "Piece Name");
    if (panel.name.empty())
      panel.name = block.name;
    for (int k = 2; m_pattern.find_panel(panel.name) >= 0; ++k) { // reused names
      const std::string base = panel.name.substr(0, panel.name.rfind('#'));
      panel.name = base + "#" + std::to_string(k);
    }
    const double join = 1e-3;
    std::vector<PointRing> outer = rings_of(block, 14, m_unit, join),
                           cut = rings_of(block, 1, m_unit, join);
    bool sewn = true;    // whether the outline is the line that is sewn along
    if (outer.empty()) { // Valentina writes the sew line on layer 8, where others keep internal
                         // lines
      const std::vector<PointRing> inner = rings_of(block, 8, m_unit, join);
      if (!inner.empty() && !cut.empty() && follows(inner[0], cut[0]))
        outer = {inner[0]};
    } else if (!cut.empty() && !follows(outer[0], cut[0])) { // some programs write broken sew lines
      const double percent =
          100 * std::abs(ring_area(outer[0])) /
          std::max(std::abs(ring_area(cut[0])), 1e-12); // an outline may have no area
      m_pattern.findings.push_back(
          {"dxf.sew-line"_id,
           panel.name + ": the sew line encloses " +
               std::to_string(std::lround(std::min(1e6, percent))) +
               " % of the piece and does not follow its outline; it is left out"});
      outer.clear();
    }
    if (outer.empty() && !cut.empty()) {
      outer = cut;
      sewn = false;
      m_pattern.findings.push_back(
          {"dxf.sew-line"_id, panel.name + ": no sew line; the cut line is used in its place"});
    }
    if (outer.empty()) {
      m_pattern.findings.push_back(
          {"dxf.piece-left-out"_id,
           "block " + block.name + " has no closed outline and is left out"});
      return;
    }
    PointRing ring = outer[0];
    if (ring_area(ring) < 0)
      std::reverse(ring.begin(), ring.end());
    std::vector<Vec2> turns;
    for (const DxfPoint& p : block.points)
      if (p.layer == 2)
        turns.push_back(p.p * m_unit);
    const std::vector<Vec2> slits = take_slits_off(ring);
    if (!slits.empty())
      m_pattern.findings.push_back(
          {"dxf.slits"_id, panel.name + ": " + std::to_string(slits.size()) +
                               " slits in its outline are taken for notches"});
    std::vector<std::size_t> corners = corners_of(ring, turns);
    if (!sewn && m_choice.allowance > 0) {
      ring = without_allowance(ring, block, m_unit, m_choice.allowance, corners);
      m_pattern.findings.push_back({"dxf.allowance"_id, panel.name + ": an allowance of " +
                                                            centimetres(m_choice.allowance) +
                                                            " is taken off its cut line"});
    }
    panel.loops.push_back(edges_of(ring, corners, "edge"));
    for (PointRing hole : rings_of(block, 11, m_unit, join)) {
      if (ring_area(hole) > 0)
        std::reverse(hole.begin(), hole.end());
      panel.loops.push_back(edges_of(hole, corners_of(hole, turns),
                                     "hole" + std::to_string(panel.loops.size()) + "_"));
    }
    for (const DxfLine& line : block.lines)
      if (line.layer == 7 && line.points.size() >= 2) {
        Vec2 along = line.points.back() - line.points.front();
        if (along.norm() > 0)
          panel.grain = (along.y() < -1e-9 * along.norm() ? Vec2(-along) : along).normalized();
      }
    read_notches(block, cut.empty() ? ring : cut[0], slits, panel);
    if (!m_choice.rules || m_size == m_choice.rules->sample)
      read_marks(block, panel);
    const int index = std::ssize(m_pattern.panels);
    const PieceNotes notes = piece_notes(block);
    panel.label = notes.category.empty() ? notes.material : notes.category;
    read_sewing(block, panel, index);
    int fold = -1;
    for (const DxfLine& line : block.lines)
      if (line.layer == 6 && line.points.size() >= 2)
        fold = fold_edge(panel, line.points, m_unit, m_pattern.findings);
    // Notches and seams are fractions of edges, so the outline may move under them.
    grade(block, ring, panel.name);
    const std::vector<PanelEdge> graded = edges_of(ring, corners, "edge");
    for (std::size_t k = 0; k < graded.size(); ++k)
      panel.loops[0][k].path = graded[k].path;
    if (fold >= 0)
      open_fold(panel, fold, m_sewing.texts_of(std::ssize(m_pattern.panels)), m_pattern.findings);
    const bool alike = fold >= 0 || is_symmetric(ring);
    m_pattern.panels.push_back(std::move(panel));
    m_why_out.push_back(reason_to_leave(block, notes, ring, m_any_wanted));
    make_pair_of(notes, alike);
  }

  /// The other one of a pair comes after the piece that was drawn. Of two pieces that are each
  /// other's image and go around no limb, as a collar's stand, one is the inside.
  void make_pair_of(const PieceNotes& notes, bool alike) {
    const Panel& drawn = m_pattern.panels.back();
    if (notes.copies < 2)
      return;
    Words words = words_of(drawn.name);
    words.merge(words_of(notes.category));
    const bool limb = says_sleeve(words) || says_cuff(words) || says_legs(words);
    const std::string name = drawn.name + MIRRORED;
    const bool wanted = m_choice.sewn.empty() || m_choice.sewn.count(name) > 0;
    if (notes.mirrored < 1 || m_states_seams || (alike && !limb) || !wanted) {
      m_pattern.findings.push_back({"dxf.copies"_id, drawn.name + ": to be cut " +
                                                         std::to_string(notes.copies) +
                                                         " times; one copy is used"});
      return;
    }
    Panel image = mirror_image(drawn);
    image.name = name;
    m_pattern.findings.push_back({"dxf.copies"_id, drawn.name + ": to be cut " +
                                                       std::to_string(notes.copies) + " times; " +
                                                       name + " is its mirror image"});
    m_pattern.panels.push_back(std::move(image));
    m_why_out.push_back(m_why_out.back());
  }

  /// Linings and the like, unless they are asked for, sewn to something, or all that there is.
  void leave_out() {
    std::vector<bool> remove(m_pattern.panels.size(), false);
    for (std::size_t k = 0; k < remove.size(); ++k) {
      const Panel& panel = m_pattern.panels[k];
      const bool asked =
          std::any_of(m_choice.pieces.begin(), m_choice.pieces.end(),
                      [&](const std::string& name) { return is_named(panel, name); });
      remove[k] = !m_why_out[k].empty() && !asked && !m_states_seams &&
                  m_choice.sewn.count(panel.name) == 0;
    }
    if (std::find(remove.begin(), remove.end(), false) == remove.end())
      return;
    for (std::size_t k = 0; k < remove.size(); ++k)
      if (remove[k])
        m_pattern.findings.push_back(
            {"dxf.piece-left-out"_id, m_pattern.panels[k].name + " " + m_why_out[k] +
                                          " and is left out; name it in --pieces to take it"});
    remove_panels(m_pattern, remove);
  }

  /// Open lines of layer 8 that do not run along the outline.
  void read_marks(const DxfBlock& block, Panel& panel) {
    constexpr double SHORTEST = 0.01; // m
    for (const DxfLine& line : block.lines) {
      if (line.layer != 8 || line.closed || line.points.size() < 2)
        continue;
      InnerLine mark{"mark" + std::to_string(panel.lines.size() + 1), "mark", {}, 1, 0.01};
      double off = 0;
      for (std::size_t k = 0; k + 1 < line.points.size(); ++k) {
        const Vec2 a = line.points[k] * m_unit, b = line.points[k + 1] * m_unit;
        if ((a - b).norm() > 1e-6)
          mark.path.push_back(Segment::straight(a, b));
        double near = 1e300;
        for (int e = 0; e < panel.n_edges(); ++e)
          near = std::min(near, distance_to_path(panel.edge(e).path, 0.5 * (a + b)));
        off = std::max(off, near);
      }
      if (off > LINE_ON_EDGE && length(mark.path) > SHORTEST)
        panel.lines.push_back(std::move(mark));
    }
  }

  void read_sewing(const DxfBlock& block, Panel& panel, int index) {
    for (const DxfText& t : block.texts)
      if (t.layer == 15)
        m_sewing.read(t.text, panel, index, edge_near(panel, t.p * m_unit), m_file);
  }

  const DxfFile& m_dxf;
  const DxfChoice& m_choice;
  int m_size = 0; ///< index into the rules' sizes
  std::string m_file;
  double m_unit = units::MM;
  Pattern m_pattern;
  DxfSewing m_sewing;
  bool m_any_wanted = false;          ///< whether some piece is cut at all
  bool m_states_seams = false;        ///< in texts of layer 15: whoever wrote them drew every piece
  std::vector<std::string> m_why_out; ///< #panels
};

} // namespace

Pattern read_dxf(const std::string& text, const std::string& file, const DxfChoice& choice) {
  if (text.find('\0') != std::string::npos)
    throw input_error("pattern.unknown-format"_id, file, "", "this is a binary file",
                      "give a pattern JSON or a text DXF");
  DxfFile dxf = parse_dxf(text, file);
  if (dxf.blocks.empty()) {
    dxf.blocks = pieces_of_drawing(dxf);
    if (dxf.blocks.empty())
      throw input_error("dxf.no-outline"_id, file, "",
                        "there are no blocks, and the lines of the drawing form no closed outline",
                        "give an AAMA or ASTM DXF, one block per piece");
  }
  return PieceReader(dxf, choice, file).run();
}

} // namespace sloper::pattern
