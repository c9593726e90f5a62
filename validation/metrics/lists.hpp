// The lists of which the registry is made: one function for each file of metrics.
#pragma once
#include "validation/harness/metric.hpp"

namespace weir::validation {

std::vector<Metric> cavity_metrics();
std::vector<Metric> energy_metrics();
std::vector<Metric> wave_metrics();
std::vector<Metric> dam_break_metrics();
std::vector<Metric> growth_metrics();
std::vector<Metric> shape_metrics();
std::vector<Metric> exactness_metrics();
std::vector<Metric> obstacle_metrics();
std::vector<Metric> particle_metrics();
std::vector<Metric> phase_metrics();
std::vector<Metric> lattice_metrics();
std::vector<Metric> height_field_metrics();
std::vector<Metric> procedural_metrics();
std::vector<Metric> body_metrics();
std::vector<Metric> body_budget_metrics();
std::vector<Metric> ice_metrics();
std::vector<Metric> pond_metrics();
std::vector<Metric> substance_metrics();
std::vector<Metric> melting_metrics();
std::vector<Metric> melting_convection_metrics();
std::vector<Metric> surface_metrics();
std::vector<Metric> vessel_metrics();
std::vector<Metric> boiling_metrics();
std::vector<Metric> capillary_metrics();
std::vector<Metric> bubble_metrics();
std::vector<Metric> flow_past_metrics();
std::vector<Metric> everyday_metrics();
std::vector<Metric> air_metrics();
std::vector<Metric> error_bars_metrics();  // of validation/uncertainty

}  // namespace weir::validation
