#pragma once
/// Four floats at once: the children of a tree node, or a column of a 3x3 block and one lane
/// unused. SSE2 where there is, plain C++ elsewhere, same results.
#if defined(__SSE2__)
#include <emmintrin.h>
#else
#include <cmath>
#endif
namespace sloper {

#if defined(__SSE2__)
/// Four lanes of float. Both implementations round alike, so results are the same bits.
struct Float4 {
  __m128 v;                                                       ///< lane 0 lowest
  static Float4 load(const float* p) { return {_mm_load_ps(p)}; } ///< p aligned to 16 bytes
  /// The same number in all lanes.
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  /// Writes four floats.
  /// @param p  aligned to 16 bytes
  void store(float* p) const { _mm_store_ps(p, v); }
};
/// Lane by lane.
inline Float4 operator+(Float4 a, Float4 b) {
  return {_mm_add_ps(a.v, b.v)};
}
inline Float4 operator-(Float4 a, Float4 b) {
  return {_mm_sub_ps(a.v, b.v)};
}
inline Float4 operator*(Float4 a, Float4 b) {
  return {_mm_mul_ps(a.v, b.v)};
}
inline Float4 operator/(Float4 a, Float4 b) {
  return {_mm_div_ps(a.v, b.v)};
}
/// Lane by lane; b where either is NaN.
inline Float4 max(Float4 a, Float4 b) {
  return {_mm_max_ps(a.v, b.v)};
}
/// Lane by lane; b where either is NaN.
inline Float4 min(Float4 a, Float4 b) {
  return {_mm_min_ps(a.v, b.v)};
}
/// Square roots, lane by lane.
inline Float4 square_root(Float4 a) {
  return {_mm_sqrt_ps(a.v)};
}
/// Lane I in all four lanes.
template<int I> Float4 lane(Float4 a) {
  return {_mm_shuffle_ps(a.v, a.v, _MM_SHUFFLE(I, I, I, I))};
}
/// a where b < c, else 0.
inline Float4 where_less(Float4 a, Float4 b, Float4 c) {
  return {_mm_and_ps(a.v, _mm_cmplt_ps(b.v, c.v))};
}
/// Absolute values, lane by lane.
inline Float4 absolute(Float4 a) {
  return max(a, {_mm_sub_ps(_mm_setzero_ps(), a.v)});
}
/// Four rows of four in, the columns out: x gets the first of each row.
inline void transpose(Float4& x, Float4& y, Float4& z, Float4& w) {
  _MM_TRANSPOSE4_PS(x.v, y.v, z.v, w.v);
}
/// Bit i is set where a_i <= b_i and c_i <= d_i.
inline int both_less_equal(Float4 a, Float4 b, Float4 c, Float4 d) {
  return _mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(a.v, b.v), _mm_cmple_ps(c.v, d.v)));
}
/// Bit i is set where a_i <= b_i.
inline int less_equal(Float4 a, Float4 b) {
  return _mm_movemask_ps(_mm_cmple_ps(a.v, b.v));
}
/// Bit i is set where a_i or b_i is x or y. @param a, b four each, aligned to 16 bytes
inline int either_is(const int* a, const int* b, int x, int y) {
  const __m128i u = _mm_load_si128(reinterpret_cast<const __m128i*>(a)),
                v = _mm_load_si128(reinterpret_cast<const __m128i*>(b));
  const __m128i xs = _mm_set1_epi32(x), ys = _mm_set1_epi32(y);
  const __m128i is_x = _mm_or_si128(_mm_cmpeq_epi32(u, xs), _mm_cmpeq_epi32(v, xs)),
                is_y = _mm_or_si128(_mm_cmpeq_epi32(u, ys), _mm_cmpeq_epi32(v, ys));
  return _mm_movemask_ps(_mm_castsi128_ps(_mm_or_si128(is_x, is_y)));
}
#else
struct Float4 {
  float v[4];
  static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
  static Float4 all(float x) { return {{x, x, x, x}}; }
  void store(float* p) const {
    for (int i = 0; i < 4; ++i)
      p[i] = v[i];
  }
};
inline Float4 operator+(Float4 a, Float4 b) {
  return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
inline Float4 operator-(Float4 a, Float4 b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}
inline Float4 operator*(Float4 a, Float4 b) {
  return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}};
}
inline Float4 operator/(Float4 a, Float4 b) {
  return {{a.v[0] / b.v[0], a.v[1] / b.v[1], a.v[2] / b.v[2], a.v[3] / b.v[3]}};
}
template<int I> Float4 lane(Float4 a) {
  return Float4::all(a.v[I]);
}
inline Float4 min(Float4 a, Float4 b) {
  Float4 r;
  for (int i = 0; i < 4; ++i)
    r.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
  return r;
}
inline Float4 square_root(Float4 a) {
  for (float& x : a.v)
    x = std::sqrt(x);
  return a;
}
inline Float4 where_less(Float4 a, Float4 b, Float4 c) {
  Float4 r;
  for (int i = 0; i < 4; ++i)
    r.v[i] = b.v[i] < c.v[i] ? a.v[i] : 0;
  return r;
}
inline Float4 absolute(Float4 a) {
  for (float& x : a.v)
    x = x < 0 ? -x : x;
  return a;
}
inline void transpose(Float4& x, Float4& y, Float4& z, Float4& w) {
  const Float4 row[4] = {x, y, z, w};
  Float4* column[4] = {&x, &y, &z, &w};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      column[i]->v[j] = row[j].v[i];
}
inline Float4 max(Float4 a, Float4 b) {
  Float4 r;
  for (int i = 0; i < 4; ++i)
    r.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
  return r;
}
inline int both_less_equal(Float4 a, Float4 b, Float4 c, Float4 d) {
  int mask = 0;
  for (int i = 0; i < 4; ++i)
    mask |= (a.v[i] <= b.v[i] && c.v[i] <= d.v[i]) << i;
  return mask;
}
inline int less_equal(Float4 a, Float4 b) {
  int mask = 0;
  for (int i = 0; i < 4; ++i)
    mask |= (a.v[i] <= b.v[i]) << i;
  return mask;
}
inline int either_is(const int* a, const int* b, int x, int y) {
  int mask = 0;
  for (int i = 0; i < 4; ++i)
    mask |= (a[i] == x || b[i] == x || a[i] == y || b[i] == y) << i;
  return mask;
}
#endif

} // namespace sloper
