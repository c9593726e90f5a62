#include "poisson/geometric/hierarchy.hpp"

#include "poisson/geometric/face_rows.hpp"
#include "poisson/geometric/packing.hpp"
#include "poisson/geometric/v_cycle.hpp"

#include <algorithm>
#include <optional>

namespace weir::poisson {

namespace {

constexpr std::size_t direct_cells = 300;   // levels up to this size are solved directly
constexpr std::size_t small_level = 20000;  // smaller levels do not use a second thread
constexpr real strong_axis = 0.4;           // only axes with at least this part of the largest weight are coarsened

template <int D, class Rows>
void coarsen_row(const Level<D>& fine, Level<D>& coarse, int Q, int J, const Rows& rows, RowBuffers<D>& buffers) {
    const int N = coarse.at.n[0], n = fine.at.n[0];
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(coarse.at.row(Q, J)) * N;
    std::array<float*, D> face;
    for (std::size_t a = 0; a < D; ++a) std::fill_n(face[a] = coarse.face[a] + at, N, 0.0f);
    float* zero = std::fill_n(coarse.zero + at, N, 0.0f) - N;
    std::uint8_t* fluid = std::fill_n(coarse.fluid + at, N, std::uint8_t{0}) - N;
    std::array<float, D> half;
    for (std::size_t a = 0; a < D; ++a) half[a] = fine.coarsened[a] ? 0.5f : 1.0f;
    const auto zero_factor = static_cast<float>(zero_scale(fine.zero_width));
    const Children<D> planes(fine, D - 1, Q), in_plane(fine, D == 2 ? 0 : 1, J);
    const int j_first = D == 2 ? 0 : in_plane.first, j_last = D == 2 ? 1 : in_plane.last;
    for (int q = planes.first; q < planes.last; ++q)
        for (int j = j_first; j < j_last; ++j) {
            if (fine.is_dry(fine.at.row(q, j))) continue;
            const FaceRow<D> row = rows(q, j, buffers);
            const int step = fine.coarsened[0] ? 2 : 1, pairs = fine.coarsened[0] ? n / 2 : 0;
            for (int I = 0; I < N; ++I) face[0][I] += half[0] * row.face[0][step * I];
            for (int a = 1; a < D; ++a) {
                if (a == D - 1 ? q != planes.first : j != j_first) continue;  // a face inside the coarse cell
                const float *from = row.face[static_cast<std::size_t>(a)], h = half[static_cast<std::size_t>(a)];
                float* to = face[static_cast<std::size_t>(a)];
                for (int I = 0; I < pairs; ++I) to[I] += h * (from[2 * I] + from[2 * I + 1]);
                for (int I = pairs; I < N; ++I) to[I] += h * from[step * I];
            }
            for (int I = 0; I < pairs; ++I) {
                zero[I] += zero_factor * (row.zero[2 * I] + row.zero[2 * I + 1]);
                fluid[I] = static_cast<std::uint8_t>(fluid[I] | row.fluid[2 * I] | row.fluid[2 * I + 1]);
            }
            for (int I = pairs; I < N; ++I) {
                zero[I] += zero_factor * row.zero[step * I];
                fluid[I] = static_cast<std::uint8_t>(fluid[I] | row.fluid[step * I]);
            }
        }
}

template <int D, class Rows>
void coarsen_level(const Level<D>& fine, Level<D>& coarse, const Rows& rows) {
    const bool pairs = fine.coarsened[D - 1];
    const auto plane = [&](int Q) {
        if (!fine.owns(pairs ? 2 * Q : Q)) return;
        thread_local RowBuffers<D> buffers;
        for (int J = 0; J < coarse.at.rows_in_plane(); ++J) coarsen_row(fine, coarse, Q, J, rows, buffers);
    };
    if (fine.cells() < small_level)
        for (int Q = 0; Q < coarse.at.planes(); ++Q) plane(Q);
    else
        parallel_for(0, coarse.at.planes(), plane);
}

/// Axes to coarsen: strongly coupled, and, if periodic, even afterwards (or a single cell).
template <int D>
std::array<bool, D> axes_to_halve(const Level<D>& level) {
    float strongest = 0;
    for (int a = 0; a < D; ++a)
        if (level.at.n[a] > 1) strongest = std::max(strongest, level.plain_weight[static_cast<std::size_t>(a)]);
    std::array<bool, D> halve{};
    for (int a = 0; a < D; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const int n = level.at.n[a];
        const bool stays_even = !level.at.periodic[axis] || n % 4 == 0 || n == 2;
        halve[axis] = n > 1 && stays_even && level.plain_weight[axis] >= strong_axis * strongest;
    }
    return halve;
}

/// The next coarser level, none if no axis is suitable. Marks these axes in `fine`.
template <int D>
std::optional<Level<D>> halve(Level<D>& fine) {
    fine.coarsened = axes_to_halve(fine);
    Level<D> coarse;
    Index<D> n = fine.at.n;
    coarse.plain_weight = fine.plain_weight;
    bool any = false;
    for (std::size_t a = 0; a < D; ++a) {
        if (!fine.coarsened[a]) continue;
        any = true;
        n[static_cast<int>(a)] = (n[static_cast<int>(a)] + 1) / 2;
        for (std::size_t other = 0; other < D; ++other) coarse.plain_weight[other] *= other == a ? 0.5f : 2.0f;
    }
    if (!any) return std::nullopt;
    coarse.at = Layout<D>(n, fine.at.periodic);
    coarse.zero_width = 2 * fine.zero_width;
    return coarse;
}

template <int D>
Level<D> finest_of(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, bool by_count) {
    Level<D> finest;
    finest.at = Layout<D>(n, periodic);
    finest.by_count = by_count;
    for (std::size_t a = 0; a < D; ++a) finest.plain_weight[a] = static_cast<float>(axis_weight[static_cast<int>(a)]);
    return finest;
}

/// The levels of such a problem without their memory; none where its shape is not supported.
template <int D>
std::vector<Level<D>> levels_below(Level<D> finest) {
    for (int a = 0; a < D; ++a)
        if (finest.at.periodic[static_cast<std::size_t>(a)] && finest.at.n[a] % 2 == 1) return {};
    std::vector<Level<D>> levels;
    levels.push_back(std::move(finest));
    while (levels.back().cells() > direct_cells) {
        std::optional<Level<D>> coarse = halve(levels.back());
        if (!coarse) return {};
        levels.push_back(std::move(*coarse));
    }
    if (levels.size() < 2) levels.clear();
    return levels;
}

}  // namespace

template <int D>
bool Hierarchy<D>::plan(const Natural<D>& problem) {
    Level<D> finest = finest_of<D>(problem.extent(), problem.periodic(), problem.axis_weight(), !problem.weighted());
    finest.has_zero = problem.has_zero();
    const Partition cut = problem.own().distributed() ? problem.own().partition() : Partition{};
    const auto same = [&](const Level<D>& other) {
        return other.at.n == finest.at.n && other.at.periodic == finest.at.periodic && other.plain_weight == finest.plain_weight &&
               other.by_count == finest.by_count && other.has_zero == finest.has_zero && other.cut == cut;
    };
    if (!levels_.empty() && same(levels_.front())) return true;
    levels_ = levels_below(std::move(finest));
    if (levels_.empty()) return false;
    window(cut);
    lay_out();
    return true;
}

/// Distributed storage of the partitioned levels: each rank's own planes and adjacent ghost planes.
template <int D>
void Hierarchy<D>::window(const Partition& cut) {
    for (auto& level : levels_) level.held.clear();
    windowed_ = !cut.empty();
    if (!windowed_) return;
    cut_levels(levels_, cut);
    for (auto& level : levels_)
        if (!level.cut.empty())
            level.held = planes_held(level.cut, communicator().rank(), level.at.planes(), 0, 1, level.at.periodic[D - 1]);
}

/// Exchanges the matrix of a level: ghost planes of this rank, or all planes.
template <int D>
void Hierarchy<D>::fill_ghosts(std::size_t l) {
    Level<D>& level = levels_[l];
    std::vector<Planes> all;
    for (float* face : level.face) all.push_back(level.natural_planes(face));
    all.push_back(level.natural_planes(level.zero));
    all.push_back(level.natural_planes(level.fluid));
    if (!level.cut.empty()) return communicator().refresh(level.cut, all, 1, level.at.periodic[D - 1]);
    for (const Planes& planes : all) communicator().gather(VCycle<D>::halved_cut(levels_[l - 1]), planes);
}

template <int D>
void Hierarchy<D>::lay_out() {
    std::size_t bytes = 0;
    const auto pieces = [&](auto&& piece) {
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            Level<D>& level = levels_[l];
            const std::size_t packed = level.at.entries(), natural = level.cells();
            const auto vector = [&](auto*& p) { piece(level, p, packed, static_cast<std::size_t>(level.at.stride + lanes)); };
            for (auto* list : {&level.u, &level.r, level.by_count ? nullptr : &level.dinv, level.has_zero ? &level.packed_zero : nullptr})
                if (list != nullptr)
                    for (auto& p : *list) vector(p);
            if (level.by_count)
                for (auto& p : level.count) vector(p);
            else
                for (auto& p : level.weight)
                    piece(level, p, packed + static_cast<std::size_t>(level.at.side_rows() * level.at.stride),
                          static_cast<std::size_t>(level.at.stride + lanes));
            if (l == 0) continue;
            for (auto& p : level.face) piece(level, p, natural, std::size_t{0});
            piece(level, level.zero, natural, std::size_t{0});
            piece(level, level.fluid, natural, std::size_t{0});
        }
    };
    pieces([&](const Level<D>&, auto*& p, std::size_t count, std::size_t) {
        bytes += Arena::need<std::remove_reference_t<decltype(*p)>>(count);
    });
    arena_.reserve(bytes, windowed_);
    pieces([&](const Level<D>& level, auto*& p, std::size_t count, std::size_t skip) {
        p = arena_.take<std::remove_reference_t<decltype(*p)>>(count) + skip;
        if (skip > 0)
            level.open(arena_, p, skip, count);
        else
            level.open_natural(arena_, p);
    });
}

