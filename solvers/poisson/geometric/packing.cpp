#include "poisson/geometric/packing.hpp"

#include <cmath>

namespace weir::poisson {

namespace {

constexpr std::uint8_t is_fluid = 1;  // in rows of cells and of coarse flags
static_assert(static_cast<std::uint8_t>(Cell::fluid) == is_fluid);

/// All data of the faces of one natural row, towards both sides of each axis.
template <int D, class T>
struct RowView {
    std::array<const T*, 2 * D> weight;
    std::array<const std::uint8_t*, 2 * D> beside;
    const std::uint8_t* self;
    const T* zero;  // other couplings of the cells to p = 0, or nullptr
};

/// Buffers of one thread, grown as needed.
struct Buffers {
    std::vector<float> face, dinv;
    std::vector<std::uint8_t> flags, nothing;
    std::vector<float> no_face;
    void resize(int n) {
        const auto size = static_cast<std::size_t>(n) + 2;
        if (face.size() >= size) return;
        face.resize(size), dinv.resize(size), flags.resize(size);
        nothing.assign(size, 0), no_face.assign(size, 0);
    }
};

template <int D>
RowView<D, float> view(const Level<D>& level, int q, int j, Buffers& buffers) {
    const int n = level.at.n[0];
    const auto start = [&](int row) { return static_cast<std::ptrdiff_t>(row) * n; };
    const int here = level.at.row(q, j);
    RowView<D, float> v;
    v.zero = level.zero + start(here);
    const float* fx = level.face[0] + start(here);
    const std::uint8_t* fluid = level.fluid + start(here);
    const bool ring = level.at.periodic[0];
    std::copy(fx, fx + n, buffers.face.begin());
    buffers.face[static_cast<std::size_t>(n)] = ring ? fx[0] : 0;
    std::copy(fluid, fluid + n, buffers.flags.begin() + 1);
    buffers.flags[0] = ring ? fluid[n - 1] : 0;
    buffers.flags[static_cast<std::size_t>(n) + 1] = ring ? fluid[0] : 0;
    v.self = buffers.flags.data() + 1;
    v.weight[0] = buffers.face.data(), v.weight[1] = v.weight[0] + 1;
    v.beside[0] = v.self - 1, v.beside[1] = v.self + 1;
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const auto k = static_cast<std::size_t>(2 * a + side);
            const int other = level.at.neighbour(q, j, a, side);
            v.beside[k] = other < 0 ? buffers.nothing.data() : level.fluid + start(other);
            v.weight[k] = other < 0 ? buffers.no_face.data() : level.face[static_cast<std::size_t>(a)] + start(side == 0 ? here : other);
        }
    return v;
}

template <int D>
RowView<D, real> view(const Natural<D>& problem, int q, int j) {
    RowView<D, real> v;
    v.zero = problem.zero(problem.row(q, j));
    v.self = problem.cells(problem.row(q, j));
    v.beside[0] = v.self - 1, v.beside[1] = v.self + 1;
    v.weight[0] = problem.faces(0, q, j), v.weight[1] = v.weight[0] + 1;
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const auto k = static_cast<std::size_t>(2 * a + side);
            v.beside[k] = problem.cells(problem.neighbour(q, j, a, side));
            v.weight[k] = problem.faces(a, q + (a == D - 1 ? side : 0), j + (a == D - 1 ? 0 : side));
        }
    return v;
}

template <int D, class T>
bool is_plain(const Level<D>& level, const RowView<D, T>& v) {
    int different = 0;
    for (std::size_t k = 0; k < 2 * D; ++k) {
        const float plain = level.plain_weight[k / 2], slack = 1e-6f * plain;  // some roundings of float sums
        for (int i = 0; i < level.at.n[0]; ++i)
            different |=
                v.self[i] == is_fluid && v.beside[k][i] == is_fluid && std::abs(static_cast<float>(v.weight[k][i]) - plain) > slack;
    }
    return different == 0;
}

