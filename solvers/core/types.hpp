// Scalars, small vectors and cell indices, used by every solver. One source for 2D and 3D.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace weir {

using real = double;
inline constexpr real infinity = std::numeric_limits<real>::infinity();
inline constexpr real pi = 3.14159265358979323846;

/// A point or vector of D components [unit of the quantity]. Plain data: same layout in every translation unit.
template <int D>
struct Vec : std::array<real, D> {
    static Vec constant(real value) {
        Vec v;
        v.fill(value);
        return v;
    }
    static Vec unit(int axis) {
        Vec v{};
        v[static_cast<std::size_t>(axis)] = 1;
        return v;
    }
    real& operator[](int a) { return this->data()[a]; }
    const real& operator[](int a) const { return this->data()[a]; }
    real& operator[](std::size_t a) { return this->data()[a]; }
    const real& operator[](std::size_t a) const { return this->data()[a]; }
};

template <int D>
Vec<D> operator+(Vec<D> a, const Vec<D>& b) {
    for (int d = 0; d < D; ++d) a[d] += b[d];
    return a;
}
template <int D>
Vec<D> operator-(Vec<D> a, const Vec<D>& b) {
    for (int d = 0; d < D; ++d) a[d] -= b[d];
    return a;
}
template <int D>
Vec<D> operator-(Vec<D> a) {
    for (int d = 0; d < D; ++d) a[d] = -a[d];
    return a;
}
template <int D>
Vec<D> operator*(real s, Vec<D> a) {
    for (int d = 0; d < D; ++d) a[d] *= s;
    return a;
}
template <int D>
Vec<D> operator*(Vec<D> a, real s) {
    return s * a;
}
template <int D>
Vec<D> operator/(Vec<D> a, real s) {
    for (int d = 0; d < D; ++d) a[d] /= s;
    return a;
}
template <int D>
Vec<D>& operator+=(Vec<D>& a, const Vec<D>& b) {
    return a = a + b;
}
template <int D>
Vec<D>& operator-=(Vec<D>& a, const Vec<D>& b) {
    return a = a - b;
}
template <int D>
real dot(const Vec<D>& a, const Vec<D>& b) {
    real sum = 0;
    for (int d = 0; d < D; ++d) sum += a[d] * b[d];
    return sum;
}
template <int D>
real norm(const Vec<D>& a) {
    return std::sqrt(dot(a, a));
}

/// The index of a cell, or of the face on its lower side along an axis.
template <int D>
struct Index : std::array<int, D> {
    int& operator[](int a) { return this->data()[a]; }
    const int& operator[](int a) const { return this->data()[a]; }
    static Index constant(int value) {
        Index i;
        i.fill(value);
        return i;
    }
};

template <int D>
Index<D> operator+(Index<D> a, const Index<D>& b) {
    for (int d = 0; d < D; ++d) a[d] += b[d];
    return a;
}
template <int D>
Index<D> operator-(Index<D> a, const Index<D>& b) {
    for (int d = 0; d < D; ++d) a[d] -= b[d];
    return a;
}

/// Unit step along an axis: I + e<D>(a) is the next cell.
template <int D>
constexpr Index<D> e(int axis) {
    Index<D> i{};
    i.data()[axis] = 1;
    return i;
}

template <int D>
std::size_t product(const Index<D>& n) {
    std::size_t p = 1;
    for (int d = 0; d < D; ++d) p *= static_cast<std::size_t>(n[d]);
    return p;
}

template <int D>
Vec<D> to_vec(const Index<D>& i) {
    Vec<D> v;
    for (int d = 0; d < D; ++d) v[d] = i[d];
    return v;
}

}  // namespace weir
