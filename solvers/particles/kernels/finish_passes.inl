/* Passes over velocities after the positions are final (Macklin & Mueller 2013, line 22): included behind pbf_passes.inl. */

/* Sum over neighbours of a cross product or a difference; `to` gets x, y, z and the length. */
template <int What>  // 0: XSPH, eq. 17; 1: curl, eq. 15; 2: confinement, eq. 16
static void finish(const FinishPass& a, const ListChunk& chunk) {
    const single::PbfParams* p = a.p;
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first), u = load(a.values, first);
        vf x = broadcast(0), y = x, z = x;
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row), w = gather(a.values, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z, r2 = distance2(dx, dy, dz, p->guard);
            const vf ux = w.x - u.x, uy = w.y - u.y, uz = w.z - u.z;
            if constexpr (What == 0) {
                const vf f = xsph_factor(r2, p);
                x = FMA(f, ux, x), y = FMA(f, uy, y), z = FMA(f, uz, z);
            } else if constexpr (What == 1) {
                const vf f = curl_factor(r2, p);
                x += f * (uy * dz - uz * dy), y += f * (uz * dx - ux * dz), z += f * (ux * dy - uy * dx);
            } else {
                const vf f = pbf_slope(r2, p) * w.w;
                x = FMA(f, dx, x), y = FMA(f, dy, y), z = FMA(f, dz, z);
            }
        }
        if constexpr (What == 2) { /* N x omega, N = eta / |eta| */
            const vf scale = RSQRT(dot3(x, y, z, x, y, z) + broadcast(1e-20f));
            const vf nx = scale * x, ny = scale * y, nz = scale * z;
            x = ny * u.z - nz * u.y, y = nz * u.x - nx * u.z, z = nx * u.y - ny * u.x;
        }
        const vf length2 = dot3(x, y, z, x, y, z);
        store(a.to, first, live(first, a.count), {x, y, z, length2 * RSQRT(length2 + broadcast(1e-20f))});
    }
}

static constexpr PassTable::Finish finish_table{finish<0>, finish<1>, finish<2>};
