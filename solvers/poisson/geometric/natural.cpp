#include "poisson/geometric/natural.hpp"

#include "core/scratch.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace weir::poisson {

namespace {
constexpr auto solid = static_cast<std::uint8_t>(Cell::solid), fluid = static_cast<std::uint8_t>(Cell::fluid),
               air = static_cast<std::uint8_t>(Cell::air);
}

template <int D>
void Natural<D>::build(const Operator<D>& A, const OwnPlanes& own, const Grid<real, D>* zero) {
    n_ = A.cells.extent();
    zero_ = zero;
    axis_weight_ = A.axis_weight;
    const bool cubic = std::all_of(axis_weight_.begin(), axis_weight_.end(), [&](real w) { return w == axis_weight_[0]; });
    weighted_ = !A.weight[0].empty() || !cubic;
    for (int a = 0; a < D; ++a) periodic_[static_cast<std::size_t>(a)] = A.periodic[static_cast<std::size_t>(a)] && n_[a] > 1;
    own_ = own;
    planes_ = {own_.lower(0), own_.upper(planes())};
    copy_cells(A);
    count_faces();
    clean_faces(A);
    find_runs();
    find_closed();
}

template <int D>
int Natural<D>::neighbour(int q, int j, int a, int side) const {
    int& moved = a == D - 1 ? q : j;
    moved += side == 0 ? -1 : 1;
    if (moved >= 0 && moved < n_[a]) return row(q, j);
    if (!periodic_[static_cast<std::size_t>(a)]) return -1;
    moved = moved < 0 ? n_[a] - 1 : 0;
    return row(q, j);
}

/// Beyond a side p = 0, where face weights define its open fraction; otherwise a wall.
template <int D>
void Natural<D>::copy_cells(const Operator<D>& A) {
    const int nx = n_[0], rows = planes() * rows_in_plane();
    const std::uint8_t outside = weighted_ ? air : solid;
    const auto row_entries = static_cast<std::size_t>(nx + 2);
    cells_.resize(own_.slab, row_entries, row_entries * static_cast<std::size_t>(rows_in_plane()), planes(), 0);
    std::fill_n(cells_.data(), row_entries, outside);
    wet_.resize(static_cast<std::size_t>(rows));
    const Cell* from = A.cells.data();
    parallel_for(0, rows, [&](int r) {
        if (!cells_.holds(r / rows_in_plane())) return;
        auto* to = cells_.data() + 1 + static_cast<std::ptrdiff_t>(r + 1) * (nx + 2);
        std::memcpy(to, from + static_cast<std::ptrdiff_t>(r) * nx, static_cast<std::size_t>(nx));
        to[-1] = periodic_[0] ? to[nx - 1] : outside;
        to[nx] = periodic_[0] ? to[0] : outside;
        int any = 0, all = 1;
        for (int i = 0; i < nx; ++i) any |= to[i] == fluid, all &= to[i] == fluid;
        wet_[static_cast<std::size_t>(r)] = all != 0 ? full : any != 0 ? some : dry;
    });
}

template <int D>
void Natural<D>::count_faces() {
    const auto plane = static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(rows_in_plane());
    if (weighted_)
        count_ = {};
    else
        count_.resize(own_.slab, 0, plane, planes(), 0);
    parallel_for(planes_.begin, weighted_ ? planes_.begin : planes_.end, [&](int q) {
        for (int j = 0; j < rows_in_plane(); ++j) {
            const std::uint8_t* c = cells(row(q, j));
            std::array<const std::uint8_t*, 2 * D> beside{c - 1, c + 1};
            for (int a = 1; a < D; ++a)
                for (int side = 0; side < 2; ++side) beside[static_cast<std::size_t>(2 * a + side)] = cells(neighbour(q, j, a, side));
            std::uint8_t* to = count_.data() + static_cast<std::ptrdiff_t>(row(q, j)) * n_[0];
            for (int i = 0; i < n_[0]; ++i) {
                std::uint8_t open = 0;
                for (std::size_t k = 0; k < 2 * D; ++k) open = static_cast<std::uint8_t>(open + (beside[k][i] != solid));
                to[i] = c[i] == fluid ? open : std::uint8_t{0};
            }
        }
    });
}

