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
            rho = sph_add_density(rho, distance2(dx, dy, dz, p->guard), p);
        }
        const vf behind = a.rest ? broadcast(p->wall_rho) * load_numbers(a.rest, first) : broadcast(p->wall_rho);
        store_numbers(a.density, first, live(first, a.count), rho + behind * walls_at(i, a.walls, a.solid, first).w);
    }
}

/* The density rate of every particle, from `velocities` (whose fourth number is the excess rho - rho0). The image velocity behind a wall
   is opposite to the particle's: the work of the wall's pressure then equals the particle's loss of volume. */
template <bool Diffusion>
static void sph_rates(const SphPass& a, const ListChunk& chunk) {
    const single::SphParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first), u = load(a.velocities, first);
        const Four w = walls_at(i, a.walls, a.solid, first);
        vf rate = broadcast(2) * dot3(w.x, w.y, w.z, u.x, u.y, u.z), spread = broadcast(0);
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row), v = gather(a.velocities, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z, r2 = distance2(dx, dy, dz, p->guard);
            rate += sph_rate(r2, dot3(u.x - v.x, u.y - v.y, u.z - v.z, dx, dy, dz), j.w, p);
            if constexpr (Diffusion) spread += sph_diffusion(r2, v.w - u.w + sph_layers(dx, dy, dz, p), j.w, p);
        }
        store_numbers(a.density, first, live(first, a.count), rate / i.w + spread);
    }
}

/* All forces of the scene. Summed: with density by summation the pair forces are the gradient of the energy sum_i m e(rho_i), e' = p /
   rho^2 (Monaghan 1992, eq. 3.3); otherwise the form consistent with the continuity equation. */
template <unsigned Terms>
static void sph_forces(const SphPass& a, const ListChunk& chunk) {
    constexpr bool summed = (Terms & sph_summed) != 0, artificial = (Terms & sph_artificial) != 0, viscous = (Terms & sph_viscous) != 0;
    const single::SphParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first), u = load(a.velocities, first);
        /* walls have the particle's own pressure: no gradient through them */
        const Four w = walls_at(i, a.walls, a.solid, first);
        const vf own = (u.w + u.w) * i.w;
        vf ax = -own * w.x, ay = -own * w.y, az = -own * w.z;
        if (a.wall_forces && any_below(-w.w, 0)) {
            const vf x[3] = {i.x, i.y, i.z}, v[3] = {u.x, u.y, u.z};
            vf more[3];
            sph_wall_force(x, v, u.w, w.w, a.walls, p, more);
            ax += where_positive(w.w, more[0]), ay += where_positive(w.w, more[1]), az += where_positive(w.w, more[2]);
        }
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row), v = gather(a.velocities, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z, r2 = distance2(dx, dy, dz, p->guard);
            [[maybe_unused]] const vf ux = u.x - v.x, uy = u.y - v.y, uz = u.z - v.z;
            const vf volumes = i.w * j.w;
            vf pressures = summed ? FMA(v.w * j.w, j.w, u.w * i.w * i.w) : (u.w + v.w) * volumes;
            if constexpr (artificial)
                pressures = sph_add_artificial(pressures, r2, dot3(ux, uy, uz, dx, dy, dz), broadcast(0.5f) * (i.w + j.w), p);
            if constexpr (viscous) {
                const vf drag = sph_drag(r2, volumes, p);
                ax = FNMA(drag, ux, ax), ay = FNMA(drag, uy, ay), az = FNMA(drag, uz, az);
            }
            const vf push = sph_push(r2, pressures, p);
            ax = FMA(push, dx, ax), ay = FMA(push, dy, ay), az = FMA(push, dz, az);
        }
        store(a.acceleration, first, live(first, a.count), {ax, ay, az, broadcast(0)});
    }
}

/* Surface normals in the form of sph_normal, written to `acceleration`. Liquid is assumed behind walls. */
static void sph_normals(const SphPass& a, const ListChunk& chunk) {
    const single::SphParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first);
        const Four w = walls_at(i, a.walls, a.solid, first);
        vf nx = w.x, ny = w.y, nz = w.z;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            const vf f = sph_colour(distance2(dx, dy, dz, p->guard), j.w, p);
            nx = FMA(f, dx, nx), ny = FMA(f, dy, ny), nz = FMA(f, dz, nz);
        }
        const vf scale = sph_normal(dot3(nx, ny, nz, nx, ny, nz), p);
        nx *= scale, ny *= scale, nz *= scale;
        store(a.acceleration, first, live(first, a.count), {nx, ny, nz, dot3(nx, ny, nz, nx, ny, nz)});
    }
}

/* Acceleration by surface tension: `velocities` contains the normals. */
static void sph_tensions(const SphPass& a, const ListChunk& chunk) {
    const single::SphParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first), q = load(a.velocities, first);
        vf ax = broadcast(0), ay = ax, az = ax;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row), n = gather(a.velocities, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z, r2 = distance2(dx, dy, dz, p->guard);
            const vf f = sph_tension(r2, i.w * j.w, p), both = q.w + n.w;
            const vf own = dot3(q.x, q.y, q.z, dx, dy, dz), other = dot3(n.x, n.y, n.z, dx, dy, dz);
            ax += f * (both * dx - own * q.x - other * n.x);
            ay += f * (both * dy - own * q.y - other * n.y);
            az += f * (both * dz - own * q.z - other * n.z);
        }
        store(a.acceleration, first, live(first, a.count), {ax, ay, az, broadcast(0)});
    }
}

static constexpr PassTable::Sph sph_table{sph_densities,
                                          {sph_rates<false>, sph_rates<true>},
                                          {sph_forces<0>, sph_forces<1>, sph_forces<2>, sph_forces<3>, sph_forces<4>, sph_forces<5>,
                                           sph_forces<6>, sph_forces<7>},
                                          sph_normals,
                                          sph_tensions};
