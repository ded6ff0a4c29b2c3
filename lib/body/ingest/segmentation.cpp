#include <body/ingest/segmentation.hpp>
#include <body/ingest/voxels.hpp>
#include <sloper/base/statistics.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::body {

namespace {

constexpr int N_CELLS = 200; ///< along the longest side of the scan
constexpr double LEG_LOW = 0.05,
                 LEG_HIGH = 0.36; ///< where two legs are looked for, share of the height
constexpr double MIN_LEG_SHARE = 0.15, MIN_HEAD_SHARE = 0.4; ///< below these there is no person
constexpr double DOUBTFUL_SCORE = 0.6,
                 DOUBTFUL_MARGIN =
                     0.15; ///< a lower score that another direction comes near is no person
constexpr double CLEAR_SCORE = 0.8; ///< of a reading that leaves no doubt
constexpr double MAX_LOST_SHARE =
    0.04; ///< more cells than this in pieces over or under the body: it fell apart
constexpr double TOP_LOW = 0.92;    ///< above it there is only the head
constexpr double TOP_WIDTH = 0.22;  ///< a head is narrower than this share of the height
constexpr double FLOOR_BAND = 0.08; ///< a floor lies in this share of the height from below
constexpr double FLOOR_FACTOR = 4; ///< ... and fills this many times the cells of an ordinary layer

/// One reading of the scan: this axis, this sign is up.
struct Reading {
  int axis = 1;
  int reach = 1; ///< cells this near are joined
  bool flipped = false;
  double score = -1, leg_share = 0, lost_share = 0, head_share = 0, second_share = 0;
  bool has_floor = false;
  int floor_top = -1; ///< highest layer of the floor
  int low = 0, high = 0, n_debris = 0;
  std::vector<char> is_body; ///< per cell
};

int layer_of(const Voxels& voxels, int cell, const Reading& r) {
  const int k = voxels.cell(cell)[r.axis];
  return r.flipped ? voxels.extent(r.axis) - 1 - k : k;
}

/// Components of the cells that are not floor; neighbours up to two cells away, so that a scanner's
/// stripes hold together.
std::vector<int> label_pieces(const Voxels& voxels, const Reading& r, std::vector<int>& sizes) {
  std::vector<int> label(static_cast<std::size_t>(voxels.count()), -1), stack;
  for (int seed = 0; seed < voxels.count(); ++seed) {
    if (label[seed] >= 0 || layer_of(voxels, seed, r) <= r.floor_top)
      continue;
    const int piece = std::ssize(sizes);
    sizes.push_back(0);
    stack.assign(1, seed);
    label[seed] = piece;
    while (!stack.empty()) {
      const int c = stack.back();
      stack.pop_back();
      ++sizes[piece];
      const auto& at = voxels.cell(c);
      for (int dx = -r.reach; dx <= r.reach; ++dx)
        for (int dy = -r.reach; dy <= r.reach; ++dy)
          for (int dz = -r.reach; dz <= r.reach; ++dz) {
            const int n = voxels.number_at(at[0] + dx, at[1] + dy, at[2] + dz);
            if (n < 0 || label[n] >= 0 || layer_of(voxels, n, r) <= r.floor_top)
              continue;
            label[n] = piece;
            stack.push_back(n);
          }
    }
  }
  return label;
}

/// Sizes of the separate pieces of one layer (cells up to two apart), largest first, with the
/// largest extent of all.
struct LayerShape {
  std::vector<int> pieces;
  double width = 0; ///< cells
};

LayerShape shape_of_layer(const Voxels& voxels, const Reading& r, const std::vector<int>& cells) {
  LayerShape shape;
  const int a = (r.axis + 1) % 3, b = (r.axis + 2) % 3;
  DisjointSets joined(cells.size());
  std::vector<std::array<int, 3>> flat(cells.size());
  int low[2] = {1 << 30, 1 << 30}, high[2] = {-1, -1};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& c = voxels.cell(cells[i]);
    flat[i] = {c[a], c[b], static_cast<int>(i)};
    for (int k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], flat[i][k]);
      high[k] = std::max(high[k], flat[i][k]);
    }
  }
  std::sort(flat.begin(), flat.end());
  for (std::size_t i = 0; i < flat.size(); ++i)
    for (std::size_t j = i + 1; j < flat.size() && flat[j][0] - flat[i][0] <= r.reach; ++j)
      if (std::abs(flat[j][1] - flat[i][1]) <= r.reach)
        joined.unite(flat[i][2], flat[j][2]);
  std::vector<int> count(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i)
    ++count[joined.find(static_cast<int>(i))];
  for (int n : count)
    if (n > 0)
      shape.pieces.push_back(n);
  std::sort(shape.pieces.rbegin(), shape.pieces.rend());
  if (!cells.empty())
    shape.width = std::max(high[0] - low[0], high[1] - low[1]) + 1;
  return shape;
}