template <int D>
void Natural<D>::clean_faces(const Operator<D>& A) {
    for (int a = 0; a < D; ++a) {
        auto& clean = faces_[static_cast<std::size_t>(a)];
        if (!weighted_) {
            clean = {};
            continue;
        }
        const auto& given = A.weight[static_cast<std::size_t>(a)];
        const bool self = A.periodic[static_cast<std::size_t>(a)] && n_[a] == 1;
        const bool ring = periodic_[static_cast<std::size_t>(a)];
        const real scale = self ? 0 : axis_weight_[a];
        const int planes_of_faces = n_[D - 1] + (a == D - 1 ? 1 : 0), rows_of_faces = D == 2 ? 1 : n_[1] + (a == 1 ? 1 : 0);
        const int entries = n_[0] + (a == 0 ? 1 : 0);
        clean.resize(own_.slab, 0, static_cast<std::size_t>(entries) * static_cast<std::size_t>(rows_of_faces), planes_of_faces, 0);
        parallel_for(planes_.begin, planes_.end + (a == D - 1 ? 1 : 0), [&](int q) {
            for (int j = 0; j < rows_of_faces; ++j) {
                const int t = a == D - 1 ? q : j;  // index of the face along a > 0
                const bool last = a > 0 && t == n_[a];
                const int q_low = q - (a == D - 1), j_low = j - (a > 0 && a != D - 1);
                const int up_row = !last ? row(q, j) : neighbour(q_low, j_low, a, 1);
                const int low_row = t > 0 ? row(q_low, j_low) : neighbour(q, j, a, 0);
                if (!is_wet(up_row) && !is_wet(a == 0 ? up_row : low_row)) continue;  // these faces are not used
                const std::uint8_t *up = cells(up_row), *low = a == 0 ? up - 1 : cells(low_row);
                const bool wraps = last && ring;
                const real* w =
                    given.empty() ? nullptr : given.data() + face_offset(a, wraps && a == D - 1 ? 0 : q, wraps && a != D - 1 ? 0 : j);
                real* to = clean.data() + face_offset(a, q, j);
                if (a > 0 && w != nullptr && is_full(up_row) && is_full(low_row)) {
                    for (int i = 0; i < entries; ++i) to[i] = scale * w[i];
                    continue;
                }
                for (int i = 0; i < entries; ++i) {
                    const bool open = (up[i] == fluid && low[i] != solid) || (low[i] == fluid && up[i] != solid);
                    const bool side = a == 0 ? !ring && (i == 0 || i == n_[0]) : up_row < 0 || low_row < 0;
                    const real given_weight = w != nullptr ? w[i] : side ? 0 : 1;
                    to[i] = open ? scale * given_weight : 0;
                }
                if (a == 0 && ring) to[n_[0]] = to[0];
            }
        });
    }
}

template <int D>
void Natural<D>::find_runs() {
    run_start_.assign(1, 0);
    runs_.clear();
    fluid_cells_ = 0;
    for (int q = planes_.begin; q < planes_.end; ++q)
        for (int j = 0; j < rows_in_plane(); ++j) {
            const auto* c = cells(row(q, j));
            const real* w = weighted_ ? faces(0, q, j) : nullptr;
            for (int i = 0; i < n_[0];) {
                const auto* at = static_cast<const std::uint8_t*>(std::memchr(c + i, fluid, static_cast<std::size_t>(n_[0] - i)));
                if (at == nullptr) break;
                const int begin = static_cast<int>(at - c);
                for (i = begin + 1; i < n_[0] && c[i] == fluid && (w == nullptr || w[i] > 0);) ++i;
                runs_.push_back({begin, i, 0});
                fluid_cells_ += i - begin;
            }
            run_start_.push_back(static_cast<int>(runs_.size()));
        }
    if (own_.distributed()) gather_runs();
    refill_scratch<real>(sum_, runs_.size(), 0);
}