/// A black cell reads the weights of its red neighbours; beyond a side there is none, so the side's weight is stored in its place.
template <int D, class T>
void pack_sides(Level<D>& level, int q, int j, const RowView<D, T>& v) {
    const Layout<D>& at = level.at;
    const int row = at.row(q, j), n = at.n[0], s = at.parity(q, j);
    if (!at.periodic[0]) {
        if (s == 1) level.weight[1][at.offset(row) - 1] = static_cast<float>(v.weight[0][0]);
        if ((n - 1 + s) % 2 == 1) level.weight[0][at.offset(row) + (n - 1) / 2 + 1 - s] = static_cast<float>(v.weight[1][n - 1]);
    }
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            if (at.neighbour(q, j, a, side) >= 0) continue;
            const auto k = static_cast<std::size_t>(2 * a + side);
            float* to = level.weight[k ^ 1] + at.offset(at.side_row(q, j, a));
            for (int i = 1 - s; i < n; i += 2) to[i / 2] = static_cast<float>(v.weight[k][i]);
        }
}

template <int D, class T>
void pack_row(Level<D>& level, int q, int j, const RowView<D, T>& v, Buffers& buffers) {
    const Layout<D>& at = level.at;
    const int row = at.row(q, j), n = at.n[0];
    const auto s = static_cast<std::size_t>(at.parity(q, j));
    const std::ptrdiff_t own = at.offset(row);
    float* dinv = buffers.dinv.data();
    for (int i = 0; i < n; ++i) {
        T diagonal = v.zero != nullptr ? v.zero[i] : 0;
        for (std::size_t k = 0; k < 2 * D; ++k) diagonal += v.weight[k][i];
        dinv[i] = v.self[i] == is_fluid && diagonal > 0 ? static_cast<float>(1 / diagonal) : 0;
    }
    split(dinv, n, at.width, level.dinv[s] + own, level.dinv[1 - s] + own);
    if (level.has_zero) {
        for (int i = 0; i < n; ++i) dinv[i] = static_cast<float>(v.zero[i]);
        split(dinv, n, at.width, level.packed_zero[s] + own, level.packed_zero[1 - s] + own);
    }
    for (std::size_t k = 0; k < 2 * D; ++k) {
        float* to = level.weight[k] + own;
        if (s == 0)
            for (int m = 0; 2 * m < n; ++m) to[m] = static_cast<float>(v.weight[k][2 * m]);
        else
            for (int m = 0; m < at.width; ++m) to[m] = 2 * m + 1 < n ? static_cast<float>(v.weight[k][2 * m + 1]) : 0;
        if (k < 2) at.wrap(to);
    }
    pack_sides(level, q, j, v);
    level.plain[static_cast<std::size_t>(row)] = is_plain(level, v);
}

/// In parallel, over this rank's planes where it stores no others.
template <int D, class F>
void for_each_row(const Level<D>& level, bool threaded, F&& f) {
    const Layout<D>& at = level.at;
    const auto plane = [&](int q) {
        if (!level.owns(q)) return;
        thread_local Buffers buffers;
        buffers.resize(at.n[0]);
        for (int j = 0; j < at.rows_in_plane(); ++j) f(q, j, buffers);
    };
    if (threaded)
        parallel_for(0, at.planes(), plane);
    else
        for (int q = 0; q < at.planes(); ++q) plane(q);
}

/// Returns whether neither a row nor its neighbours contain fluid: then no sweep reads its weights.
template <int D>
bool is_far_from_fluid(const Level<D>& level, int q, int j) {
    bool far = level.is_dry(level.at.row(q, j));
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2 && far; ++side) {
            const int beside = level.at.neighbour(q, j, a, side);
            far = beside < 0 || level.is_dry(beside);
        }
    return far;
}

/// Weights and diagonals of all rows in use; view(q, j, buffers) returns a natural row.
template <int D, class View>
void pack_rows(Level<D>& level, bool threaded, const View& view_of) {
    level.plain.resize(static_cast<std::size_t>(level.at.rows()));
    for_each_row(level, threaded, [&](int q, int j, Buffers& buffers) {
        if (is_far_from_fluid(level, q, j))
            level.plain[static_cast<std::size_t>(level.at.row(q, j))] = 1;
        else
            pack_row(level, q, j, view_of(q, j, buffers), buffers);
    });
    if (level.held.empty()) return;
    std::vector<Planes> all;  // black cells read the weights of their red neighbours
    for (float* weight : level.weight) all.push_back(level.planes_of(weight));
    communicator().refresh(level.cut, all, 1, level.at.periodic[D - 1]);
}