void find_floor(const std::vector<int>& layer_count, Reading& r) {
  std::vector<int> filled;
  for (int n : layer_count)
    if (n > 0)
      filled.push_back(n);
  if (filled.size() < 20)
    return;
  const int usual = upper_median(filled);
  const int band =
      static_cast<int>(std::ceil(FLOOR_BAND * static_cast<double>(layer_count.size())));
  for (int k = 0; k < band; ++k)
    if (layer_count[k] > FLOOR_FACTOR * usual) {
      r.has_floor = true;
      r.floor_top = k;
    }
  // a thick or uneven floor leaves a thin rest in the layer above
  if (r.has_floor && layer_count[r.floor_top + 1] > 2 * usual)
    ++r.floor_top;
}

/// @param without_floor pieces and their sizes as they are where there is no floor: the same in
/// every direction, filled when first needed
Reading read_direction(const Voxels& voxels, int axis, bool flipped, int reach,
                       std::pair<std::vector<int>, std::vector<int>>& without_floor) {
  Reading r;
  r.reach = reach;
  r.axis = axis;
  r.flipped = flipped;
  std::vector<int> layer_count(static_cast<std::size_t>(voxels.extent(axis)), 0);
  for (int c = 0; c < voxels.count(); ++c)
    ++layer_count[layer_of(voxels, c, r)];
  find_floor(layer_count, r);
  std::pair<std::vector<int>, std::vector<int>> with_floor;
  auto& [label, sizes] = r.has_floor ? with_floor : without_floor;
  if (label.empty())
    label = label_pieces(voxels, r, sizes);
  r.is_body.assign(static_cast<std::size_t>(voxels.count()), 0);
  if (sizes.empty())
    return r;
  const int body = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  // pieces of one body (holes, a scanner's blind spots) overlap its column and are not small; loose
  // debris is small
  std::vector<int> low(sizes.size(), 1 << 30), high(sizes.size(), -1);
  for (int c = 0; c < voxels.count(); ++c)
    if (label[c] >= 0) {
      const int k = layer_of(voxels, c, r);
      low[label[c]] = std::min(low[label[c]], k);
      high[label[c]] = std::max(high[label[c]], k);
    }
  r.low = low[body];
  r.high = high[body];
  // limbs that fell off stand over or under the body; a pole or a second person stands beside it
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  std::vector<std::array<int, 4>> extent(sizes.size(), {1 << 30, -1, 1 << 30, -1});
  for (int c = 0; c < voxels.count(); ++c)
    if (label[c] >= 0) {
      auto& e = extent[label[c]];
      e[0] = std::min(e[0], voxels.cell(c)[a]);
      e[1] = std::max(e[1], voxels.cell(c)[a]);
      e[2] = std::min(e[2], voxels.cell(c)[b]);
      e[3] = std::max(e[3], voxels.cell(c)[b]);
    }
  auto is_above_or_below = [&](std::size_t p) {
    const auto &e = extent[p], &of = extent[body];
    return e[0] >= of[0] - 3 && e[1] <= of[1] + 3 && e[2] >= of[2] - 3 && e[3] <= of[3] + 3;
  };
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    if (static_cast<int>(p) == body)
      continue;
    ++r.n_debris;
    if (is_above_or_below(p))
      r.lost_share += static_cast<double>(sizes[p]) / sizes[body];
    if (high[p] - low[p] > 0.5 * (r.high - r.low))
      r.second_share = std::max(r.second_share, static_cast<double>(sizes[p]) / sizes[body]);
  }
  for (int c = 0; c < voxels.count(); ++c)
    r.is_body[c] = label[c] == body;
  std::vector<std::vector<int>> layers(layer_count.size());
  for (int c = 0; c < voxels.count(); ++c)
    if (r.is_body[c])
      layers[layer_of(voxels, c, r)].push_back(c);
  const double height = r.high - r.low + 1;
  if (height < 20)
    return r;
  int n_leg = 0, n_two = 0, n_top = 0, n_narrow = 0;
  for (int k = r.low; k <= r.high; ++k) {
    const double f = (k - r.low + 0.5) / height;
    const bool leg = f > LEG_LOW && f<LEG_HIGH, top = f> TOP_LOW;
    if (!leg && !top)
      continue;
    const LayerShape shape = shape_of_layer(voxels, r, layers[k]);
    if (shape.pieces.empty())
      continue;
    if (top) {
      ++n_top;
      n_narrow += shape.width < TOP_WIDTH * height &&
                  (shape.pieces.size() < 2 || shape.pieces[1] < 0.5 * shape.pieces[0]);
    }
    if (leg) {
      ++n_leg;
      const double all = std::accumulate(shape.pieces.begin(), shape.pieces.end(), 0);
      n_two += shape.pieces.size() > 1 && shape.pieces[0] + shape.pieces[1] > 0.9 * all &&
               shape.pieces[1] > 0.4 * shape.pieces[0] && shape.width < 0.7 * height;
    }
  }
  r.leg_share = n_leg ? static_cast<double>(n_two) / n_leg : 0;
  r.head_share = n_top ? static_cast<double>(n_narrow) / n_top : 0;
  r.score = 0.6 * r.leg_share + 0.4 * r.head_share;
  return r;
}