template <int D>
void Hierarchy<D>::fill(const Natural<D>& problem, std::size_t l) {
    Level<D>& level = levels_[l];
    if (l == 0)
        pack_finest(level, problem);
    else
        pack_coarse(level, level.cells() >= small_level);
    if (l + 1 == levels_.size()) return;
    if (l == 0)
        coarsen_level(level, levels_[1], DerivedRows<D>{problem});
    else
        coarsen_level(level, levels_[l + 1], StoredRows<D>{level});
    if (!level.held.empty()) fill_ghosts(l + 1);
}

template <int D>
bool Hierarchy<D>::build(const Natural<D>& problem) {
    if (!plan(problem)) {
        levels_.clear();
        arena_.reserve(0);
        return false;
    }
    for (std::size_t l = 0; l < levels_.size(); ++l) fill(problem, l);
    build_coarsest();
    return true;
}

/// A level is distributed if it is large enough for messages and no coarse plane has children on two ranks. The coarsest level is
/// replicated.
template <int D>
void Hierarchy<D>::cut_levels(std::vector<Level<D>>& levels, const Partition& cut) {
    for (auto& level : levels) level.cut = {};
    if (cut.empty() || levels.empty()) return;
    levels[0].cut = cut;
    for (std::size_t l = 0; l + 1 < levels.size(); ++l) {
        Level<D>& level = levels[l];
        const auto straddled = [&](int plane) { return plane % 2 == 1 && plane != level.cut.planes(); };
        const auto& at = level.cut.at;
        if (level.cells() < small_level || (level.coarsened[D - 1] && std::any_of(at.begin(), at.end(), straddled))) {
            level.cut = {};
            break;
        }
        levels[l + 1].cut = VCycle<D>::halved_cut(level);
    }
    levels.back().cut = {};
}

