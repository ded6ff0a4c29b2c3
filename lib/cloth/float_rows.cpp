#include <base/parallel.hpp>
#include <cloth/float_rows.hpp>

namespace sloper::cloth {

void FloatRows::multiply(const std::vector<Float4>& x, std::vector<Float4>& y) const {
  parallel_for(static_cast<std::size_t>(rows), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = row_times(i, x);
  });
}

void FloatRows::multiply_add(const std::vector<Float4>& x, std::vector<Float4>& y) const {
  parallel_for(static_cast<std::size_t>(rows), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = y[i] + row_times(i, x);
  });
}

Float4 to_float(const Vec3& v) {
  alignas(16) const float lanes[4] = {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
  return Float4::load(lanes);
}

FloatBlock to_float(const Mat3& m) { return {{to_float(Vec3(m.col(0))), to_float(Vec3(m.col(1))), to_float(Vec3(m.col(2)))}}; }

Vec3 to_double(Float4 v) {
  alignas(16) float lanes[4];
  v.store(lanes);
  return {lanes[0], lanes[1], lanes[2]};
}

FloatRows to_float(const BlockRows& rows) {
  FloatRows out{rows.rows, rows.columns, rows.start, rows.column, {}, {}, {}, {}};
  out.value.assign(9 * rows.value.size() + 3, 0);
  for (std::size_t k = 0; k < rows.value.size(); ++k) out.put(static_cast<int>(k), rows.value[k]);
  return out;
}

/// How many blocks of row i of the whole matrix are not isotropic.
static int full_blocks(const BlockMatrix& m, int i) { return 1 + m.lower_start()[i + 1] - m.lower_start()[i] + m.row_start()[i + 1] - m.row_start()[i]; }

/// Calls put(k, column, block) for those, by rising column, k counting from `at`.
template<class Put> static void visit_row(const BlockMatrix& m, int i, int at, const Put& put) {
  for (int k = m.lower_start()[i]; k < m.lower_start()[i + 1]; ++k) put(at++, m.lower()[k].column, Mat3(m.value()[m.lower()[k].slot].transpose()));
  put(at++, i, m.diagonal(i));
  for (int k = m.row_start()[i]; k < m.row_start()[i + 1]; ++k) put(at++, m.column()[k], m.value()[k]);
}

BlockRows expand(const BlockMatrix& m) {
  BlockRows out;
  out.rows = out.columns = m.size();
  out.start.assign(m.size() + 1, 0);
  for (int i = 0; i < m.size(); ++i) out.start[i + 1] = out.start[i] + full_blocks(m, i) + m.isotropic_start()[i + 1] - m.isotropic_start()[i];
  out.column.resize(out.start.back());
  out.value.resize(out.start.back());
  const auto put = [&](int k, int column, const Mat3& value) {
    out.column[k] = column;
    out.value[k] = value;
  };
  for (int i = 0; i < m.size(); ++i) {
    visit_row(m, i, out.start[i], put);
    int at = out.start[i] + full_blocks(m, i);
    for (int k = m.isotropic_start()[i]; k < m.isotropic_start()[i + 1]; ++k)
      put(at++, m.isotropic()[k].column, m.isotropic_value()[m.isotropic()[k].slot] * Mat3::Identity());
  }
  return out;
}

FloatRows to_float(const BlockMatrix& m) {
  FloatRows out;
  out.rows = out.columns = m.size();
  out.start.assign(m.size() + 1, 0);
  for (int i = 0; i < m.size(); ++i) out.start[i + 1] = out.start[i] + full_blocks(m, i);
  out.column.resize(out.start.back());
  out.value.assign(9 * static_cast<std::size_t>(out.start.back()) + 3, 0);
  for (int i = 0; i < m.size(); ++i) visit_row(m, i, out.start[i], [&](int k, int column, const Mat3&) { out.column[k] = column; });
  out.isotropic_start = m.isotropic_start();
  for (const BlockMatrix::Entry& e : m.isotropic()) out.isotropic_column.push_back(e.column);
  out.isotropic_value.resize(out.isotropic_column.size());
  refill(m, out);
  return out;
}

void refill(const BlockMatrix& m, FloatRows& rows) {
  parallel_for(static_cast<std::size_t>(m.size()), ROW_GRAIN, [&](std::size_t begin, std::size_t end) {
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
      visit_row(m, i, rows.start[i], [&](int k, int, const Mat3& value) { rows.put(k, value); });
      for (int k = m.isotropic_start()[i]; k < m.isotropic_start()[i + 1]; ++k)
        rows.isotropic_value[k] = static_cast<float>(m.isotropic_value()[m.isotropic()[k].slot]);
    }
  });
}

BlockRows transpose(const BlockRows& a) {
  BlockRows t;
  t.rows = a.columns;
  t.columns = a.rows;
  t.start.assign(t.rows + 1, 0);
  for (int c : a.column) ++t.start[c + 1];
  for (int i = 0; i < t.rows; ++i) t.start[i + 1] += t.start[i];
  t.column.resize(a.column.size());
  t.value.resize(a.value.size());
  std::vector<int> at(t.start.begin(), t.start.end() - 1);
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const int slot = at[a.column[k]]++;
      t.column[slot] = i;
      t.value[slot] = a.value[k].transpose();
    }
  return t;
}

BlockRows product(const BlockRows& a, const BlockRows& b) {
  BlockRows c;
  c.rows = a.rows;
  c.columns = b.columns;
  c.start.assign(1, 0);
  std::vector<int> where(b.columns, -1);
  for (int i = 0; i < a.rows; ++i) {
    const int begin = static_cast<int>(c.column.size());
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      for (int l = b.start[a.column[k]]; l < b.start[a.column[k] + 1]; ++l) {
        const int j = b.column[l];
        if (where[j] < begin) {
          where[j] = static_cast<int>(c.column.size());
          c.column.push_back(j);
          c.value.push_back(Mat3::Zero());
        }
        c.value[where[j]].noalias() += a.value[k] * b.value[l];
      }
    c.start.push_back(static_cast<int>(c.column.size()));
  }
  return c;
}

std::vector<Mat3> block_diagonal(const BlockRows& a) {
  std::vector<Mat3> d(a.rows, Mat3::Zero());
  for (int i = 0; i < a.rows; ++i)
    for (int k = a.start[i]; k < a.start[i + 1]; ++k)
      if (a.column[k] == i) d[i] += a.value[k];
  return d;
}

} // namespace sloper::cloth
