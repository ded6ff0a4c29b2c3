#pragma once
/// Sparse matrices of 3x3 blocks, in double to build a preconditioner and in single precision to apply it.
#include <base/simd4.hpp>
#include <cloth/block_matrix.hpp>

namespace sloper::cloth {

/// Compressed rows of 3x3 blocks, both halves.
struct BlockRows {
  int rows = 0, columns = 0;
  std::vector<int> start, column;
  std::vector<Mat3> value;
};

/// A block by columns; the fourth lane of each is 0. Vectors are one Float4 a particle, the fourth lane unused.
struct FloatBlock {
  Float4 column[3];
};
inline Float4 operator*(const FloatBlock& a, Float4 x) { return a.column[0] * lane<0>(x) + a.column[1] * lane<1>(x) + a.column[2] * lane<2>(x); }

/// Blocks are packed, since reading them is what a product costs: the fourth lane of what a row gives is anything. Multiples of the
/// identity may be kept apart, as BlockMatrix does.
struct FloatRows {
  int rows = 0, columns = 0;
  std::vector<int> start, column;
  std::vector<float> value;                           ///< nine numbers a block, by columns, and room that the last one's read runs into
  std::vector<int> isotropic_start, isotropic_column; ///< rows + 1, or none
  std::vector<float> isotropic_value;                 ///< one number a block
  /// Row i of A x
  Float4 row_times(std::size_t i, const std::vector<Float4>& x) const {
    Float4 sum = Float4::all(0);
    const float* v = value.data() + 9 * static_cast<std::size_t>(start[i]);
    for (int k = start[i]; k < start[i + 1]; ++k, v += 9) {
      const Float4 p = x[column[k]];
      sum = sum + (Float4::load_any(v) * lane<0>(p) + Float4::load_any(v + 3) * lane<1>(p) + Float4::load_any(v + 6) * lane<2>(p));
    }
    if (isotropic_start.empty()) return sum;
    for (int k = isotropic_start[i]; k < isotropic_start[i + 1]; ++k) sum = sum + Float4::all(isotropic_value[k]) * x[isotropic_column[k]];
    return sum;
  }
  void put(int k, const Mat3& block) {
    for (int i = 0; i < 9; ++i) value[9 * static_cast<std::size_t>(k) + i] = static_cast<float>(block.data()[i]);
  }
  /// y = A x
  void multiply(const std::vector<Float4>& x, std::vector<Float4>& y) const;
  /// y += A x
  void multiply_add(const std::vector<Float4>& x, std::vector<Float4>& y) const;
};

Float4 to_float(const Vec3& v);
FloatBlock to_float(const Mat3& m);
Vec3 to_double(Float4 v);
FloatRows to_float(const BlockRows& rows);

/// The whole matrix of a symmetric one that keeps its upper triangle; isotropic blocks come last in a row.
BlockRows expand(const BlockMatrix& m);
/// The same in single precision, isotropic blocks apart.
FloatRows to_float(const BlockMatrix& m);
/// Writes the numbers of m into rows that to_float() made of the same pattern.
void refill(const BlockMatrix& m, FloatRows& rows);
BlockRows transpose(const BlockRows& a);
BlockRows product(const BlockRows& a, const BlockRows& b);
std::vector<Mat3> block_diagonal(const BlockRows& a);

} // namespace sloper::cloth
