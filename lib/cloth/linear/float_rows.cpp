#include <cloth/linear/float_rows.hpp>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace sloper::cloth {

/// Slots of each group of rows, and their columns; what pads them reads the first particle.
static void group_rows(const std::vector<int>& start, const std::vector<int>& column,
                       std::vector<int>& group_start, std::vector<FloatRows::Slot>& slot) {
  const int n = static_cast<int>(start.size()) - 1;
  group_start.assign(1, 0);
  for (int first = 0; first < n; first += FloatRows::GROUP) {
    int longest = 0;
    for (int i = first; i < std::min(first + FloatRows::GROUP, n); ++i)
      longest = std::max(longest, start[i + 1] - start[i]);
    group_start.push_back(group_start.back() + longest);
  }
  slot.assign(group_start.back(), {});
  for (int i = 0; i < n; ++i)
    for (int k = start[i]; k < start[i + 1]; ++k)
      slot[group_start[i / FloatRows::GROUP] + k - start[i]].column[i % FloatRows::GROUP] =
          column[k];
}

FloatRows::FloatRows(const std::vector<int>& start, const std::vector<int>& column,
                     const std::vector<int>& isotropic_start,
                     const std::vector<int>& isotropic_column, bool symmetric)
    : m_rows(static_cast<int>(start.size()) - 1), m_blocks(column.size()),
      m_numbers(symmetric ? 6 : 9) {
  group_rows(start, column, m_start, m_column);
  if (isotropic_start.empty())
    m_isotropic_start.assign(m_start.size(), 0);
  else
    group_rows(isotropic_start, isotropic_column, m_isotropic_start, m_isotropic_column);
  m_value.resize(m_numbers * m_column.size());
  m_isotropic_value.resize(m_isotropic_column.size());
}

namespace {

/// What a product reads of a group: blocks and isotropic blocks, with their columns.
struct Group {
  const FloatRows::Slot *slot, *slot_end;
  const Float8* value;
  const FloatRows::Slot *isotropic_slot, *isotropic_slot_end;
  const Float8* isotropic_value;
};

/// Where a block's numbers are: of row r and column c at AT[r][c].
template<bool SYMMETRIC> struct Places {
  static constexpr int NUMBERS = 9, AT[3][3] = {{0, 3, 6}, {1, 4, 7}, {2, 5, 8}};
};
template<> struct Places<true> {
  static constexpr int NUMBERS = 6, AT[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
};

/// Four rows at a time.
template<bool SYMMETRIC> void times_narrow(const Group& group, const Float4* x, Float4* row) {
  for (int half = 0; half < FloatRows::GROUP; half += 4) {
    Float4 sum[4] = {Float4::all(0), Float4::all(0), Float4::all(0), Float4::all(0)};
    const auto gather = [&](const FloatRows::Slot& slot, Float4& px, Float4& py, Float4& pz) {
      const int* column = slot.column + half;
      Float4 unused;
      px = x[column[0]];
      py = x[column[1]];
      pz = x[column[2]];
      unused = x[column[3]];
      transpose(px, py, pz, unused);
    };
    Float4 px, py, pz;
    const Float8* v = group.value;
    for (const FloatRows::Slot* slot = group.slot; slot != group.slot_end;
         ++slot, v += Places<SYMMETRIC>::NUMBERS) {
      gather(*slot, px, py, pz);
      const auto number = [&](int r, int c) {
        return Float4::load(v[Places<SYMMETRIC>::AT[r][c]].lane + half);
      };
      for (int r = 0; r < 3; ++r)
        sum[r] = sum[r] + (number(r, 0) * px + number(r, 1) * py + number(r, 2) * pz);
    }
    v = group.isotropic_value;
    for (const FloatRows::Slot* slot = group.isotropic_slot; slot != group.isotropic_slot_end;
         ++slot, ++v) {
      gather(*slot, px, py, pz);
      const Float4 a = Float4::load(v->lane + half);
      sum[0] = sum[0] + a * px;
      sum[1] = sum[1] + a * py;
      sum[2] = sum[2] + a * pz;
    }
    transpose(sum[0], sum[1], sum[2], sum[3]);
    for (int i = 0; i < 4; ++i)
      row[half + i] = sum[i];
  }
}

#if defined(__x86_64__)
#define SLOPER_WIDE [[gnu::target("avx")]] inline

/// Two particles' vectors.
SLOPER_WIDE __m256 pair(Float4 low, Float4 high) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(low.v), high.v, 1);
}

