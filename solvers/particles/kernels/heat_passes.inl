/* The pass of heat over one chunk of the list, for one kernel and one instruction set: terms in single precision, sums in double. */

#include "particles/kernels/heat_pair.inl"

/* dh/dt of every particle; `positions` have theta as their fourth number. Beyond a wall lies the liquid's image: with equal theta at an
   insulated wall, mirrored about theta of a wall of fixed temperature. */
template <bool Density>
WEIR_ALWAYS void heat_and(const HeatPass& a, const PbfPass* d, const ListChunk& chunk) {
    const single::HeatParams* p = a.p;
    const float beyond = 1.0001f * p->h2; /* beyond h also after rounding in single precision: exactly zero there */
    for (int s = chunk.begin; s < chunk.end; ++s) {
        const int first = s * lanes;
        const Four i = load(a.positions, first);
        HeatImages images;
        heat_images(i, a.walls, p->h, images);
        vd sum{}, by_walls{};
        vf rho = Density ? broadcast(d->p->self) : broadcast(0);
        for (int m = 0; m < images.count; ++m) {
            const HeatImages::Image& image = images.of[m];
            if (!image.held) continue;
            vf r2 = broadcast(p->guard); /* from a particle to its own image */
            for (int n = 0; n < image.planes; ++n) r2 = heat_behind(r2, image.height[n], image.height[n]);
            add(by_walls, heat_flow(r2, broadcast(2) * (broadcast(image.theta) - i.w), p));
        }
        const std::uint32_t* row = chunk.entries + a.first[s];
        for (int k = 0; k < a.rows[s]; ++k, row += lanes) {
            const Four j = gather(a.positions, row);
            prefetch(row);
            const vf dx = i.x - j.x, dy = i.y - j.y, dz = i.z - j.z;
            const vf r2 = distance2(dx, dy, dz, p->guard), rise = j.w - i.w;
            if (Density) rho = pbf_add_density(rho, distance2(dx, dy, dz, d->p->guard), d->p);
            vf flow = heat_flow(r2, rise, p); /* antisymmetric in i and j, also the sum with images */
            for (int m = 0; m < images.count; ++m) {
                const HeatImages::Image& image = images.of[m];
                const vf other[3] = {j.x, j.y, j.z};
                vf behind = r2;
                for (int n = 0; n < image.planes; ++n)
                    behind = heat_behind(behind, image.height[n], heat_height(other, image.plane[n], a.walls));
                if (!any_below(behind, beyond)) continue;
                if (image.held)
                    add(by_walls, heat_flow(behind, broadcast(2 * image.theta) - (j.w + i.w), p));
                else
                    flow += heat_flow(behind, rise, p);
            }
            add(sum, flow);
        }
        sum += by_walls;
        for (int l = 0; l < live(first, a.count); ++l) a.to[first + l] = sum[l];
        if (a.by_walls)
            for (int l = 0; l < live(first, a.count); ++l) a.by_walls[first + l] = by_walls[l];
        if (Density)
            store_numbers(d->density, first, live(first, a.count), rho + walls_at(i, d->walls, d->solid, first).w * rest_of(*d, first));
    }
}

static void heat(const HeatPass& a, const ListChunk& chunk) { heat_and<false>(a, nullptr, chunk); }

/* Combined with the density of PBF (pbf_passes.inl) at the same positions, bitwise equal: most of the cost is the access to pairs. */
static void heat_and_density(const HeatPass& a, const PbfPass& d, const ListChunk& chunk) { heat_and<true>(a, &d, chunk); }
