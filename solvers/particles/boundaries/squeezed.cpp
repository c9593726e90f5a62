#include "particles/boundaries/squeezed.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

namespace weir::particles {

template <int D>
void require_room(const Fluid<D>& fluid, real mean_compression) {
    constexpr real most = 0.1;
    if (!(mean_compression > most)) return;
    const auto& solids = fluid.domain.solids;
    for (std::size_t i = 0; i < solids.count(); ++i) {
        if (!solids[i].motion.moves()) continue;
        const auto& pose = solids.pose(i);
        const Vec<D> middle = pose.to_world(solids[i].shape->centre());
        std::string at;
        for (int a = 0; a < D; ++a) at += fmt::format("{}{:.4g}", a ? ", " : "", middle[a]);
        throw NumericalFailure(
            "volume",
            fmt::format("the mean compression of liquid is {:.3g}, more than {}: solids[{}], now at [{}] m, leaves too little volume",
                        mean_compression, most, solids.in_list(i), at));
    }
}

template void require_room(const Fluid<2>&, real);
template void require_room(const Fluid<3>&, real);

}  // namespace weir::particles