/// x, y and z of eight particles: particle i's in lane i.
SLOPER_WIDE void gather_wide(const FloatRows::Slot& slot, const Float4* x, __m256& px, __m256& py,
                             __m256& pz) {
  const int* c = slot.column;
  const __m256 p0 = pair(x[c[0]], x[c[4]]), p1 = pair(x[c[1]], x[c[5]]),
               p2 = pair(x[c[2]], x[c[6]]), p3 = pair(x[c[3]], x[c[7]]);
  const __m256 xy01 = _mm256_unpacklo_ps(p0, p1), xy23 = _mm256_unpacklo_ps(p2, p3),
               z01 = _mm256_unpackhi_ps(p0, p1), z23 = _mm256_unpackhi_ps(p2, p3);
  px = _mm256_shuffle_ps(xy01, xy23, _MM_SHUFFLE(1, 0, 1, 0));
  py = _mm256_shuffle_ps(xy01, xy23, _MM_SHUFFLE(3, 2, 3, 2));
  pz = _mm256_shuffle_ps(z01, z23, _MM_SHUFFLE(1, 0, 1, 0));
}

/// Row r of eight blocks times their vectors. Product and sum apart, as elsewhere: fused ones would
/// round otherwise.
template<bool SYMMETRIC, int R>
SLOPER_WIDE __m256 row_wide(const Float8* v, __m256 px, __m256 py, __m256 pz) {
  constexpr const int* AT = Places<SYMMETRIC>::AT[R];
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(_mm256_load_ps(v[AT[0]].lane), px),
                                     _mm256_mul_ps(_mm256_load_ps(v[AT[1]].lane), py)),
                       _mm256_mul_ps(_mm256_load_ps(v[AT[2]].lane), pz));
}

/// Eight rows at a time.
template<bool SYMMETRIC>
SLOPER_WIDE void times_wide(const Group& group, const Float4* x, Float4* row) {
  __m256 sx = _mm256_setzero_ps(), sy = sx, sz = sx, px, py, pz;
  const Float8* v = group.value;
  for (const FloatRows::Slot* slot = group.slot; slot != group.slot_end;
       ++slot, v += Places<SYMMETRIC>::NUMBERS) {
    gather_wide(*slot, x, px, py, pz);
    sx = _mm256_add_ps(sx, row_wide<SYMMETRIC, 0>(v, px, py, pz));
    sy = _mm256_add_ps(sy, row_wide<SYMMETRIC, 1>(v, px, py, pz));
    sz = _mm256_add_ps(sz, row_wide<SYMMETRIC, 2>(v, px, py, pz));
  }
  v = group.isotropic_value;
  for (const FloatRows::Slot* slot = group.isotropic_slot; slot != group.isotropic_slot_end;
       ++slot, ++v) {
    gather_wide(*slot, x, px, py, pz);
    const __m256 a = _mm256_load_ps(v->lane);
    sx = _mm256_add_ps(sx, _mm256_mul_ps(a, px));
    sy = _mm256_add_ps(sy, _mm256_mul_ps(a, py));
    sz = _mm256_add_ps(sz, _mm256_mul_ps(a, pz));
  }
  const __m256 zero = _mm256_setzero_ps();
  const __m256 xy_low = _mm256_unpacklo_ps(sx, sy), xy_high = _mm256_unpackhi_ps(sx, sy),
               z_low = _mm256_unpacklo_ps(sz, zero), z_high = _mm256_unpackhi_ps(sz, zero);
  const __m256 rows[4] = {_mm256_shuffle_ps(xy_low, z_low, _MM_SHUFFLE(1, 0, 1, 0)),
                          _mm256_shuffle_ps(xy_low, z_low, _MM_SHUFFLE(3, 2, 3, 2)),
                          _mm256_shuffle_ps(xy_high, z_high, _MM_SHUFFLE(1, 0, 1, 0)),
                          _mm256_shuffle_ps(xy_high, z_high, _MM_SHUFFLE(3, 2, 3, 2))};
  for (int i = 0; i < 4; ++i) {
    row[i].v = _mm256_castps256_ps128(rows[i]);
    row[i + 4].v = _mm256_extractf128_ps(rows[i], 1);
  }
}

