// Sources of the faces of a natural row: a coarse level stores them, the finest computes them from cells and weights.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/geometric/natural.hpp"

namespace weir::poisson {

/// Buffers of one thread for the rows computed on the finest level.
template <int D>
struct RowBuffers {
    std::array<std::vector<float>, D + 1> row;
    std::vector<std::uint8_t> fluid;
    void resize(int n) {
        for (auto& r : row) r.resize(static_cast<std::size_t>(n) + 1);
        fluid.resize(static_cast<std::size_t>(n) + 1);
    }
};

/// Rows of a coarse level.
template <int D>
struct StoredRows {
    const Level<D>& level;
    FaceRow<D> operator()(int q, int j, RowBuffers<D>&) const {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(level.at.row(q, j)) * level.at.n[0];
        FaceRow<D> out;
        for (std::size_t a = 0; a < D; ++a) out.face[a] = level.face[a] + at;
        out.zero = level.zero + at;
        out.fluid = level.fluid + at;
        return out;
    }
};

/// Rows of the finest level.
template <int D>
struct DerivedRows {
    const Natural<D>& problem;

    FaceRow<D> operator()(int q, int j, RowBuffers<D>& to) const {
        const int n = problem.extent()[0];
        to.resize(n);
        const std::uint8_t* c = problem.cells(problem.row(q, j));
        if (problem.weighted() && problem.is_amid_fluid(q, j)) return with_zero(q, j, c, amid_fluid(q, j, c, to), to);
        float* zero = to.row[D].data();
        std::uint8_t* is_fluid = to.fluid.data();
        for (int i = 0; i < n; ++i) {
            is_fluid[i] = c[i] == fluid;
            zero[i] = 0;
        }
        for (int a = 0; a < D; ++a) {
            add_side(q, j, a, 0, c, to.row[static_cast<std::size_t>(a)].data(), zero);
            add_side(q, j, a, 1, c, nullptr, zero);
        }
        FaceRow<D> out;
        for (std::size_t a = 0; a < D; ++a) out.face[a] = to.row[a].data();
        out.zero = zero;
        out.fluid = is_fluid;
        return with_zero(q, j, c, out, to);
    }

private:
    /// Adds the problem's further couplings to p = 0.
    FaceRow<D> with_zero(int q, int j, const std::uint8_t* c, const FaceRow<D>& row, RowBuffers<D>& to) const {
        const real* more = problem.zero(problem.row(q, j));
        float* zero = to.row[D].data();
        for (int i = 0; more && i < problem.extent()[0]; ++i) zero[i] += c[i] == fluid ? static_cast<float>(more[i]) : 0.0f;
        return row;
    }
    /// With fluid on all sides only the ends of the row may couple to anything else.
    FaceRow<D> amid_fluid(int q, int j, const std::uint8_t* c, RowBuffers<D>& to) const {
        const int n = problem.extent()[0];
        FaceRow<D> out;
        for (int a = 0; a < D; ++a) {
            const real* w = problem.faces(a, q, j);
            float* face = to.row[static_cast<std::size_t>(a)].data();
            for (int i = 0; i < n; ++i) face[i] = static_cast<float>(w[i]);
            out.face[static_cast<std::size_t>(a)] = face;
        }
        float *first = to.row[0].data(), *zero = to.row[D].data();
        const real* w = problem.faces(0, q, j);
        std::fill_n(zero, n, 0.0f);
        std::fill_n(to.fluid.data(), n, std::uint8_t{1});
        if (c[-1] != fluid) first[0] = 0;
        if (c[-1] == air) zero[0] += static_cast<float>(w[0]);
        if (c[n] == air) zero[n - 1] += static_cast<float>(w[n]);
        out.zero = zero, out.fluid = to.fluid.data();
        return out;
    }

    static constexpr auto fluid = static_cast<std::uint8_t>(Cell::fluid), air = static_cast<std::uint8_t>(Cell::air);

    /// Weights of the faces towards one side: fluid neighbours are written to `face` (if not nullptr), air is added to `zero`.
    void add_side(int q, int j, int a, int side, const std::uint8_t* c, float* face, float* zero) const {
        const int n = problem.extent()[0];
        const std::uint8_t* other = a == 0 ? c + (side == 0 ? -1 : 1) : problem.cells(problem.neighbour(q, j, a, side));
        if (!problem.weighted()) {
            const auto w = static_cast<float>(problem.axis_weight()[a]);
            for (int i = 0; i < n; ++i) zero[i] += c[i] == fluid && other[i] == air ? w : 0.0f;
            if (face != nullptr)
                for (int i = 0; i < n; ++i) face[i] = c[i] == fluid && other[i] == fluid ? w : 0.0f;
            return;
        }
        const bool next = side == 1;
        const real* w = problem.faces(a, q + (a == D - 1 && next), j + (a > 0 && a != D - 1 && next)) + (a == 0 && next ? 1 : 0);
        for (int i = 0; i < n; ++i) zero[i] += c[i] == fluid && other[i] == air ? static_cast<float>(w[i]) : 0.0f;
        if (face != nullptr)
            for (int i = 0; i < n; ++i) face[i] = c[i] == fluid && other[i] == fluid ? static_cast<float>(w[i]) : 0.0f;
    }
};

}  // namespace weir::poisson
