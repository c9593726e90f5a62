// Several stages over the planes of a grid in one pass through memory: stage s processes plane q as soon as stage s − 1 has finished planes
// q − 1, q and q + 1, so that a plane is still in cache. Each thread has a slab and first processes the part that depends on no other slab
// (a trapezoid in plane and stage). Then the triangles at the slabs' ends are completed: stage by stage where planes are few, otherwise by
// the thread of the following slab. Results do not depend on the number of threads.
#pragma once
#include "core/parallel.hpp"
#include "parallel/partition.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::poisson {

struct Wavefront {
    int planes = 0;
    int stages = 0;
    bool ring = false;                                // the first and the last plane are neighbours
    const std::vector<std::int64_t>* work = nullptr;  // cumulative cost of the planes, planes + 1 entries: slabs have equal cost
    bool last_pairs = false;                          // the last stage processes pairs of planes: for odd q it may read q − 2 .. q + 1

    /// Minimum number of planes of a slab for a nonempty trapezoid, rounded up to even.
    int thickness() const { return (2 * stages + 2) / 2 * 2; }
    int reach_down(int stage) const { return stage + (last_pairs && stage == stages - 1 ? 1 : 0); }

    /// The same on the planes of one rank; `below` and `above`: whether another rank owns the planes beyond. exchange(stage) exchanges the
    /// ghost planes written by that stage; there are stages − 1 exchanges for any slab. Planes that other ranks need come first: those near
    /// the subdomain boundary, one plane fewer for each stage. Then follows the part that is independent of other ranks.
    template <class F, class Exchange>
    void run_slab(int wanted, PlaneRange own, bool below, bool above, F&& f, Exchange&& exchange) const {
        const auto low = [&](int s) { return below ? own.begin + by_cut(s) : own.begin; };
        const auto high = [&](int s) { return above ? own.end - by_cut(s) : own.end; };
        const int inner = high(0) - low(0);
        if (inner < 0) {
            for (int s = 0; s < stages; ++s) {
                for (int q = own.begin; q < own.end; ++q) f(s, q);
                if (s + 1 < stages) exchange(s);
            }
            return;
        }
        const int slabs = std::max(1, std::min(wanted, inner / thickness()));
#pragma omp parallel num_threads(slabs)
        {
            const int t = omp_get_thread_num(), team = omp_get_num_threads();
            for (int s = 0; s < stages; ++s) {
                if (t == 0)
                    for (int q = own.begin; q < low(s); ++q) f(s, q);
                if (t == team - 1)
                    for (int q = high(s); q < own.end; ++q) f(s, q);
#pragma omp barrier
                if (t == 0 && s + 1 < stages) exchange(s);
#pragma omp barrier
            }
            const int begin = boundary(t, team, {low(0), high(0)}), end = boundary(t + 1, team, {low(0), high(0)});
            sweep([&](int s) { return PlaneRange{t == 0 ? low(s) : begin + reach_down(s), t == team - 1 ? high(s) : end - s}; }, f);
            for (int s = 1; s < stages; ++s) {
#pragma omp barrier
                if (t > 0)
                    for (int q = begin; q < begin + reach_down(s); ++q) f(s, q);
                if (t < team - 1)
                    for (int q = end - s; q < end; ++q) f(s, q);
            }
        }
    }

    /// f(stage, plane) for all stages and planes, on at most `wanted` threads.
    template <class F>
    void run(int wanted, F&& f) const {
        const int slabs = std::min(wanted, planes / thickness());
        if (slabs == 0 || (slabs == 1 && ring && planes < 2 * thickness())) return stage_by_stage(f);
        if (slabs == 1 && !ring) return sweep([&](int) { return PlaneRange{0, planes}; }, f);
#pragma omp parallel num_threads(slabs)
        {
            const int t = omp_get_thread_num(), team = omp_get_num_threads();
            const int begin = boundary(t, team, {0, planes}), end = boundary(t + 1, team, {0, planes});
            const bool first = t == 0 && !ring, last = t == team - 1 && !ring;
            sweep([&](int s) { return PlaneRange{first ? begin : begin + reach_down(s), last ? end : end - s}; }, f);
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
    /// The even first plane of slab t: the work before it is t parts of `team`, but no slab is thinner than its triangles.
    int boundary(int t, int team, PlaneRange of) const {
        if (t == 0 || t == team) return t == 0 ? of.begin : of.end;
        const std::int64_t before = (*work)[static_cast<std::size_t>(of.begin)], all = (*work)[static_cast<std::size_t>(of.end)] - before;
        const std::int64_t share = before + all * t / team;
        const int fair = static_cast<int>(std::lower_bound(work->begin(), work->end(), share) - work->begin()) / 2 * 2;
        return std::clamp(fair, of.begin + t * thickness(), (of.end - (team - t) * thickness()) / 2 * 2);
    }

    /// Returns whether triangles are a small part of a slab: one thread then completes each, without a barrier at every stage.
    bool many_planes() const { return planes >= 32 * stages; }

    /// The triangles on both sides of a slab's first plane.
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

    /// Stage s on the planes of(s), whose ends move by at least one plane per stage, except at the ends of the grid.
    template <class Of, class F>
    void sweep(Of&& of, F&& f) const {
        int begin = planes, end = 0;
        for (int s = 0; s < stages; ++s) begin = std::min(begin, of(s).begin + s), end = std::max(end, of(s).end + s);
        for (int front = begin; front < end; ++front)
            for (int s = 0; s < stages; ++s) {
                const int q = front - s;
                const PlaneRange range = of(s);
                if (q >= range.begin && q < range.end) f(s, q);
            }
    }
    /// Number of planes at a subdomain boundary that stage s processes first: each stage needs those of the previous one and one more.
    int by_cut(int stage) const { return stages - stage + (last_pairs && stage + 1 < stages ? 1 : 0); }
};

}  // namespace weir::poisson
