// Several stages over the planes of a grid in one pass through memory: stage s works on plane q as soon as stage s − 1 has done planes
// q − 1, q and q + 1, so that a plane is still in the cache. Threads own slabs: each does in its slab what depends on no other slab
// (a trapezoid in plane and stage), then all close the triangles left at the slabs' ends: stage by stage where planes are few, else each
// thread those at its slab's beginning. Who computes what never changes what is computed: results do not depend on the number of threads.
#pragma once
#include "core/halo.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::poisson {

struct Wavefront {
    int planes = 0;
    int stages = 0;
    bool ring = false;                                // the first and the last plane are neighbours
    const std::vector<std::int64_t>* work = nullptr;  // cost of the planes before each plane, planes + 1 entries: slabs share it fairly
    bool last_pairs = false;                          // the last stage works on pairs of planes: for odd q it may reach q − 2 .. q + 1

    /// Planes a slab must have for its trapezoid not to be empty, rounded up to even.
    int thickness() const { return (2 * stages + 2) / 2 * 2; }
    int reach_down(int stage) const { return stage + (last_pairs && stage == stages - 1 ? 1 : 0); }

    /// The same on the planes of one rank: `below` and `above` tell whether another owns what lies beyond them. exchange(stage) brings what
    /// that stage has written beside the cuts; as many exchanges as there are stages but one, whatever the slab.
    template <class F, class Exchange>
    void run_slab(int wanted, PlaneRange own, bool below, bool above, F&& f, Exchange&& exchange) const {
        const int slabs = std::min(wanted, (own.end - own.begin) / thickness());
        if (slabs == 0) {
            for (int s = 0; s < stages; ++s) {
                for (int q = own.begin; q < own.end; ++q) f(s, q);
                if (s + 1 < stages) exchange(s);
            }
            return;
        }
#pragma omp parallel num_threads(slabs)
        {
            const int t = omp_get_thread_num(), team = omp_get_num_threads();
            const int begin = boundary(t, team, own), end = boundary(t + 1, team, own);
            const bool first = t == 0 && !below, last = t == team - 1 && !above;
            sweep(begin, end, first, last, f);
            for (int s = 1; s < stages; ++s) {
#pragma omp barrier
                if (t == 0) exchange(s - 1);
#pragma omp barrier
                if (!first)
                    for (int q = begin; q < begin + reach_down(s); ++q) f(s, q);
                if (!last)
                    for (int q = end - s; q < end; ++q) f(s, q);
            }
        }
    }

    /// f(stage, plane) for all stages and planes, on at most `wanted` threads.
    template <class F>
    void run(int wanted, F&& f) const {
        const int slabs = std::min(wanted, planes / thickness());
        if (slabs == 0 || (slabs == 1 && ring && planes < 2 * thickness())) return stage_by_stage(f);
        if (slabs == 1 && !ring) return sweep(0, planes, true, true, f);
#pragma omp parallel num_threads(slabs)
        {
            const int t = omp_get_thread_num(), team = omp_get_num_threads();
            const int begin = boundary(t, team, {0, planes}), end = boundary(t + 1, team, {0, planes});
            const bool first = t == 0 && !ring, last = t == team - 1 && !ring;
            sweep(begin, end, first, last, f);
            if (many_planes()) {
#pragma omp barrier
                if (!first) close_below(begin, f);
            }
            for (int s = many_planes() ? stages : 1; s < stages; ++s) {
#pragma omp barrier
                if (!first)
                    for (int q = begin; q < begin + reach_down(s); ++q) f(s, q);
                if (!last)
                    for (int q = end - s; q < end; ++q) f(s, q);
            }
        }
    }

private:
    /// The even plane at which slab t of some planes begins: where the work before it is t parts of `team`, but no slab thinner than its
    /// triangles.
    int boundary(int t, int team, PlaneRange of) const {
        if (t == 0 || t == team) return t == 0 ? of.begin : of.end;
        const std::int64_t before = (*work)[static_cast<std::size_t>(of.begin)], all = (*work)[static_cast<std::size_t>(of.end)] - before;
        const std::int64_t share = before + all * t / team;
        const int fair = static_cast<int>(std::lower_bound(work->begin(), work->end(), share) - work->begin()) / 2 * 2;
        return std::clamp(fair, of.begin + t * thickness(), (of.end - (team - t) * thickness()) / 2 * 2);
    }

    /// Is a triangle so small a part of a slab that one thread had better close it than all meet at every stage?
    bool many_planes() const { return planes >= 32 * stages; }

    /// The triangles on both sides of the plane at which a slab begins.
    template <class F>
    void close_below(int begin, F&& f) const {
        for (int s = 1; s < stages; ++s)
            for (int q = begin - s; q < begin + reach_down(s); ++q) f(s, q < 0 ? q + planes : q);
    }

    template <class F>
    void stage_by_stage(F&& f) const {
        for (int s = 0; s < stages; ++s)
            for (int q = 0; q < planes; ++q) f(s, q);
    }

    /// What stage s can do on planes [begin, end) alone; open ends lose a plane a stage.
    template <class F>
    void sweep(int begin, int end, bool first, bool last, F&& f) const {
        for (int front = begin; front < end + stages - 1; ++front)
            for (int s = 0; s < stages; ++s) {
                const int q = front - s;
                const int from = first ? begin : begin + reach_down(s), to = last ? end : end - s;
                if (q >= from && q < to) f(s, q);
            }
    }
};

}  // namespace weir::poisson