template <int D>
std::size_t Hierarchy<D>::bytes() const {
    std::size_t sum = arena_.bytes() + coarsest_.bytes() + coarsest_matrix_.bytes() + coarsest_components_.bytes() + finder_.bytes();
    for (const auto& level : levels_)
        sum += level.plain.capacity() + level.span_start.capacity() * sizeof(int) + level.spans.capacity() * sizeof(Span) +
               level.work.capacity() * sizeof(std::int64_t);
    return sum;
}

template <int D>
std::vector<Level<D>> cut_levels_of(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight,
                                    const Partition& cut) {
    std::array<bool, D> wraps = periodic;
    for (int a = 0; a < D; ++a) wraps[static_cast<std::size_t>(a)] = wraps[static_cast<std::size_t>(a)] && n[a] > 1;
    auto levels = levels_below(finest_of<D>(n, wraps, axis_weight, true));
    Hierarchy<D>::cut_levels(levels, cut);
    return levels;
}
template std::vector<Level<2>> cut_levels_of<2>(const Index<2>&, const std::array<bool, 2>&, const Vec<2>&, const Partition&);
template std::vector<Level<3>> cut_levels_of<3>(const Index<3>&, const std::array<bool, 3>&, const Vec<3>&, const Partition&);

template <int D>
bool multigrid_shares(const Index<D>& n, const std::array<bool, D>& periodic, const Vec<D>& axis_weight, const Partition& cut) {
    const auto levels = cut_levels_of<D>(n, periodic, axis_weight, cut);
    return !levels.empty() && !levels[0].cut.empty();
}
template bool multigrid_shares<2>(const Index<2>&, const std::array<bool, 2>&, const Vec<2>&, const Partition&);
template bool multigrid_shares<3>(const Index<3>&, const std::array<bool, 3>&, const Vec<3>&, const Partition&);

template class Hierarchy<2>;
template class Hierarchy<3>;

}  // namespace weir::poisson