/// Vertices in the floor's layers that stand under the body's lowest cells and above the floor's
/// own plane are feet.
void recover_feet(const TriangleMesh& scan, const Voxels& voxels, const Reading& r,
                  SegmentedScan& sorted) {
  std::vector<double> heights;
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    if (layer_of(voxels, voxels.of_vertex(v), r) <= r.floor_top)
      heights.push_back(scan.positions[v].dot(sorted.up));
  if (heights.empty())
    return;
  sorted.floor_height = upper_median(heights);
  const int a = (r.axis + 1) % 3, b = (r.axis + 2) % 3;
  std::vector<char> above(static_cast<std::size_t>(voxels.extent(a)) * voxels.extent(b), 0);
  for (int c = 0; c < voxels.count(); ++c) {
    const int k = layer_of(voxels, c, r);
    if (!r.is_body[c] || k > r.floor_top + 3)
      continue;
    const auto& at = voxels.cell(c);
    for (int da = -1; da <= 1; ++da)
      for (int db = -1; db <= 1; ++db) {
        const int x = at[a] + da, z = at[b] + db;
        if (x >= 0 && z >= 0 && x < voxels.extent(a) && z < voxels.extent(b))
          above[static_cast<std::size_t>(x) * voxels.extent(b) + z] = 1;
      }
  }
  // of a mesh, the pieces that reach up into the body are feet whatever their height; a floor that
  // is joined to them cannot be distinguished
  std::vector<char> foot_piece;
  std::vector<int> piece;
  if (!scan.triangles.empty()) {
    piece = connected_components(scan.positions.size(), scan.triangles);
    std::vector<int> in_floor(scan.positions.size(), 0), in_body(scan.positions.size(), 0);
    for (std::size_t v = 0; v < scan.positions.size(); ++v) {
      if (layer_of(voxels, voxels.of_vertex(v), r) <= r.floor_top)
        ++in_floor[piece[v]];
      else if (r.is_body[voxels.of_vertex(v)])
        ++in_body[piece[v]];
    }
    foot_piece.assign(scan.positions.size(), 0);
    for (std::size_t c = 0; c < in_floor.size(); ++c)
      foot_piece[c] = in_body[c] > in_floor[c];
  }
  const double tolerance = 0.5 * voxels.cell_size(); // a floor is rough by some millimetres
  for (std::size_t v = 0; v < scan.positions.size(); ++v) {
    const int c = voxels.of_vertex(v);
    if (layer_of(voxels, c, r) > r.floor_top)
      continue;
    const auto& at = voxels.cell(c);
    if (!foot_piece.empty() && foot_piece[piece[v]]) {
      sorted.is_body[v] = 1;
      continue;
    }
    if (above[static_cast<std::size_t>(at[a]) * voxels.extent(b) + at[b]] &&
        scan.positions[v].dot(sorted.up) > sorted.floor_height + tolerance)
      sorted.is_body[v] = 1;
  }
}

SegmentedScan sort_in_cells(const TriangleMesh& scan, const std::string& up_axis, int n_cells,
                            int reach) {
  const Voxels voxels(scan, n_cells);
  Reading best;
  std::pair<std::vector<int>, std::vector<int>> without_floor;
  double next = -1;
  for (int axis : {1, 2, 0}) { // ties go to y, then z
    if (up_axis != "auto" && up_axis[0] - 'x' != axis)
      continue;
    for (bool flipped : {false, true}) {
      Reading r = read_direction(voxels, axis, flipped, reach, without_floor);
      if (r.score > best.score + 1e-9) {
        next = best.score;
        best = std::move(r);
      } else
        next = std::max(next, r.score);
    }
  }
  SegmentedScan sorted;
  sorted.up = Vec3::Zero();
  sorted.up[best.axis] = best.flipped ? -1 : 1;
  sorted.up_name = std::string(best.flipped ? "-" : "+") + static_cast<char>('x' + best.axis);
  sorted.falls_apart = best.lost_share > MAX_LOST_SHARE;
  sorted.up_score = best.score;
  sorted.next_score = next;
  sorted.cell = voxels.cell_size();
  sorted.second_share = best.second_share;
  sorted.leg_share = best.leg_share;
  sorted.head_share = best.head_share;
  sorted.has_floor = best.has_floor;
  sorted.n_debris = best.n_debris;
  sorted.is_body.assign(scan.positions.size(), 0);
  if (best.is_body.empty())
    return sorted;
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    sorted.is_body[v] = best.is_body[voxels.of_vertex(v)];
  if (best.has_floor)
    recover_feet(scan, voxels, best, sorted);
  sorted.low = 1e300;
  sorted.high = -1e300;
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    if (sorted.is_body[v]) {
      const double h = scan.positions[v].dot(sorted.up);
      sorted.low = std::min(sorted.low, h);
      sorted.high = std::max(sorted.high, h);
    }
  return sorted;
}

} // namespace