const bool HAS_WIDE = __builtin_cpu_supports("avx");
bool wide = HAS_WIDE;
#endif

} // namespace

void FloatRows::times(std::size_t g, const Float4* x, Float4* row) const {
  const Group group{m_column.data() + m_start[g],
                    m_column.data() + m_start[g + 1],
                    m_value.data() + m_numbers * m_start[g],
                    m_isotropic_column.data() + m_isotropic_start[g],
                    m_isotropic_column.data() + m_isotropic_start[g + 1],
                    m_isotropic_value.data() + m_isotropic_start[g]};
#if defined(__x86_64__)
  if (wide)
    return m_numbers == 9 ? times_wide<false>(group, x, row) : times_wide<true>(group, x, row);
#endif
  return m_numbers == 9 ? times_narrow<false>(group, x, row) : times_narrow<true>(group, x, row);
}

void FloatRows::allow_wide([[maybe_unused]] bool allowed) {
#if defined(__x86_64__)
  wide = allowed && HAS_WIDE;
#endif
}

Float4 to_float(const Vec3& v) {
  alignas(16) const float lanes[4] = {static_cast<float>(v.x()), static_cast<float>(v.y()),
                                      static_cast<float>(v.z()), 0};
  return Float4::load(lanes);
}

FloatBlock to_float(const Mat3& m) {
  return {{to_float(Vec3(m.col(0))), to_float(Vec3(m.col(1))), to_float(Vec3(m.col(2)))}};
}

Vec3 to_double(Float4 v) {
  alignas(16) float lanes[4];
  v.store(lanes);
  return {lanes[0], lanes[1], lanes[2]};
}

FloatRows to_float(const BlockRows& rows) {
  FloatRows out(rows.start, rows.column, {}, {}, false);
  parallel_for(static_cast<std::size_t>(rows.rows), ROW_GRAIN,
               [&](std::size_t begin, std::size_t end) {
                 for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
                   for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
                     out.put(i, k - rows.start[i], rows.value[k]);
               });
  return out;
}

/// How many blocks of row i of the whole matrix are not isotropic.
static int full_blocks(const BlockMatrix& m, int i) {
  return 1 + m.lower_start()[i + 1] - m.lower_start()[i] + m.row_start()[i + 1] - m.row_start()[i];
}

/// Calls put(k, column, block) for those, by rising column, k counting from 0.
template<class Put> static void visit_row(const BlockMatrix& m, int i, const Put& put) {
  int at = 0;
  for (int k = m.lower_start()[i]; k < m.lower_start()[i + 1]; ++k)
    put(at++, m.lower()[k].column, Mat3(m.value()[m.lower()[k].slot].transpose()));
  put(at++, i, m.diagonal(i));
  for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k)
    put(at++, m.column()[k], m.value()[k]);
}

/// Row i of `out`, whose rows' places are known.
static void expand_row(const BlockMatrix& m, int i, BlockRows& out) {
  const auto put = [&](int k, int column, const Mat3& value) {
    out.column[out.start[i] + k] = column;
    out.value[out.start[i] + k] = value;
  };
  visit_row(m, i, put);
  int at = full_blocks(m, i);
  for (int k = m.isotropic_start()[i]; k < m.isotropic_start()[i + 1]; ++k)
    put(at++, m.isotropic()[k].column,
        m.isotropic_value()[m.isotropic()[k].slot] * Mat3::Identity());
}

