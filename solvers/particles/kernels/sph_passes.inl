/* The passes of SPH over one chunk of the list, for one kernel and one instruction set: density, then all forces in one pass. */

#include "particles/kernels/sph_pair.inl"

static void sph_densities(const SphPass& a, const ListChunk& chunk) {
    const single::SphParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first);
        vf rho = broadcast(p->self);
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            rho += sph_density(dx * dx + dy * dy + dz * dz, p);
        }
        store_numbers(a.density, first, live(first, a.count), rho + p->wall_rho * walls_at(i, a.walls, a.solid, first).w);
    }
}

static void sph_forces(const SphPass& a, const ListChunk& chunk) {
    const single::SphParams* p = a.p;
    const vf half = broadcast(0.5f);
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first), u = load(a.velocities, first);
        /* walls push back with the particle's own pressure: no gradient through them */
        const Four w = walls_at(i, a.walls, a.solid, first);
        const vf own = u.w * i.w;
        vf ax = -own * w.x, ay = -own * w.y, az = -own * w.z;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row), v = gather(a.velocities, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z, r2 = dx * dx + dy * dy + dz * dz;
            const vf ux = u.x - v.x, uy = u.y - v.y, uz = u.z - v.z;
            const vf volumes = i.w * j.w;
            const vf push = sph_push(r2, ux * dx + uy * dy + uz * dz, half * (u.w + v.w) * volumes, half * (i.w + j.w), p);
            const vf drag = sph_drag(r2, volumes, p);
            ax += push * dx - drag * ux;
            ay += push * dy - drag * uy;
            az += push * dz - drag * uz;
        }
        store(a.acceleration, first, live(first, a.count), {ax, ay, az, broadcast(0)});
    }
}

static constexpr PassTable::Sph sph_table{sph_densities, sph_forces};
