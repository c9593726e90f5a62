// The state of every particle solver: positions and velocities in double precision, one array per axis, and their domain. The mass of a
// particle is rho0 d^D: a block of n particles is a liquid volume of n d^D, without a hidden factor.
#pragma once
#include "core/checkpoint.hpp"
#include "core/solver.hpp"
#include "particles/state/domain.hpp"

#include <cstdint>
#include <vector>

namespace weir::particles {

/// Steps between reorderings of the state's arrays to the sorted order, which keep gathers local.
inline constexpr std::int64_t steps_between_reorders = 16;

template <int D>
struct Fluid {
    Domain<D> domain;
    std::array<std::vector<real>, D> x, v;  // [m], [m/s]
    std::vector<real> id;                   // in order of creation; particles change their index in the arrays
    std::vector<real> density;              // of the last step [kg/m^3]
    std::vector<real> carried;              // one number of the solver per particle (PBF: the multiplier over dt^2)
    bool warm = false;                      // whether particles have heat
    std::vector<real> enthalpy;             // specific enthalpy, where warm [J/kg]
    bool shared = false;                    // distributed storage: this rank has only its own particles
    std::vector<real> place;                // where shared: index of each particle in the arrays of one process
    real next_place = 0;                    // of the next particle that enters
    real rho0 = 1, mass = 1;                // [kg/m^3], [kg] (2D: per metre of depth)
    real time = 0;                          // [s]
    std::int64_t steps = 0;
    real next_id = 0;
    Vec<D> gravity{};  // for the potential energy
    BoundaryCorrections corrections;

    Fluid() = default;
    /// Creates particles in the scene's "liquid" shapes, on the lattice of the grid's cell centres, outside solids. In parallel each rank
    /// starts with an equal number of them.
    explicit Fluid(const scene::Scene& scene);

    int count() const { return static_cast<int>(id.size()); }
    Vec<D> position(int i) const { return get(x, i); }
    Vec<D> velocity(int i) const { return get(v, i); }
    static Vec<D> get(const std::array<std::vector<real>, D>& f, int i) {
        Vec<D> value;
        for (int a = 0; a < D; ++a) value[a] = f[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)];
        return value;
    }
    static void put(std::array<std::vector<real>, D>& f, int i, const Vec<D>& value) {
        for (int a = 0; a < D; ++a) f[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)] = value[a];
    }
    static Coordinates coordinates(const std::array<std::vector<real>, D>& f) {
        Coordinates c{nullptr, nullptr, nullptr};
        for (std::size_t a = 0; a < D; ++a) c[a] = f[a].data();
        return c;
    }
    /// With distributed particles, rank 0 stores it.
    void add(const Vec<D>& at, const Vec<D>& velocity, real h = 0);
    void resize(int count);
    /// f(array) for every array of the state.
    template <class F>
    void for_each_array(F&& f) {
        for (std::size_t a = 0; a < D; ++a) f(x[a]), f(v[a]);
        f(id), f(density), f(carried);
        if (warm) f(enthalpy);
        if (shared) f(place);
    }
    /// Gathers the particles of all ranks, in the order of one process, on all ranks; collective.
    void gather(Fluid& all) const;
    /// Distributes the particles of all ranks, in the order of one process, in equal parts; collective.
    void deal(Fluid& part) const;
    /// Removes the particles for which gone(i) is true; the others keep their order.
    template <class F>
    void remove_if(F&& gone);
    /// Wraps particles at periodic sides and removes those beyond open sides.
    void cross_sides();
    /// Rearranges the arrays: particle k is the former order[k].
    void reorder(const std::vector<int>& order);
    /// The largest speed [m/s]. Throws NumericalFailure naming the quantity when a position or velocity is not finite.
    real max_speed() const;
    /// The same without an error: not finite where the state is not.
    real fastest() const;
    /// The quantity that is not finite, the last of these; moving: whether positions and velocities were checked.
    enum class Quantity { none, pressure, density, velocity, position };
    Quantity broken(bool moving = true) const;
    /// Throws NumericalFailure naming it.
    static void fail(Quantity broken);

    void show(FieldSet& fields) const;
    std::vector<Integral> integrals() const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const {
        std::size_t values = id.capacity() + density.capacity() + carried.capacity() + enthalpy.capacity() + scratch_.capacity();
        for (int a = 0; a < D; ++a) values += x[static_cast<std::size_t>(a)].capacity() + v[static_cast<std::size_t>(a)].capacity();
        values += place.capacity();
        return values * sizeof(real);
    }