SegmentedScan segment_scan(const TriangleMesh& scan, const std::string& up_axis) {
  // a thin cloud of points falls apart in small cells: larger ones are tried when the small ones
  // show no person clearly
  SegmentedScan best;
  double most = -1e300;
  for (const int n_cells : {N_CELLS, N_CELLS * 5 / 8, N_CELLS * 2 / 5}) {
    SegmentedScan sorted = sort_in_cells(scan, up_axis, n_cells, n_cells == N_CELLS ? 1 : 2);
    const bool person = shows_a_person(sorted);
    const bool whole = person && !sorted.falls_apart;
    if (whole && sorted.up_score > CLEAR_SCORE)
      return sorted;
    const int completeness = person + whole;
    const double worth = sorted.up_score + completeness;
    if (worth > most + 0.1) {
      most = worth;
      best = std::move(sorted); // the finer cells unless the larger ones are clearly better
    }
  }
  return best;
}

SegmentedScan segment_without(const std::vector<char>& is_extra, const TriangleMesh& scan,
                              const std::string& up_axis) {
  if (is_extra.empty())
    return segment_scan(scan, up_axis);
  TriangleMesh rest;
  std::vector<int> number(scan.positions.size(), -1);
  for (std::size_t v = 0; v < scan.positions.size(); ++v) {
    if (is_extra[v])
      continue;
    number[v] = static_cast<int>(rest.positions.size());
    rest.positions.push_back(scan.positions[v]);
  }
  for (const Triangle& t : scan.triangles)
    if (number[t[0]] >= 0 && number[t[1]] >= 0 && number[t[2]] >= 0)
      rest.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  SegmentedScan sorted = segment_scan(rest, up_axis);
  std::vector<char> is_body(scan.positions.size(), 0);
  for (std::size_t v = 0; v < is_body.size(); ++v)
    if (number[v] >= 0)
      is_body[v] = sorted.is_body[number[v]];
  sorted.is_body = std::move(is_body);
  return sorted;
}

SegmentedScan sort_coarsely(const TriangleMesh& scan, const std::string& up_axis, int n_cells) {
  return sort_in_cells(scan, up_axis, n_cells, 1);
}

std::vector<Vec3> points_of_body(const TriangleMesh& scan, const std::vector<char>& is_body,
                                 std::size_t wanted) {
  std::vector<Vec3> points;
  const std::size_t stride = 1 + scan.positions.size() / wanted;
  for (std::size_t v = 0; v < scan.positions.size(); v += stride)
    if (is_body[v])
      points.push_back(scan.positions[v]);
  auto is_of_body = [&](const Triangle& t) {
    return is_body[t[0]] && is_body[t[1]] && is_body[t[2]];
  };
  auto area_of = [&](const Triangle& t) {
    return area_normal(scan.positions[t[0]], scan.positions[t[1]], scan.positions[t[2]]).norm();
  };
  std::vector<double> areas;
  areas.reserve(scan.triangles.size());
  for (const Triangle& t : scan.triangles)
    areas.push_back(is_of_body(t) ? area_of(t) : 0);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (std::size_t f = 0; f < scan.triangles.size(); ++f) {
    const Triangle& t = scan.triangles[f];
    const int n = static_cast<int>(
        std::min(30.0, std::sqrt(static_cast<double>(wanted) * areas[f] / std::max(area, 1e-300))));
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const double u = (i + 1.0 / 3) / n, v = (j + 1.0 / 3) / n;
        points.push_back((1 - u - v) * scan.positions[t[0]] + u * scan.positions[t[1]] +
                         v * scan.positions[t[2]]);
      }
  }
  return points;
}

bool shows_a_person(const SegmentedScan& sorted) {
  // of a torso alone its arms are a little like legs, in one direction as in another
  const bool is_guess =
      sorted.up_score < DOUBTFUL_SCORE && sorted.up_score - sorted.next_score < DOUBTFUL_MARGIN;
  return sorted.high > sorted.low && sorted.leg_share >= MIN_LEG_SHARE &&
         sorted.head_share >= MIN_HEAD_SHARE && !is_guess;
}

} // namespace sloper::body
