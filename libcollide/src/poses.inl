// Included by poses.cpp for each instruction set. Nothing of a header is called.

using Four [[gnu::vector_size(32)]] = double;
using Fours [[gnu::vector_size(32)]] = std::int64_t;
using FourFloats [[gnu::vector_size(16)]] = float;

/// Four numbers from any place on.
inline Four load(const double* from) {
  Four out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
inline void store(double* to, const Four& from) { __builtin_memcpy(to, &from, sizeof from); }
inline Four size_of(const Four& x) {
  return reinterpret_cast<Four>(reinterpret_cast<Fours>(x) & 0x7fffffffffffffff);
}
inline Four sum(const Four* rows, const double* by) {
  return rows[0] * by[0] + rows[1] * by[1] + rows[2] * by[2];
}

/// Rows of a matrix from its columns.
struct Rows {
  Four row[3];
};
inline void transpose(const Four& x, const Four& y, const Four& z, Rows& out) {
  const Four low = __builtin_shufflevector(x, y, 0, 4, 2, 6),
             high = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  out.row[0] = __builtin_shufflevector(low, z, 0, 1, 4, 4);
  out.row[1] = __builtin_shufflevector(high, z, 0, 1, 5, 5);
  out.row[2] = __builtin_shufflevector(low, z, 2, 3, 6, 6);
}
/// Of a matrix and a vector behind it, twelve numbers in all.
inline void rows_of(const double* pose, Rows& out) {
  transpose(load(pose), load(pose + 3), load(pose + 6), out);
}
void rotation_defect(const double* pose, double most, RotationDefect& out) {
  Rows m;
  rows_of(pose, m);
  Four same{}, other{};
  for (int k = 0; k < 3; ++k) {
    const Four next = __builtin_shufflevector(m.row[k], m.row[k], 1, 2, 0, 0);
    same = k == 0 ? m.row[k] * m.row[k] : same + m.row[k] * m.row[k];
    other = k == 0 ? m.row[k] * next : other + m.row[k] * next;
  }
  same -= 1.0;
  const Four squares = same * same + 2.0 * (other * other);
  out.square = squares[0] + squares[1] + squares[2];
  const Fours small = (size_of(same) < most) & (size_of(other) < most);
  const Four p = __builtin_shufflevector(m.row[1], m.row[1], 1, 2, 0, 0),
             q = __builtin_shufflevector(m.row[2], m.row[2], 2, 0, 1, 1),
             r = __builtin_shufflevector(m.row[1], m.row[1], 2, 0, 1, 1),
             s = __builtin_shufflevector(m.row[2], m.row[2], 1, 2, 0, 0);
  const Four volume = m.row[0] * (p * q - r * s);
  out.is_rotation = (small[0] & small[1] & small[2]) != 0 && volume[0] + volume[1] + volume[2] > 0;
}

void relate(const double* first, const double* second, Relation& out) {
  Rows m;
  rows_of(first, m);
  for (int j = 0; j < 3; ++j) store(out.turn[j], sum(m.row, second + 3 * j));
  // Number by number: what has just been stored so is at hand so.
  const double between[3] = {second[9] - first[9], second[10] - first[10], second[11] - first[11]};
  store(out.way, sum(m.row, between));
}

void move_box(const Relation& relation, const double* center, const double* half, double far,
              double error, MovedBox& out) {
  const Four x = load(relation.turn[0]), y = load(relation.turn[1]), z = load(relation.turn[2]);
  const Four at = x * center[0] + y * center[1] + z * center[2] + load(relation.way);
  const Four wide = size_of(x) * half[0] + size_of(y) * half[1] + size_of(z) * half[2];
  const Four reach = (wide + far) * (1 + 0x1p-26) + error;
  const Four low = at - reach, high = at + reach;
  store(out.center, at);
  // Rounded outwards.
  const FourFloats from =
                       __builtin_convertvector(low - (0x1p-22 * size_of(low) + 1e-37), FourFloats),
                   to = __builtin_convertvector(high + (0x1p-22 * size_of(high) + 1e-37),
                                                FourFloats);
  __builtin_memcpy(out.box.low, &from, sizeof from);
  __builtin_memcpy(out.box.high, &to, sizeof to);
}

void see(const Relation& relation, const double* axes, const double* center, const double* point,
         const Halves& half, FloatRelation& out) {
  Rows m;
  const Four last = load(axes + 5);
  transpose(load(axes), load(axes + 3), __builtin_shufflevector(last, last, 1, 2, 3, 3), m);
  Four wide{};
  for (int j = 0; j < 3; ++j) {
    const Four column = sum(m.row, relation.turn[j]);
    wide += size_of(column) * half.other[j];
    const FourFloats floats = __builtin_convertvector(column, FourFloats);
    __builtin_memcpy(out.turn[j], &floats, sizeof floats);
  }
  const double to[3] = {point[0] - center[0], point[1] - center[1], point[2] - center[2]};
  const Four way = sum(m.row, to), sizes = size_of(way);
  const FourFloats floats = __builtin_convertvector(way, FourFloats);
  __builtin_memcpy(out.way, &floats, sizeof floats);
  out.size = sizes[0] + sizes[1] + sizes[2];
  const Four gap = sizes - wide;
  const double x = gap[0] - half.own[0], y = gap[1] - half.own[1], z = gap[2] - half.own[2];
  const double most = x > y ? x : y;
  out.apart = most > z ? most : z;
}
