#include "tallcell/pockets.hpp"

#include "core/scratch.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace weir::tallcell {

int Pockets::root(int knot) {
    while (parent_[at(knot)] != knot) knot = parent_[at(knot)] = parent_[at(parent_[at(knot)])];
    return knot;
}

void Pockets::join(int a, int b) {
    const int i = root(a), k = root(b), least = std::min(i, k);
    open_[at(least)] = static_cast<char>(open_[at(i)] | open_[at(k)]);
    parent_[at(std::max(i, k))] = least;
}

/// The knot at or below each shared row of a line's columns, −1 where a column is dry.
static void find_knots(const ColumnMatrix& A, const Knots& knots, int z, std::vector<int>& of) {
    const auto at = [](auto i) { return static_cast<std::size_t>(i); };
    resize_scratch(of, at(A.n[0]) * at(A.rows));
    for (int x = 0; x < A.n[0]; ++x) {
        const int column = x + z * A.n[0], end = knots.start[at(column) + 1];
        int i = knots.start[at(column)] - 1;
        for (int k = 0; k < A.rows; ++k) {
            if (i + 1 < end && knots.row[at(i + 1)] == A.row[at(k)]) ++i;
            const bool wet = (A.state[A.at(x, z, k)] & ColumnMatrix::wet) != 0;
            of[at(x) * at(A.rows) + at(k)] = wet ? i : -1;
        }
    }
}

void Pockets::join_line(const ColumnMatrix& A, const Knots& knots, int z) {
    find_knots(A, knots, z, here_);
    const int below = z > 0 ? z - 1 : A.periodic[1] && A.n[1] > 1 ? A.n[1] - 1 : -1;
    if (below >= 0) find_knots(A, knots, below, lower_);
    const std::size_t rows = at(A.rows);
    for (int x = 0; x < A.n[0]; ++x) {
        const int beside = x > 0 ? x - 1 : A.periodic[0] && A.n[0] > 1 ? A.n[0] - 1 : -1;
        for (int k = 0; k < A.rows; ++k) {
            const int knot = here_[at(x) * rows + at(k)];
            if (knot < 0) continue;
            const std::size_t entry = A.at(x, z, k);
            if (A.lid[entry] > 0 || A.sink[entry] > 0) open_[at(root(knot))] = 1;
            if (A.vertical[entry] > 0) join(knot, here_[at(x) * rows + at(k) + 1]);
            if (beside >= 0 && A.beside[0][entry] > 0) join(knot, here_[at(beside) * rows + at(k)]);
            if (below >= 0 && A.beside[1][entry] > 0) join(knot, lower_[at(x) * rows + at(k)]);
        }
    }
}

void Pockets::find(const ColumnMatrix& A, const Knots& knots) {
    clear();
    places_ = A;
    own_ = A.own();
    number_knots(A, knots);
    resize_scratch(parent_, at(knots.count()));
    std::iota(parent_.begin(), parent_.end(), 0);
    refill_scratch(open_, at(knots.count()), char{0});
    for (int z = own_.begin; z < own_.end; ++z) join_line(A, knots, z);
    number_pockets(A);
    if (any()) weigh(knots);
}

void Pockets::number_knots(const ColumnMatrix& A, const Knots& knots) {
    refill_scratch(begin_, at(A.n[1]), 0);
    refill_scratch(end_, at(A.n[1]), 0);
    for_each_line_near(A, 1, [&](int z) { begin_[at(z)] = knots.start[at(z * A.n[0])], end_[at(z)] = knots.start[at((z + 1) * A.n[0])]; });
    refill_scratch(firsts_, at(A.n[1]), 0);
    Ints& first = firsts_;
    for (int z = own_.begin; z < own_.end; ++z) first[at(z)] = end_[at(z)] - begin_[at(z)];
    if (!A.cut.empty()) communicator().gather(A.cut, {first.data(), sizeof(int), A.n[1]});
    std::exclusive_scan(first.begin(), first.end(), first.begin(), 0);
    resize_scratch(number_, at(knots.count()));
    for (int z = 0; z < A.n[1]; ++z)
        for (int i = begin_[at(z)]; i < end_[at(z)]; ++i) number_[at(i)] = first[at(z)] + i - begin_[at(z)];
}