/// Number of open faces of each cell of a row, packed: all faces that do not border a solid.
template <int D>
void count_row(Level<D>& level, const Natural<D>& problem, int q, int j, Buffers& buffers) {
    const Layout<D>& at = level.at;
    const int n = at.n[0];
    const std::uint8_t* c = problem.cells(problem.row(q, j));
    std::array<const std::uint8_t*, 2 * D> beside{c - 1, c + 1};
    for (int a = 1; a < D; ++a)
        for (int side = 0; side < 2; ++side)
            beside[static_cast<std::size_t>(2 * a + side)] = problem.cells(problem.neighbour(q, j, a, side));
    std::uint8_t* count = buffers.flags.data();
    for (int i = 0; i < n; ++i) {
        std::uint8_t open = 0;
        for (std::size_t k = 0; k < 2 * D; ++k) open = static_cast<std::uint8_t>(open + (beside[k][i] != 0));
        count[i] = c[i] == is_fluid ? open : std::uint8_t{0};
    }
    const auto s = static_cast<std::size_t>(at.parity(q, j));
    const std::ptrdiff_t own = at.offset(at.row(q, j));
    split(count, n, at.width, level.count[s] + own, level.count[1 - s] + own);
}

/// Spans of all rows, and zeros outside them.
template <int D, class Flags>
void find_spans(Level<D>& level, const Flags& flags) {
    const Layout<D>& at = level.at;
    level.span_start.assign(1, 0);
    level.spans.clear();
    level.work.assign(1, 0);
    for (int q = 0; q < at.planes(); ++q) {
        std::int64_t blocks = 0;
        if (!level.holds(q))
            level.span_start.insert(level.span_start.end(), static_cast<std::size_t>(at.rows_in_plane()), level.span_start.back());
        for (int j = 0; level.holds(q) && j < at.rows_in_plane(); ++j) {
            const std::uint8_t* c = flags(at.row(q, j));
            const auto first = static_cast<std::size_t>(level.span_start.back());
            for (int begin = 0; begin < at.width; begin += lanes) {
                int any = 0;
                for (int i = 2 * begin, end = std::min(at.n[0], 2 * (begin + lanes)); i < end; ++i) any |= c[i] == is_fluid;
                if (any == 0) continue;
                ++blocks;
                if (level.spans.size() > first && level.spans.back().end == begin)
                    level.spans.back().end += lanes;
                else
                    level.spans.push_back({begin, begin + lanes});
            }
            level.span_start.push_back(static_cast<int>(level.spans.size()));
        }
        level.work.push_back(level.work.back() + blocks);
    }
    for (float* u : level.u) clear_gaps(level, u);
}

}  // namespace

template <int D>
void clear_gaps(const Level<D>& level, float* vector) {
    const Layout<D>& at = level.at;
    for (int row = 0; row < at.rows(); ++row) {
        if (!level.holds(row / at.rows_in_plane())) continue;
        float* x = vector + at.offset(row);
        int from = 0;
        for (int k = level.span_start[static_cast<std::size_t>(row)]; k < level.span_start[static_cast<std::size_t>(row) + 1]; ++k) {
            const Span& span = level.spans[static_cast<std::size_t>(k)];
            if (span.begin > from) std::fill(x + from, x + span.begin, 0.0f);
            from = span.end;
        }
        if (from < at.width) std::fill(x + from, x + at.width, 0.0f);
    }
}

template <int D>
void pack_finest(Level<D>& level, const Natural<D>& problem) {
    find_spans(level, [&](int row) { return problem.cells(row); });
    if (level.by_count) {
        level.inverse.fill(0);
        for (std::size_t k = 1; k <= 2 * D; ++k) level.inverse[k] = 1 / (static_cast<float>(k) * level.plain_weight[0]);
        for_each_row(level, true, [&](int q, int j, Buffers& buffers) { count_row(level, problem, q, j, buffers); });
        return;
    }
    pack_rows(level, true, [&](int q, int j, Buffers&) { return view(problem, q, j); });
}

template <int D>
void pack_coarse(Level<D>& level, bool threaded) {
    find_spans(level, [&](int row) { return level.fluid + static_cast<std::ptrdiff_t>(row) * level.at.n[0]; });
    pack_rows(level, threaded, [&](int q, int j, Buffers& buffers) { return view(level, q, j, buffers); });
}

template void clear_gaps<2>(const Level<2>&, float*);
template void clear_gaps<3>(const Level<3>&, float*);
template void pack_finest<2>(Level<2>&, const Natural<2>&);
template void pack_finest<3>(Level<3>&, const Natural<3>&);
template void pack_coarse<2>(Level<2>&, bool);
template void pack_coarse<3>(Level<3>&, bool);

}  // namespace weir::poisson
