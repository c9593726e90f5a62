// Every reference by name: one line each.
#include "validation/harness/reference.hpp"

// X(taylor_green) X(couette) ...: each is a REFERENCE(name) of this folder.
// clang-format off
#define ALL_REFERENCES(X) \
    X(taylor_green) X(taylor_green_3d) X(poiseuille) X(couette) X(kovasznay) X(poisson_mms) X(cavity) X(cavity_3d) \
    X(heated_cavity) X(zalesak) X(single_vortex) X(rotating_gaussian) X(standing_wave) X(hydrostatic) X(thermal) X(plume) \
    X(dam_break_martin_moyce) X(dam_break_front) X(dam_break_koshizuka_oka) X(dam_break_kleefsman) X(stretching_drop) X(rotating_patch) X(static_drop) X(swinging_drop) X(swinging_capsule) X(viscous_current) \
    X(kernel_lattice) X(lake_at_rest) X(ritter) X(stoker) X(flow_over_bump) X(thacker_planar) X(simple_wave) X(solitary_wave) X(long_wave) X(heave) X(dragged) \
    X(wave_train) X(gerstner) X(stokes) X(sea) X(shoaling) X(pond) X(afloat) X(stays) X(round_vessel) X(heave_decay) X(heave_sphere) X(settling_sphere) X(settling_disc) X(square_section) X(phase_diagram) X(van_der_waals) X(stefan) X(ice_in_water) \
    X(melting_gallium) X(decaying_sine) X(steady_slab) X(liquid_body) X(closed_vessel) X(saturated_gas) X(contact) \
    X(poiseuille_beside_solid) X(turning_cylinder) X(cylinder_in_stream) X(backward_step) X(two_fluid_wave) X(two_fluid_growth) X(liquid_piston) X(glass) X(closed_hollow)
// clang-format on

#define DECLARE(name) REFERENCE(name);
ALL_REFERENCES(DECLARE)

namespace weir::validation {

#define ENTRY(name) {#name, name##_reference},
const std::vector<ReferenceKind>& references() {
    static const std::vector<ReferenceKind> all = {ALL_REFERENCES(ENTRY)};
    return all;
}

}  // namespace weir::validation