void expand(const BlockMatrix& m, BlockRows& out) {
  out.rows = out.columns = m.size();
  out.start.assign(m.size() + 1, 0);
  for (int i = 0; i < m.size(); ++i)
    out.start[i + 1] =
        out.start[i] + full_blocks(m, i) + m.isotropic_start()[i + 1] - m.isotropic_start()[i];
  out.column.resize(out.start.back());
  out.value.resize(out.start.back());
  parallel_for(static_cast<std::size_t>(m.size()), ROW_GRAIN,
               [&](std::size_t begin, std::size_t end) {
                 for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
                   expand_row(m, i, out);
               });
}

FloatRows to_float(const BlockMatrix& m) {
  std::vector<int> start(m.size() + 1, 0), column, isotropic_column;
  for (int i = 0; i < m.size(); ++i) {
    start[i + 1] = start[i] + full_blocks(m, i);
    visit_row(m, i, [&](int, int j, const Mat3&) { column.push_back(j); });
  }
  for (const BlockMatrix::Entry& e : m.isotropic())
    isotropic_column.push_back(e.column);
  FloatRows out(start, column, m.isotropic_start(), isotropic_column, m.all_symmetric());
  refill(m, out);
  return out;
}

void refill(const BlockMatrix& m, FloatRows& rows) {
  parallel_for(static_cast<std::size_t>(m.size()), ROW_GRAIN,
               [&](std::size_t begin, std::size_t end) {
                 for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
                   visit_row(m, i, [&](int k, int, const Mat3& value) { rows.put(i, k, value); });
                   const int first = m.isotropic_start()[i];
                   for (int k = first; k < m.isotropic_start()[i + 1]; ++k)
                     rows.put_isotropic(i, k - first, m.isotropic_value()[m.isotropic()[k].slot]);
                 }
               });
}

void transpose(const BlockRows& a, BlockRows& t) {
  t.rows = a.columns;
  t.columns = a.rows;
  t.start.assign(t.rows + 1, 0);
  for (int c : a.column)
    ++t.start[c + 1];
  for (int i = 0; i < t.rows; ++i)
    t.start[i + 1] += t.start[i];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<int> at(t.start.begin(), t.start.end() - 1);
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const int slot = at[a.column[k]]++;
      t.column[slot] = i;
      t.value[slot] = a.value[k].transpose();
    }
}

namespace {

/// A block of a row that is being summed up, by columns; the fourth number of each is 0.
struct alignas(32) PaddedBlock {
  double number[12] = {};
  double* column(int c) { return number + 4 * c; }
};

/// sum[at[l]] += a b[l] for each l below n.
void add_products_narrow(const Mat3& a, const Mat3* b, const std::vector<int>& at,
                         std::vector<PaddedBlock>& sum) {
  const bool isotropic = is_isotropic(a);
  for (std::size_t l = 0; l < at.size(); ++l) {
    Mat3 ab;
    if (isotropic)
      ab = a(0, 0) * b[l];
    else
      ab.noalias() = a * b[l];
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        sum[at[l]].number[4 * c + r] += ab(r, c);
  }
}

#if defined(__x86_64__)
constexpr int THIRD_LANE = 0b0100, FOURTH_LANE = 0b1000;

/// Three numbers; the fourth lane is 0. There must be a fourth number to read.
SLOPER_WIDE __m256d three_of(const double* v) {
  return _mm256_blend_pd(_mm256_loadu_pd(v), _mm256_setzero_pd(), FOURTH_LANE);
}

/// Likewise where there is no fourth number.
SLOPER_WIDE __m256d last_three_of(const double* v) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(v)), _mm_load_sd(v + 2), 1);
}

SLOPER_WIDE void add_to(double* sum, __m256d v) {
  _mm256_store_pd(sum, _mm256_add_pd(_mm256_load_pd(sum), v));
}

