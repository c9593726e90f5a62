#include "mac/advection/advection.hpp"

#include "mac/advection/near_sample.hpp"

namespace weir::mac {

namespace {

template <class Enum>
Enum named(const std::string& name, std::initializer_list<std::pair<const char*, Enum>> list) {
    for (const auto& [key, value] : list)
        if (name == key) return value;
    throw std::logic_error("\"" + name + "\" is in the schema but has no meaning");
}

/// Position of a node in a field without ghosts whose first plane is `plane`.
template <int D>
std::size_t offset(const Index<D>& extent, Index<D> I, int plane) {
    I[D - 1] -= plane;
    std::size_t at = 0;
    for (int d = D - 1; d >= 0; --d) at = at * static_cast<std::size_t>(extent[d]) + static_cast<std::size_t>(I[d]);
    return at;
}

/// Copies the nodes on both sides across `axis`.
template <int D>
void copy_ends(const Padded<D>& from, int axis, Padded<D>& to) {
    for (const int end : {0, from.extent()[axis] - 1}) {
        Index<D> lo{};
        Extent<D> hi = from.extent();
        lo[axis] = end;
        hi[axis] = end + 1;
        for_each_in(lo, hi, [&](const Index<D>& I) { to(I) = from(I); });
    }
}

}  // namespace

AdvectionOptions::AdvectionOptions(const scene::Table& table)
    : scheme(named<Scheme>(
          table.text("advection"),
          {{"semi_lagrangian", Scheme::semi_lagrangian}, {"maccormack", Scheme::maccormack}, {"conservative", Scheme::conservative}})),
      interpolation(named<Interpolation>(
          table.text("interpolation"),
          {{"linear", Interpolation::linear}, {"cubic", Interpolation::cubic}, {"monotone_cubic", Interpolation::monotone_cubic}})),
      trace(table.text("trace")),
      limiter(named<Limiter>(table.text("limiter"), {{"clamp", Limiter::clamp}, {"revert", Limiter::revert}, {"none", Limiter::none}})),
      flux(named<Flux>(table.text("flux"), {{"central", Flux::central}, {"van_leer", Flux::van_leer}})) {}

std::vector<scene::Key> AdvectionOptions::keys() {
    const auto choice = [](const char* name, const char* fallback, std::vector<std::string> choices, const char* doc) {
        scene::Key key;
        key.name = name;
        key.type = scene::Type::choice;
        key.fallback = std::string(fallback);
        key.choices = std::move(choices);
        key.doc = doc;
        return key;
    };
    return {
        choice("advection", "maccormack", {"semi_lagrangian", "maccormack", "conservative"},
               "semi_lagrangian (Stam 1999), maccormack (Selle et al. 2008), or conservative: central fluxes with a third-order "
               "Runge-Kutta (Spalart, Moser & Rogers 1991)"),
        choice("interpolation", "linear", {"linear", "cubic", "monotone_cubic"},
               "of semi_lagrangian and maccormack: multilinear, Lagrange's cubic, or the monotone cubic of Fedkiw et al. 2001"),
        choice("trace", "rk2", {"rk1", "rk2", "rk3", "rk4"}, "Runge-Kutta order of the characteristics"),
        choice(
            "limiter", "clamp", {"clamp", "revert", "none"},
            "of maccormack: a value outside the nodes around the departure point is clamped to them, reverts to semi-Lagrangian, or stays"),
        choice("flux", "van_leer", {"van_leer", "central"}, "of cell fields under conservative")};
}

template <int D>
void CharacteristicAdvection<D>::advect(const Padded<D>& source, const Boundary<D>& boundary, const Nodes<D>& nodes,
                                        const Backtrace<D>& trace, real dt, Grid<real, D>& q, const PressurePush<D>* on_arrival) {
    one_[0] = {&source, &boundary, &q};
    advect(one_, nodes, trace, dt, on_arrival);
}

template <int D>
void CharacteristicAdvection<D>::advect(const std::vector<Carried<D>>& quantities, const Nodes<D>& nodes, const Backtrace<D>& trace,
                                        real dt, const PressurePush<D>* on_arrival) {
    if (quantities.empty()) return;
    const Motion motion{quantities, nodes, trace, dt, on_arrival};
    if (options_.scheme == Scheme::semi_lagrangian) return semi_lagrangian(motion);
    if (trace.is_near(dt) && options_.interpolation == Interpolation::linear) return follow_planes(motion);
    const Extent<D>& all = quantities[0].source->extent();
    const int lo = all.own.lower(0), hi = all.own.upper(all[D - 1]);
    prepare(motion, hi - lo);
    predict(motion, lo);
    for (const auto& one : predicted_)
        for_each_plane(one.values->extent(), [&](int plane) { fill_plane_ghosts(*one.values, *one.boundary, plane); });
    fill_end_planes(predicted_, reach_);
    correct(motion, lo);
}

template <int D>
void CharacteristicAdvection<D>::sample(const Padded<D>& field, const Index<D>& first, int axis, const Displacement<D>& x, int count,
                                        real* out) const {
    const RowView<D> view(field, first, axis, axis);
    switch (options_.interpolation) {
        case Interpolation::linear:
            return sample_linear(view, x, count, out);
        case Interpolation::cubic:
            return sample_cubic(view, x, count, lagrange_cubic, out);
        case Interpolation::monotone_cubic:
            return sample_cubic(view, x, count, monotone_cubic, out);
    }
}

template <int D>
void CharacteristicAdvection<D>::semi_lagrangian(const Motion& m) const {
    for_each_row(m.nodes.lo, m.nodes.hi, [&](const Index<D>& first, int count) {
        Displacement<D> x;
        m.trace.row(m.nodes.axis, first, count, m.dt, x);
        for (const auto& quantity : m.quantities) sample(*quantity.source, first, m.nodes.axis, x, count, &(*quantity.q)(first));
    });
}

/// q̂ for nodes of this kind; nodes that are no unknowns (faces on closed sides) keep their values. Also allocates the bounds.
template <int D>
void CharacteristicAdvection<D>::prepare(const Motion& m, int planes_of_bounds) {
    if (room_.size() < m.quantities.size()) room_.resize(m.quantities.size());
    predicted_.clear();
    for (std::size_t i = 0; i < m.quantities.size(); ++i) {
        const Padded<D>& source = *m.quantities[i].source;
        Room& room = room_[i];
        auto& predicted = room.predicted[static_cast<std::size_t>(m.nodes.axis + 1)];
        if (predicted.empty()) predicted = Padded<D>(source.extent());
        predicted_.push_back({&predicted, m.quantities[i].boundary});
        Index<D> planes = source.extent();
        planes[D - 1] = planes_of_bounds;
        if (room.low.size() < product(planes)) room.low = room.high = std::vector<real>(product(planes));
        if (m.nodes.axis >= 0) copy_ends(source, m.nodes.axis, predicted);
    }
}

template <int D>
typename CharacteristicAdvection<D>::Motion CharacteristicAdvection<D>::Motion::on_plane(int plane) const {
    Motion one = *this;
    one.nodes.lo[D - 1] = plane;
    one.nodes.hi[D - 1] = plane + 1;
    return one;
}

/// Traced points less than a cell away lie between neighbouring planes: a plane is corrected as soon as the next one is predicted, while
/// the data are in cache. The first and last plane of each thread's range wait for the neighbouring thread. So the bounds of three planes
/// are stored per thread: those of the first plane and of the last two.
template <int D>
void CharacteristicAdvection<D>::follow_planes(const Motion& m) {
    const int planes = m.quantities[0].source->extent()[D - 1];
    const OwnPlanes& own = m.quantities[0].source->extent().own;
    const int lo = own.lower(m.nodes.lo[D - 1]), hi = own.upper(m.nodes.hi[D - 1]);
    const int shares = std::min(threads(), std::max(hi - lo, 0));
    prepare(m, 3 * shares);
    const auto begin_of = [&](int share) { return lo + (hi - lo) * share / shares; };
    const auto bounds_from = [&](int k, int share) { return k - (3 * share + (k == begin_of(share) ? 0 : 1 + k % 2)); };
    const auto correct_plane = [&](int k, int share) { correct(m.on_plane(k), bounds_from(k, share)); };
    const auto fill_plane = [&](int k) {
        for (const auto& [values, boundary] : predicted_) fill_plane_ghosts(*values, *boundary, k);
    };
    parallel_for(0, shares, [&](int share) {
        const int begin = begin_of(share), end = begin_of(share + 1);
        for (int k = begin; k < end; ++k) {
            predict(m.on_plane(k), bounds_from(k, share));
            fill_plane(k);
            if (k - 1 > begin) correct_plane(k - 1, share);
        }
    });
    for (int k = own.lower(0); k < lo; ++k) fill_plane(k);
    for (int k = std::max(lo, hi); k < own.upper(planes); ++k) fill_plane(k);
    fill_end_planes(predicted_, 1);
    parallel_for(0, shares, [&](int share) {
        const int first = begin_of(share), last = begin_of(share + 1) - 1;
        correct_plane(first, share);
        if (last > first) correct_plane(last, share);
    });
}

/// q̂ = A(q), and the bounds of the corrected value; those of plane k are stored as plane k - bounds_from.
template <int D>
void CharacteristicAdvection<D>::predict(const Motion& m, int bounds_from) {
    const int axis = m.nodes.axis;
    for_each_row(m.nodes.lo, m.nodes.hi, [&](const Index<D>& first, int count) {
        Displacement<D> x;
        m.trace.row(axis, first, count, m.dt, x);
        for (std::size_t i = 0; i < m.quantities.size(); ++i) {
            const Padded<D>& source = *m.quantities[i].source;
            const RowView<D> view(source, first, axis, axis);
            const std::size_t at = offset(source.extent(), first, bounds_from);
            real *low = room_[i].low.data() + at, *high = room_[i].high.data() + at;
            real* out = room_[i].predicted[static_cast<std::size_t>(axis + 1)].at(first);
            if (x.near && options_.interpolation == Interpolation::linear) {
                sample_near_bounded(view, x, count, out, low, high);
                continue;
            }
            sample(source, first, axis, x, count, out);
            sample_bounds(view, x, count, low, high);
        }
    });
}

/// q = q̂ + ½ (q − A⁻¹(q̂)), limited.
template <int D>
void CharacteristicAdvection<D>::correct(const Motion& m, int bounds_from) const {
    const int axis = m.nodes.axis;
    for_each_row(m.nodes.lo, m.nodes.hi, [&](const Index<D>& first, int count) {
        Displacement<D> x;
        alignas(64) real returned[row_block];
        m.trace.row(axis, first, count, -m.dt, x);
        for (std::size_t i = 0; i < m.quantities.size(); ++i) {
            const auto& quantity = m.quantities[i];
            const auto& predicted = room_[i].predicted[static_cast<std::size_t>(axis + 1)];
            sample(predicted, first, axis, x, count, returned);
            real* out = &(*quantity.q)(first);
            limit(room_[i], offset(quantity.source->extent(), first, bounds_from), quantity.source->at(first), predicted.at(first),
                  returned, count, out);
            if (m.on_arrival) m.on_arrival->add(axis, first, count, out);
        }
    });
}

/// The limiters are pure functions of their arguments: g++ 12 miscompiles variables captured in simd loops (limited values were wrong by as
/// much as the correction; the rotating_gaussian case detects it).
template <int D>
void CharacteristicAdvection<D>::limit(const Room& room, std::size_t at, const real* before, const real* hat, const real* returned,
                                       int count, real* out) const {
    const real *low = room.low.data() + at, *high = room.high.data() + at;
    const auto each = [&](auto limited) {
#pragma omp simd
        for (int i = 0; i < count; ++i) out[i] = limited(hat[i] + 0.5 * (before[i] - returned[i]), hat[i], low[i], high[i]);
    };
    switch (options_.limiter) {
        case Limiter::clamp:
            return each([](real value, real, real least, real most) { return std::min(std::max(value, least), most); });
        case Limiter::revert:
            return each([](real value, real safe, real least, real most) { return value < least || value > most ? safe : value; });
        case Limiter::none:
            return each([](real value, real, real, real) { return value; });
    }
}

template <int D>
std::size_t CharacteristicAdvection<D>::bytes() const {
    std::size_t total = 0;
    for (const Room& room : room_) {
        total += (room.low.size() + room.high.size()) * sizeof(real);
        for (const auto& field : room.predicted) total += field.bytes();
    }
    return total;
}

template class CharacteristicAdvection<2>;
template class CharacteristicAdvection<3>;

}  // namespace weir::mac
