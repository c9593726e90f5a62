// The V-cycle on a geometric hierarchy: red, black, red, black from zero on the way down, black, red, black, red on the way up. The halves
// are mirror images, so the cycle is a symmetric positive definite preconditioner. Each half is one wavefront over its level. In parallel
// the large levels are partitioned into slabs; the right-hand side of the first level that is not is gathered on all ranks.
#pragma once
#include "poisson/geometric/hierarchy.hpp"
#include "poisson/geometric/transfer.hpp"
#include "poisson/geometric/wavefront.hpp"

namespace weir::poisson {

template <int D>
class VCycle {
public:
    explicit VCycle(Hierarchy<D>& hierarchy) : hierarchy_(hierarchy) {}

    /// Level l: smooths u from zero for its r, and restricts the residual to level l + 1. `before` stages of the caller's come first, as
    /// f(stage, plane); the last of them must set u to r / diagonal on red cells. In parallel, exchange(stage) fills the ghost planes
    /// written by that stage.
    template <class F>
    void down(std::size_t l, int before, F&& f) {
        down(l, before, f, [](int) {});
    }
    template <class F, class Exchange>
    void down(std::size_t l, int before, F&& f, Exchange&& exchange) {
        Level<D>&fine = level(l), &coarse = level(l + 1);
        const bool pairs = fine.coarsened[D - 1];
        const int last = before + 3, planes = fine.at.planes();
        const auto work = [&](int stage, int q) {
            if (stage < before) return f(stage, q);
            if (stage < last) return relax_plane(fine, q, stage == before + 1 ? 0 : 1);
            if (!pairs)
                restrict_plane(fine, coarse, q);
            else if (q % 2 == 1 || q == planes - 1)
                restrict_plane(fine, coarse, q / 2);
        };
        run(fine, wavefront(fine, before + 4, pairs), work, [&](int stage) {
            if (stage + 1 < before) return exchange(stage);
            fine.refresh(fine.u[static_cast<std::size_t>((stage + 1 - before) % 2)]);
        });
        if (fine.cut.empty() || !coarse.cut.empty()) return;
        for (float* r : coarse.r) communicator().gather(halved_cut(fine), coarse.planes_of(r));
    }

    /// All levels below l: after up(), u of level l includes the coarse correction.
    void below(std::size_t l) {
        if (l + 2 == hierarchy_.levels().size()) return hierarchy_.solve_coarsest();
        down(l + 1, 1, [&](int, int q) { start_plane(level(l + 1), q); });
        below(l + 1);
        up(l + 1, 0, [](int, int) {});
    }

    /// Level l: adds the correction of level l + 1 and smooths. If `after` is not 0, the last half sweep, over red cells, is the caller's
    /// f(0, plane), followed by its further stages.
    template <class F>
    void up(std::size_t l, int after, F&& f) {
        Level<D>&fine = level(l), &coarse = level(l + 1);
        const auto work = [&](int stage, int q) {
            if (stage == 0) return prolong_plane(fine, coarse, q);
            if (stage < 4 || after == 0) return relax_plane(fine, q, stage % 2 == 1 ? 1 : 0);
            f(stage - 4, q);
        };
        run(fine, wavefront(fine, std::max(5, 4 + after), false), work,
            [&](int stage) { fine.refresh(fine.u[static_cast<std::size_t>(stage % 2)]); });
    }

    /// A wavefront over a level, or over this rank's part of it.
    template <class F, class Exchange>
    static void run(const Level<D>& at, const Wavefront& front, F&& f, Exchange&& exchange) {
        if (at.cut.empty()) return front.run(threads_for(at), f);
        const int rank = communicator().rank(), last = at.cut.ranks() - 1;
        front.run_slab(threads_for(at), {at.cut.begin(rank), at.cut.end(rank, front.planes)}, rank > 0 || front.ring,
                       rank < last || front.ring, f, exchange);
    }
    /// The partition of the level below a distributed one.
    static Partition halved_cut(const Level<D>& at) {
        Partition half = at.cut;
        if (at.coarsened[D - 1])
            for (int& plane : half.at) plane = (plane + 1) / 2;
        return half;
    }

    static Wavefront wavefront(const Level<D>& at, int stages, bool pairs) {
        return {.planes = at.at.planes(), .stages = stages, .ring = at.at.periodic[D - 1], .work = &at.work, .last_pairs = pairs};
    }
    static int threads_for(const Level<D>& at) { return at.cells() < 20000 ? 1 : threads(); }

private:
    Level<D>& level(std::size_t l) { return hierarchy_.levels()[l]; }
    Hierarchy<D>& hierarchy_;
};

}  // namespace weir::poisson