/// Gives the bits that Eigen gives: it adds the products of the first two rows from the left, and
/// the products of the third from the right.
SLOPER_WIDE void add_products_wide(const Mat3& a, const Mat3* b, const std::vector<int>& at,
                                   std::vector<PaddedBlock>& sum) {
  if (is_isotropic(a)) {
    const __m256d scale = _mm256_set1_pd(a(0, 0));
    for (std::size_t l = 0; l < at.size(); ++l) {
      const Mat3& from = b[l];
      PaddedBlock& block = sum[at[l]];
      add_to(block.column(0), _mm256_mul_pd(scale, three_of(from.col(0).data())));
      add_to(block.column(1), _mm256_mul_pd(scale, three_of(from.col(1).data())));
      add_to(block.column(2), _mm256_mul_pd(scale, last_three_of(from.col(2).data())));
    }
    return;
  }
  const __m256d x = three_of(a.col(0).data()), y = three_of(a.col(1).data()),
                z = last_three_of(a.col(2).data());
  for (std::size_t l = 0; l < at.size(); ++l) {
    const double* v = b[l].data();
    double* block = sum[at[l]].number;
    for (int c = 0; c < 3; ++c, v += 3, block += 4) {
      const __m256d px = _mm256_mul_pd(x, _mm256_broadcast_sd(v)),
                    py = _mm256_mul_pd(y, _mm256_broadcast_sd(v + 1)),
                    pz = _mm256_mul_pd(z, _mm256_broadcast_sd(v + 2));
      const __m256d upper = _mm256_add_pd(_mm256_add_pd(px, py), pz),
                    last = _mm256_add_pd(px, _mm256_add_pd(py, pz));
      add_to(block, _mm256_blend_pd(upper, last, THIRD_LANE));
    }
  }
}
#endif

void add_products(const Mat3& a, const Mat3* b, const std::vector<int>& at,
                  std::vector<PaddedBlock>& sum) {
#if defined(__x86_64__)
  if (wide)
    return add_products_wide(a, b, at, sum);
#endif
  add_products_narrow(a, b, at, sum);
}

/// Counts the blocks of rows begin to end - 1 of a b: counts[i + 1] of row i.
void count_product(const BlockRows& a, const BlockRows& b, std::size_t begin, std::size_t end,
                   std::vector<int>& counts) {
  std::vector<int> met_in(b.columns, -1);
  for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      for (int l = b.start[a.column[k]]; l < b.start[a.column[k] + 1]; ++l) {
        counts[i + 1] += met_in[b.column[l]] != i;
        met_in[b.column[l]] = i;
      }
}

/// Rows begin to end - 1 of c = a b, whose rows' places are known.
void fill_product(const BlockRows& a, const BlockRows& b, std::size_t begin, std::size_t end,
                  BlockRows& c) {
  std::vector<int> where(b.columns, -1), at;
  std::vector<PaddedBlock> sum;
  for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
    const int first = c.start[i];
    int next = first;
    sum.assign(c.start[i + 1] - first, {});
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const int row = a.column[k];
      at.clear();
      for (int l = b.start[row]; l < b.start[row + 1]; ++l) {
        int& place = where[b.column[l]];
        if (place < first) {
          place = next++;
          c.column[place] = b.column[l];
        }
        at.push_back(place - first);
      }
      add_products(a.value[k], b.value.data() + b.start[row], at, sum);
    }
    for (std::size_t k = 0; k < sum.size(); ++k)
      for (int column = 0; column < 3; ++column)
        for (int r = 0; r < 3; ++r)
          c.value[first + k](r, column) = sum[k].number[4 * column + r];
  }
}

} // namespace

void product(const BlockRows& a, const BlockRows& b, BlockRows& c) {
  c.rows = a.rows;
  c.columns = b.columns;
  c.start.assign(a.rows + 1, 0);
  const auto rows = static_cast<std::size_t>(a.rows);
  parallel_for(rows, ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    count_product(a, b, begin, end, c.start);
  });
  for (int i = 0; i < a.rows; ++i)
    c.start[i + 1] += c.start[i];
  c.column.resize(c.start.back());
  c.value.resize(c.start.back());
  parallel_for(rows, ROW_GRAIN,
               [&](std::size_t begin, std::size_t end) { fill_product(a, b, begin, end, c); });
}

std::vector<Mat3> block_diagonal(const BlockRows& a) {
  std::vector<Mat3> d(a.rows, Mat3::Zero());
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (a.column[k] == i)
        d[i] += a.value[k];
  return d;
}

#if defined(__x86_64__)
#undef SLOPER_WIDE
#endif

} // namespace sloper::cloth