/// In parallel, those of all ranks: there are few per row.
template <int D>
void Natural<D>::gather_runs() {
    const Partition& cut = own_.partition();
    const auto rows = static_cast<std::size_t>(planes() * rows_in_plane());
    std::vector<int> count(rows);
    const auto first = static_cast<std::size_t>(planes_.begin * rows_in_plane());
    for (std::size_t r = 0; r + 1 < run_start_.size(); ++r) count[first + r] = run_start_[r + 1] - run_start_[r];
    communicator().gather(cut, {count.data(), sizeof(int) * static_cast<std::size_t>(rows_in_plane()), planes()});
    run_start_.assign(1, 0);
    for (const int n : count) run_start_.push_back(run_start_.back() + n);
    const std::vector<Run> own = std::move(runs_);
    runs_.assign(static_cast<std::size_t>(run_start_.back()), Run{});
    std::copy(own.begin(), own.end(), runs_.begin() + run_start_[first]);
    gather_by_runs(runs_.data());
    fluid_cells_ = 0;
    for (const Run& run : runs_) fluid_cells_ += run.end - run.begin;
}

/// Union-find over runs of adjacent rows that share an open face; components without a face to p = 0 are closed.
template <int D>
void Natural<D>::find_closed() {
    std::vector<int>& parent = root_;
    resize_scratch(parent, runs_.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int i) {
        while (parent[static_cast<std::size_t>(i)] != i)
            i = parent[static_cast<std::size_t>(i)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
        return i;
    };
    std::vector<std::array<int, 2>> joined;  // in parallel, pairs found by this rank
    const auto join_runs = [&](int a, int b) {
        const int i = root(a), k = root(b);
        parent[static_cast<std::size_t>(std::max(i, k))] = std::min(i, k);
        return i != k;
    };
    const auto join = [&](const Run* a, const Run* b) {
        const auto i = static_cast<int>(a - runs_.data()), k = static_cast<int>(b - runs_.data());
        if (join_runs(i, k) && own_.distributed()) joined.push_back({i, k});
    };
    for (int q = planes_.begin; q < planes_.end; ++q)
        for (int j = 0; j < rows_in_plane(); ++j) {
            const int here = row(q, j);
            if (periodic_[0] && runs_begin(here) != runs_end(here)) {
                const Run *first = runs_begin(here), *last = runs_end(here) - 1;
                if (first->begin == 0 && last->end == n_[0] && (!weighted_ || faces(0, q, j)[0] > 0)) join(first, last);
            }
            for (int a = 1; a < D; ++a) {
                const int below = neighbour(q, j, a, 0);
                if (below < 0) continue;
                const real* w = weighted_ ? faces(a, q, j) : nullptr;
                const Run *x = runs_begin(here), *y = runs_begin(below);
                while (x != runs_end(here) && y != runs_end(below)) {
                    int i = std::max(x->begin, y->begin);
                    const int end = std::min(x->end, y->end);
                    if (w != nullptr)
                        while (i < end && !(w[i] > 0)) ++i;
                    if (i < end) join(x, y);
                    (x->end < y->end ? x : y)++;
                }
            }
        }
    if (own_.distributed())
        for (const auto& [i, k] : of_all_ranks(joined)) join_runs(i, k);
    for (std::size_t k = 0; k < parent.size(); ++k) parent[k] = root(static_cast<int>(k));
    mark_open();
    if (own_.distributed()) gather_open();
    refill_scratch(number_, runs_.size(), -1);
    closed_ = 0;
    for (std::size_t k = 0; k < runs_.size(); ++k)
        if (parent[k] == static_cast<int>(k) && !open_[k]) number_[k] = closed_++;
    refill_scratch<real>(size_, static_cast<std::size_t>(closed_), 0);
    refill_scratch<real>(mean_, static_cast<std::size_t>(closed_), 0);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
        runs_[k].component = number_[static_cast<std::size_t>(parent[k])];
        if (runs_[k].component >= 0) size_[static_cast<std::size_t>(runs_[k].component)] += runs_[k].end - runs_[k].begin;
    }
}

