// A lattice of particles at rest: its density and its neighbours.
#include "validation/metrics/lists.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {

std::vector<Metric> lattice_metrics() {
    return {
        {.name = "lattice.density_error",
         .unit = "",
         .doc = "Largest relative difference of a particle's density from the lattice's sum.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const real exact = ref.number("density");
                 real worst = 0;
                 for (const real rho : run.field("density").data.at(0)) worst = std::max(worst, std::abs(rho / exact - 1));
                 return worst;
             }},
        {.name = "lattice.neighbours_error",
         .unit = "",
         .doc = "How far the mean number of neighbours lies outside what the lattice allows.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const real mean = run.series("mean_neighbours").y.back();
                 return std::max({ref.number("fewest_neighbours") - mean, mean - ref.number("most_neighbours"), 0.0});
             }},
    };
}

}  // namespace weir::validation
