// Every metric that belongs to one kind of case: one line a file.
#include "validation/metrics/lists.hpp"

namespace weir::validation {

const std::vector<Metric>& metrics() {
    static const std::vector<Metric> all = [] {
        std::vector<Metric> list;
        for (const auto& part :
             {cavity_metrics(),      energy_metrics(),       wave_metrics(),       dam_break_metrics(), growth_metrics(),
              shape_metrics(),       exactness_metrics(),    obstacle_metrics(),   particle_metrics(),  phase_metrics(),
              lattice_metrics(),     height_field_metrics(), procedural_metrics(), pond_metrics(),      body_metrics(),
              body_budget_metrics(), ice_metrics(),          substance_metrics(),  melting_metrics(),   melting_convection_metrics(),
              surface_metrics(),     vessel_metrics(),       boiling_metrics(),    capillary_metrics(), flow_past_metrics(),
              everyday_metrics(),    bubble_metrics(),       error_bars_metrics(), air_metrics()})
            list.insert(list.end(), part.begin(), part.end());
        return list;
    }();
    return all;
}

}  // namespace weir::validation
