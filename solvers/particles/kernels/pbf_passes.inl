/* The passes of PBF over one chunk of the list, for one kernel (WEIR_DENSITY, WEIR_SLOPE) and one instruction set. */

#include "particles/kernels/pbf_pair.inl"

/* Rest density of a particle, which is also the density behind walls: 1 for a liquid, less during boiling. The constraint is rho_i -
   rest_i <= 0, divided by rho0, so that the pressure is continuous across the surface between both. */
static vf rest_of(const PbfPass& a, int first) { return a.rest ? load_numbers(a.rest, first) : broadcast(1); }

/* Density and lambda of every particle: reads `from`, writes x, y, z, lambda to `to`. */
static void lambda(const PbfPass& a, const ListChunk& chunk) {
    const single::PbfParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.from, first);
        vf rho = broadcast(p->self), neighbours2 = broadcast(0), gx = neighbours2, gy = neighbours2, gz = neighbours2;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.from, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            const vf r2 = distance2(dx, dy, dz, p->guard);
            const vf slope = pbf_slope(r2, p);
            rho = pbf_add_density(rho, r2, p);
            neighbours2 = FMA(slope * slope, r2, neighbours2);
            gx = FMA(slope, dx, gx);
            gy = FMA(slope, dy, gy);
            gz = FMA(slope, dz, gz);
        }
        const Four w = walls_at(i, a.walls, a.solid, first);
        const vf rest = rest_of(a, first);
        rho += w.w * rest;
        gx += w.x * rest;
        gy += w.y * rest;
        gz += w.z * rest;
        const vf own2 = dot3(gx, gy, gz, gx, gy, gz);
        const vf before = a.multiplier ? load_numbers(a.multiplier, first) : broadcast(0);
        const vf sum = pbf_multiplier(before, rho + (broadcast(1) - rest), neighbours2, own2, p);
        if (a.multiplier) store_numbers(a.multiplier, first, live(first, a.count), sum);
        store(a.to, first, live(first, a.count), {i.x, i.y, i.z, sum - before});
        store_numbers(a.density, first, live(first, a.count), rho);
    }
}

/* Moves every particle by its correction and keeps it inside the walls: reads `from`, writes `to`. */
template <bool Pressure>
static void correct(const PbfPass& a, const ListChunk& chunk) {
    const single::PbfParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.from, first);
        vf cx = broadcast(0), cy = cx, cz = cx;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.from, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            const vf r2 = distance2(dx, dy, dz, p->guard);
            const vf factor = Pressure ? pbf_correction_with_pressure(r2, i.w + j.w, p) : pbf_correction(r2, i.w + j.w, p);
            cx = FMA(factor, dx, cx);
            cy = FMA(factor, dy, cy);
            cz = FMA(factor, dz, cz);
        }
        const Four w = walls_at(i, a.walls, a.solid, first);
        const vf push = i.w * rest_of(a, first);
        cx = FMA(push, w.x, cx);
        cy = FMA(push, w.y, cy);
        cz = FMA(push, w.z, cz);
        const vf x = i.x + cx, y = i.y + cy, z = i.z + cz;
        const Four inside{kept(x, a.walls, 0), kept(y, a.walls, 1), kept(z, a.walls, 2), broadcast(0)};
        store(a.to, first, live(first, a.count), inside);
        if (a.corrections) {
            const vf back = square_length(inside.x - x, inside.y - y, inside.z - z);
            const int begin = first < a.own_begin ? a.own_begin - first : 0, end = live(first, a.own_end);
            tally_corrections(*a.corrections, back, begin, end, a.order + first, a.particles);
        }
    }
}

/* Density only, of `from`. */
static void density(const PbfPass& a, const ListChunk& chunk) {
    const single::PbfParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.from, first);
        vf rho = broadcast(p->self);
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.from, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            rho = pbf_add_density(rho, distance2(dx, dy, dz, p->guard), p);
        }
        store_numbers(a.density, first, live(first, a.count), rho + walls_at(i, a.walls, a.solid, first).w * rest_of(a, first));
    }
}

static constexpr PassTable::Pbf table{lambda, correct<false>, correct<true>, density};

#include "particles/kernels/finish_passes.inl"