/// A run is open if any of its cells has an open face to a cell that is not fluid, or another coupling to p = 0.
template <int D>
void Natural<D>::mark_open() {
    refill_scratch<char>(open_, runs_.size(), 0);
    for (int q = planes_.begin; q < planes_.end; ++q)
        for (int j = 0; j < rows_in_plane(); ++j)
            for (const Run* run = runs_begin(row(q, j)); run != runs_end(row(q, j)); ++run) {
                auto& is_open = open_[static_cast<std::size_t>(root_[static_cast<std::size_t>(run - runs_.data())])];
                if (is_open) continue;
                const auto* c = cells(row(q, j));
                if (zero_) is_open = std::any_of(zero(row(q, j)) + run->begin, zero(row(q, j)) + run->end, [](real z) { return z > 0; });
                for (int side = 0; side < 2; ++side) {
                    const int i = side == 0 ? run->begin - 1 : run->end;
                    const int face = side == 0 ? run->begin : run->end;
                    if (c[i] == air && (!weighted_ || faces(0, q, j)[face] > 0)) is_open = 1;
                    for (int a = 1; a < D && !is_open; ++a) {
                        const auto* other = cells(neighbour(q, j, a, side));
                        const real* w = !weighted_ ? nullptr : faces(a, q + (a == D - 1 ? side : 0), j + (a == D - 1 ? 0 : side));
                        for (int k = run->begin; k < run->end && !is_open; ++k) is_open = other[k] == air && (w == nullptr || w[k] > 0);
                    }
                }
            }
}

/// In parallel: a component is open if any rank found it open.
template <int D>
void Natural<D>::gather_open() {
    std::vector<int> found;
    for (std::size_t k = 0; k < open_.size(); ++k)
        if (open_[k] != 0) found.push_back(static_cast<int>(k));
    for (const int k : of_all_ranks(found)) open_[static_cast<std::size_t>(k)] = 1;
}

template <int D>
Operator<D> Natural<D>::as_operator() const {
    const Partition* const cut = own_.distributed() ? &own_.partition() : nullptr;
    Operator<D> A;
    A.cells = Grid<Cell, D>(replicated(n_));
    for (int row = planes_.begin * rows_in_plane(); row < planes_.end * rows_in_plane(); ++row)
        std::memcpy(A.cells.data() + static_cast<std::ptrdiff_t>(row) * n_[0], cells(row), static_cast<std::size_t>(n_[0]));
    A.periodic = periodic_;
    if (!weighted_) A.axis_weight = axis_weight_;
    for (std::size_t a = 0; weighted_ && a < D; ++a) {
        A.weight[a] = Grid<real, D>(replicated(n_ + e<D>(static_cast<int>(a))));
        if (!cut)
            std::copy_n(faces_[a].data(), faces_[a].size(), A.weight[a].data());
        else
            std::copy_n(faces_[a].data() + face_offset(static_cast<int>(a), planes_.begin, 0),
                        face_offset(static_cast<int>(a), planes_.end + (a == D - 1 ? 1 : 0) - planes_.begin, 0),
                        A.weight[a].data() + face_offset(static_cast<int>(a), planes_.begin, 0));
        if (cut) communicator().gather(*cut, planes_of(A.weight[a]));
    }
    if (cut) communicator().gather(*cut, planes_of(A.cells));
    return A;
}

template <int D>
std::size_t Natural<D>::bytes() const {
    std::size_t sum = cells_.bytes() + count_.bytes() + run_start_.capacity() * sizeof(int) + runs_.capacity() * sizeof(Run);
    for (const auto& f : faces_) sum += f.bytes();
    sum += wet_.capacity() + (root_.capacity() + number_.capacity()) * sizeof(int) + open_.capacity();
    return sum + (size_.capacity() + mean_.capacity() + sum_.capacity()) * sizeof(real);
}

template void Natural<2>::build(const Operator<2>&, const OwnPlanes&, const Grid<real, 2>*);
template void Natural<3>::build(const Operator<3>&, const OwnPlanes&, const Grid<real, 3>*);
template int Natural<2>::neighbour(int, int, int, int) const;
template int Natural<3>::neighbour(int, int, int, int) const;
template Operator<2> Natural<2>::as_operator() const;
template Operator<3> Natural<3>::as_operator() const;
template std::size_t Natural<2>::bytes() const;
template std::size_t Natural<3>::bytes() const;

}  // namespace weir::poisson