/// Links of all ranks; empty for replicated work.
std::vector<Pockets::Link> Pockets::links_beside_cuts(const ColumnMatrix& A) {
    if (A.cut.empty()) return {};
    std::vector<Link> links;
    for (int z = 0; z < A.n[1]; ++z) {
        const bool inner = z > own_.begin && z + 1 < own_.end;
        for (int i = begin_[at(z)]; i < end_[at(z)] && !inner; ++i)
            links.push_back({number_[at(root(i))], number_[at(i)], open_[at(root(i))]});
    }
    return of_all_ranks(links);
}

/// Numbers the pockets of all ranks in the order of their first knots.
void Pockets::number_pockets(const ColumnMatrix& A) {
    std::map<int, int> parent;
    std::set<int> open;
    const auto first_of = [&](int i) {
        for (auto found = parent.find(i); found != parent.end() && found->second != i; found = parent.find(i)) i = found->second;
        return i;
    };
    for (const Link& link : links_beside_cuts(A)) {
        parent.try_emplace(link.first, link.first), parent.try_emplace(link.knot, link.knot);
        const int a = first_of(link.first), b = first_of(link.knot), least = std::min(a, b);
        if (link.open != 0 || open.count(a) > 0 || open.count(b) > 0) open.insert(least);
        parent[std::max(a, b)] = least;
    }
    Ints& firsts = firsts_;
    firsts.clear();
    refill_scratch(pocket_, number_.size(), -1);
    for (int i = 0; i < static_cast<int>(number_.size()); ++i) {
        const int set = root(i);
        if (open_[at(set)]) continue;
        const int first = first_of(number_[at(set)]);
        if (open.count(first) > 0) continue;
        pocket_[at(i)] = first;
        if (firsts.empty() || firsts.back() != first) firsts.push_back(first);
    }
    if (!A.cut.empty()) firsts = of_all_ranks(firsts);
    std::sort(firsts.begin(), firsts.end());
    firsts.erase(std::unique(firsts.begin(), firsts.end()), firsts.end());
    count_ = static_cast<int>(firsts.size());
    for (int& pocket : pocket_)
        if (pocket >= 0) pocket = static_cast<int>(std::lower_bound(firsts.begin(), firsts.end(), pocket) - firsts.begin());
}

/// Weight of each knot: 1, plus Σ j/H over the rows inside the elements above and below, j = 1 .. H − 1.
void Pockets::weigh(const Knots& knots) {
    refill_scratch<real>(mass_, number_.size(), 1);
    for (std::size_t i = 0; i < number_.size(); ++i) {
        const real inside = 0.5 * std::max(knots.length[i] - 1, 0);
        mass_[i] += inside;
        if (inside > 0) mass_[i + 1] += inside;
    }
    sum_up([](std::size_t) { return 1.0; }, size_);
}

/// Σ of(knot) times its rows, per pocket.
template <class F>
void Pockets::sum_up(F&& of, std::vector<real>& sums) const {
    sums_.assign(at(count_), ExactSum{});
    for (int z = own_.begin; z < own_.end; ++z)
        for (std::size_t i = at(begin_[at(z)]); i < at(end_[at(z)]); ++i)
            if (pocket_[i] >= 0) sums_[at(pocket_[i])].add(mass_[i] * of(i));
    sums_of_ranks(places_.planes(), sums_);
    resize_scratch(sums, sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) sums[i] = sums_[i].value();
}

void Pockets::make_compatible(std::vector<real>& b) const {
    if (!any()) return;
    sum_up([&](std::size_t i) { return b[i] / mass_[i]; }, mean_);
    for (std::size_t i = 0; i < b.size(); ++i)
        if (pocket_[i] >= 0) b[i] -= mass_[i] * (mean_[at(pocket_[i])] / size_[at(pocket_[i])]);
}

void Pockets::remove_means(std::vector<real>& q) const {
    if (!any()) return;
    sum_up([&](std::size_t i) { return q[i]; }, mean_);
    for (std::size_t i = 0; i < q.size(); ++i)
        if (pocket_[i] >= 0) q[i] -= mean_[at(pocket_[i])] / size_[at(pocket_[i])];
}

std::size_t Pockets::bytes() const {
    return (begin_.capacity() + end_.capacity() + number_.capacity() + parent_.capacity() + pocket_.capacity() + here_.capacity() +
            lower_.capacity() + firsts_.capacity()) *
               sizeof(int) +
           open_.capacity() + (mass_.capacity() + size_.capacity() + mean_.capacity()) * sizeof(real) + sums_.capacity() * sizeof(ExactSum);
}

}  // namespace weir::tallcell