private:
    void append(const Vec<D>& at, const Vec<D>& velocity, real h, real born, real stands);
    void save_part(Checkpoint& to) const;
    /// Copies everything except the particles.
    void take_setting(const Fluid& from);

    std::vector<real> scratch_;
};

template <int D>
template <class F>
void Fluid<D>::remove_if(F&& gone) {
    int to = 0;
    for (int i = 0; i < count(); ++i) {
        if (gone(i)) continue;
        const auto from = static_cast<std::size_t>(i), at = static_cast<std::size_t>(to++);
        for_each_array([&](std::vector<real>& f) { f[at] = f[from]; });
    }
    resize(to);
}

/// Sum of f(i) over [0, count) in blocks of fixed size: independent of the number of threads.
template <class F>
real block_sum(int count, F&& f) {
    constexpr int block = 2048;
    return exact_sum((count + block - 1) / block, [&](int b) {
        real sum = 0;
        for (int i = b * block; i < std::min(count, (b + 1) * block); ++i) sum += f(i);
        return sum;
    });
}
/// Exact sum of numbers, clamped to [0, 1024], in integer units of 2^-44, and their maximum. Integer sums do not depend on the order of
/// terms, nor on threads or ranks.
struct SumAndMost {
    __extension__ typedef __int128 Whole;
    static constexpr real unit = 0x1.0p-44, limit = 1024;

    Whole units = 0;
    real most = -infinity;  // NaN if any is NaN

    void add(const SumAndMost& more) {
        units += more.units;
        most = more.most > most || more.most != more.most ? more.most : most;
    }
    real sum() const { return std::isnan(most) ? most : unit * static_cast<real>(units); }
};
template <class F>
SumAndMost whole_sum_and_max(int count, F&& f) {
    constexpr int block = 256;  // largest block whose units fit in an integer
    SumAndMost all;
    for_chunks(count, [&](int, int begin, int end) {
        SumAndMost part;
        for (int b = begin; b < end; b += block) {
            std::int64_t units = 0;
            for (int i = b; i < std::min(end, b + block); ++i) {
                const real value = f(i);
                const real counted = value < SumAndMost::limit ? (value > 0 ? value : 0) : SumAndMost::limit;
                units += static_cast<std::int64_t>(counted / SumAndMost::unit);
                part.most = value > part.most || value != value ? value : part.most;
            }
            part.units += units;
        }
#pragma omp critical(weir_whole_sum)
        all.add(part);
    });
    return all;
}
/// Maximum of f(i) over [0, count), vectorized; NaN if any is NaN, since no value compares greater than a NaN in its lane.
template <class F>
real block_max(int count, F&& f) {
    constexpr int block = 2048, lanes = 8;
    if (count == 0) return 0;
    return parallel_max((count + block - 1) / block, [&](int b) {
        std::array<real, lanes> largest;
        largest.fill(-infinity);
        const auto meet = [&](std::size_t l, real value) { largest[l] = value > largest[l] || value != value ? value : largest[l]; };
        int i = b * block;
        const int end = std::min(count, i + block);
        for (; i + lanes <= end; i += lanes)
            for (int l = 0; l < lanes; ++l) meet(static_cast<std::size_t>(l), f(i + l));
        for (; i < end; ++i) meet(0, f(i));
        for (std::size_t l = 1; l < lanes; ++l) meet(0, largest[l]);
        return largest[0];
    });
}

}  // namespace weir::particles
