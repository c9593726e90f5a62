#include "particles/opencl/device_fluid.hpp"

#include "core/error.hpp"
#include "core/hex_number.hpp"
#include "particles/opencl/kernel_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace weir::particles {

namespace {
#include "particles/kernels/state_params.h"

constexpr std::size_t usual_group = 256;

template <int D>
StateParams state_params_of(const DeviceEffects<D>& effects, const Domain<D>& domain, real support) {
    StateParams p{};
    for (int a = 0; a < D; ++a) {
        p.centre[a] = domain.centre()[a];
        p.keep_lo[a] = domain.keep_lo[a];
        p.keep_hi[a] = domain.keep_hi[a];
        const bool repeats = domain.sides.periodic(a);
        p.lo[a] = domain.lo[a];
        p.period[a] = repeats ? domain.hi[a] - domain.lo[a] : 0;
        p.exit_lo[a] = repeats || domain.walled(a, 0) ? -infinity : domain.lo[a];
        p.exit_hi[a] = repeats || domain.walled(a, 1) ? infinity : domain.hi[a];
        p.gravity[a] = effects.g[a];
        p.field_centre[a] = effects.centre[a];
    }
    p.margin = domain.margin;
    p.feel = 1e-3 * domain.spacing;
    p.least_back = least_correction * domain.spacing;
    p.reach = support + 2 * domain.spacing;  // and the displacement by the corrections of one step
    return p;
}

/// The periods in single precision, as exact numbers in the program's text: pair passes measure distances with them.
template <int D>
std::string periods(const Domain<D>& domain) {
    std::string lengths, inverse;
    const Frame frame = domain.frame();
    for (std::size_t a = 0; a < 4; ++a) {
        const auto period = static_cast<float>(a < 3 ? frame.period[a] : 0);
        const auto append = [&](std::string& list, float number) {
            list += (a > 0 ? "," : "") + hex_number(static_cast<double>(number)) + "f";
        };
        append(lengths, period);
        append(inverse, period > 0 ? 1 / period : 0);
    }
    return " -DWEIR_PERIOD=" + lengths + " -DWEIR_PER_PERIOD=" + inverse;
}

/// Initial capacity for neighbours: half as many again as in a lattice.
template <int D>
int usual_neighbours(real support_in_spacings) {
    const real ball = D == 2 ? pi * std::pow(support_in_spacings, 2) : 4 * pi / 3 * std::pow(support_in_spacings, 3);
    return static_cast<int>(1.5 * ball) + 8;
}

}  // namespace

template <int D>
DeviceSetup with_scheme(DeviceSetup own, const Scheme& scheme, const Domain<D>& domain) {
    own.device = scheme.backend.device;
    own.kernel = scheme.kernel();
    own.walls = wall_params<single::WallParams>(scheme, domain);
    own.exact_walls = wall_params<plain::WallParams>(scheme, domain);
    own.support = scheme.support * domain.spacing;
    return own;
}

template <int D>
DeviceFluid<D>::DeviceFluid(Fluid<D> start, const DeviceEffects<D>& effects, const DeviceSetup& setup)
    : device_(backend::open_device(setup.device)), host_(std::move(start)), support_(setup.support), effects_(effects) {
    if (!device_->info().doubles)
        throw BadInput(device_->info().name +
                       " has no double precision (cl_khr_fp64), which the state of particles requires: choose another device (weir list "
                       "devices) or the backend threads");
    solid_ = !host_.domain.solids.empty();
    for (int axis = 0; axis < D; ++axis) {
        const auto& domain = host_.domain;
        repeats_ = repeats_ || domain.sides.periodic(axis);
        open_ = open_ || (!domain.sides.periodic(axis) && !(domain.walled(axis, 0) && domain.walled(axis, 1)));
    }
    for (group_ = static_cast<int>(usual_group); static_cast<std::size_t>(group_) > device_->info().group_limit;) group_ /= 2;
    compile(setup);
    room_ = usual_neighbours<D>(support_ / host_.domain.spacing);
    for (Memory* numbers : {&x, &v, &x_star}) plan_.want(*numbers, D * sizeof(double));
    for (Memory* number : {&density, &carried, &scratch_}) plan_.want(*number, sizeof(double));
    for (Memory* integer : {&id_, &names_, &cell_, &sorted_cell_, &order, &neighbours}) plan_.want(*integer, sizeof(int));
    for (Memory* four : {&a, &b}) plan_.want(*four, 4 * sizeof(float));
    if (solid_) plan_.want(near_solid, 1), plan_.want(terms, 4 * sizeof(float));
    if (effects_.xsph || effects_.vorticity) plan_.want(velocities_, 4 * sizeof(float));
    if (effects_.vorticity) plan_.want(omegas_, 4 * sizeof(float));
    if (effects_.heat) {
        for (Memory* number : {&enthalpy, &warming_, &by_walls_}) plan_.want(*number, sizeof(double));
        heat_pairs_ = constant(effects_.heat->single_pairs());
        heat_walls_ = constant(effects_.heat->single_walls());
        heat_states_ = constant(effects_.heat->states());
        if (const auto* vapour = effects_.heat->vapour()) {
            plan_.want(shift_, sizeof(double)), plan_.want(rests, sizeof(float));
            vapour_ = constant(vapour->params());
            above_ = device_->alloc(static_cast<std::size_t>(vapour->columns() * (vapour->rows() + 1)) * sizeof(int));
        }
        if (effects_.heat->free()) ice_ = std::make_unique<Ice<D>>(*effects_.heat, host_.domain), plan_.want(rests, sizeof(float));
    }
    plan_.want(list, static_cast<std::size_t>(room_) * sizeof(int));
    state_params = constant(state_params_of(effects, host_.domain, support_));
    wall_params = constant(setup.walls);
    if (solid_) take_series(setup.exact_walls);
    kernel_params = constant(setup.kernels);
    parts_ = device_->alloc(device_reduction_groups * 2 * D * sizeof(double));
    host_parts_.resize(device_reduction_groups * 2 * D);
    needed_ = device_->alloc(sizeof(int));
    corrections = constant(std::array<std::uint32_t, 2>{});
}

template <int D>
void DeviceFluid<D>::compile(const DeviceSetup& setup) {
    std::string program = program_of({"prelude_opencl.h", "params.h", "state_params.h", "single.inl", "pair.inl", "pbf_pair.inl"});
    const auto& sinks = effects_.emitters.sinks();
    const bool heated = effects_.heat && !effects_.heat->heaters().empty();
    if (solid_ || !sinks.empty() || heated) program += program_of({"shapes.cl"});
    if (solid_) program += text_of(host_.domain.solids) + program_of({"solids.cl"});
    if (!sinks.empty()) program += text_of<D>(sinks);
    if (heated) program += text_of<D>(effects_.heat->heaters());
    std::vector<std::string> files{"state.cl", "sort.cl", "list.cl", "finish.cl"};
    if (solid_) files.insert(files.end() - 1, "solid_terms.cl");
    if (effects_.heat) files.insert(files.end(), {"heat_params.h", "heat_state.inl", "heat_walls.inl", "heat_pair.inl", "heat.cl"});
    const bool boils = effects_.heat && effects_.heat->vapour();
    if (boils) files.insert(files.end(), {"vapour_params.h", "vapour.inl", "vapour.cl"});
    files.insert(files.end(), setup.files.begin(), setup.files.end());
    std::string defines = "-cl-std=CL1.2 -DWEIR_DIM=" + std::to_string(D) + " -DWEIR_KERNEL=" + std::to_string(setup.kernel) +
                          " -DWEIR_GROUP=" + std::to_string(group_) + " " + setup.defines;
    if (repeats_) defines += periods(host_.domain);
    if (open_) defines += " -DWEIR_OPEN";
    if (!sinks.empty()) defines += " -DWEIR_SINKS";
    if (heated) defines += " -DWEIR_HEATERS";
    if (boils) defines += " -DWEIR_VAPOUR";
    if (boils || (effects_.heat && effects_.heat->free())) defines += " -DWEIR_RESTS";
    if (effects_.gravity) defines += " -DWEIR_GRAVITY";
    if (effects_.central_force) defines += " -DWEIR_CENTRAL_FORCE";
    if (effects_.xsph) defines += " -DWEIR_XSPH";
    if (effects_.vorticity) defines += " -DWEIR_VORTICITY";
    device_->compile(program + program_of(files), defines);
}

template <int D>
void DeviceFluid<D>::settle_in() {
    auto particles = most_particles();
    if (stride_ > 1 && host_.count() > stride_) particles += static_cast<std::size_t>(host_.count()) / 4;  // more than estimated
    particles = std::max<std::size_t>(particles, 1);
    plan_.check(device_->info(), particles);
    plan_.allocate(*device_, particles);
    stride_ = static_cast<int>(particles);
    room_ = static_cast<int>(list.bytes / (particles * sizeof(int)));
    device_is_old_ = true;
}

template <int D>
const Fluid<D>& DeviceFluid<D>::host() const {
    if (host_is_old_) download();
    return host_;
}

template <int D>
Fluid<D>& DeviceFluid<D>::borrow() {
    if (device_is_old_) upload();
    download();
    host_is_old_ = true;
    return host_;
}

template <int D>
Fluid<D>& DeviceFluid<D>::change() {
    host();
    device_is_old_ = true;
    return host_;
}

template <int D>
void DeviceFluid<D>::upload() {
    count_ = host_.count();
    if (count_ > stride_) settle_in();  // a restored state may have more particles
    const auto n = host_.id.size(), row = static_cast<std::size_t>(stride_) * sizeof(real);
    for (std::size_t axis = 0; axis < D; ++axis) {
        device_->upload(x, host_.x[axis].data(), n * sizeof(real), axis * row);
        device_->upload(v, host_.v[axis].data(), n * sizeof(real), axis * row);
    }
    device_->upload(density, host_.density.data(), n * sizeof(real));
    device_->upload(carried, host_.carried.data(), n * sizeof(real));
    if (host_.warm) device_->upload(enthalpy, host_.enthalpy.data(), n * sizeof(real));
    if (solid_) place_solids();
    const std::vector<int> ids(host_.id.begin(), host_.id.end());
    device_->upload(id_, ids.data(), n * sizeof(int));
    device_is_old_ = false;
}

template <int D>
void DeviceFluid<D>::download() const {
    host_.resize(count_);
    const auto n = host_.id.size(), row = static_cast<std::size_t>(stride_) * sizeof(real);
    for (std::size_t axis = 0; axis < D; ++axis) {
        device_->download(host_.x[axis].data(), x, n * sizeof(real), axis * row);
        device_->download(host_.v[axis].data(), v, n * sizeof(real), axis * row);
    }
    device_->download(host_.density.data(), density, n * sizeof(real));
    device_->download(host_.carried.data(), carried, n * sizeof(real));
    if (host_.warm) device_->download(host_.enthalpy.data(), enthalpy, n * sizeof(real));
    std::vector<int> ids(n);
    device_->download(ids.data(), id_, n * sizeof(int));
    std::copy(ids.begin(), ids.end(), host_.id.begin());
    host_is_old_ = false;
}

template <int D>
void DeviceFluid<D>::run(std::string_view kernel, std::initializer_list<backend::Argument> arguments) {
    if (device_is_old_) upload();
    host_is_old_ = true;
    device_->launch(kernel, static_cast<std::size_t>(count()), device_group, arguments);
}

template <int D>
void DeviceFluid<D>::clear(const Memory& numbers, std::size_t bytes_per_particle) {
    device_->fill_zero(numbers, static_cast<std::size_t>(count()) * bytes_per_particle);
}

template <int D>
void DeviceFluid<D>::predict(real dt) {
    pass_time(dt);
    run("predict", {count(), stride_, state_params, poses, dt, pull(dt), corrections, x, v, x_star});
    keep_frozen_prediction(dt);
}

template <int D>
void DeviceFluid<D>::finish(real dt) {
    if (effects_.xsph) {
        run("load_velocities", {count(), stride_, v, order, velocities_});
        run("smooth", {count(), stride_, kernel_params, effects_.smoothing, a, velocities_, neighbours, list, order, v});
    }
    if (effects_.vorticity) {
        run("load_velocities", {count(), stride_, v, order, velocities_});
        run("curl", {count(), stride_, kernel_params, a, velocities_, neighbours, list, omegas_});
        run("confine", {count(), stride_, kernel_params, dt * effects_.confinement, a, omegas_, neighbours, list, order, v});
    }
}

template <int D>
typename DeviceFluid<D>::Reduced DeviceFluid<D>::reduce(std::string_view kernel, std::initializer_list<backend::Argument> arguments) {
    if (count() == 0) return {};
    if (device_is_old_) upload();
    const auto group = static_cast<std::size_t>(group_);
    const std::size_t groups = std::min(device_reduction_groups, (static_cast<std::size_t>(count()) + group - 1) / group);
    device_->launch(kernel, groups * group, group, arguments);
    device_->download(host_parts_.data(), parts_, groups * 2 * sizeof(double));
    Reduced all{-infinity, 0};
    for (std::size_t g = 0; g < groups; ++g) {
        const real largest = host_parts_[2 * g];
        if (largest > all.largest || std::isnan(largest)) all.largest = largest;
        if (std::isnan(all.largest)) break;
        all.sum += host_parts_[2 * g + 1];
    }
    return all;
}

template <int D>
real DeviceFluid<D>::max_speed() {
    const real square = reduce("speeds", {count(), stride_, x, v, parts_}).largest;
    speed_ = std::isfinite(square) ? std::sqrt(square) : host().max_speed();  // the error names the quantity that is not finite
    return speed_;
}

template <int D>
void DeviceFluid<D>::end_step() {
    count_corrections();
    if (++host_.steps % steps_between_reorders == 0 && count() > 0) reorder();
    cross_sides();
}

/// The device's counter is modulo 2^32; it also keeps the largest distance.
template <int D>
void DeviceFluid<D>::count_corrections() {
    std::array<std::uint32_t, 2> seen{};
    device_->download(seen.data(), corrections, sizeof seen);
    host_.corrections.add(static_cast<std::uint32_t>(seen[0] - corrections_seen_), static_cast<real>(std::bit_cast<float>(seen[1])));
    corrections_seen_ = seen[0];
}

template <int D>
void DeviceFluid<D>::reorder() {
    const auto arrange = [&](Memory& numbers, Memory& scratch, int axes) {
        run("gather_numbers", {count(), stride_, axes, order, numbers, scratch});
        std::swap(numbers, scratch);
    };
    arrange(x, x_star, D), arrange(v, x_star, D);  // x* is no longer needed
    arrange(density, scratch_, 1), arrange(carried, scratch_, 1);
    if (host_.warm) arrange(enthalpy, scratch_, 1);
    run("gather_names", {count(), order, id_, names_});
    std::swap(id_, names_);
}

template <int D>
Pairs::NeighbourCounts DeviceFluid<D>::neighbour_counts() const {
    const int n = sorted_count_;
    if (n == 0) return {};
    std::vector<int> counts(static_cast<std::size_t>(n));
    device_->download(counts.data(), neighbours, counts.size() * sizeof(int));
    const auto count_of = [&](int k) { return static_cast<real>(counts[static_cast<std::size_t>(k)]); };
    return {block_sum(n, count_of) / n, block_max(n, count_of)};
}

template <int D>
std::vector<int> DeviceFluid<D>::sorted_order() const {
    std::vector<int> owners(static_cast<std::size_t>(sorted_count_));
    device_->download(owners.data(), order, owners.size() * sizeof(int));
    return owners;
}

template <int D>
void DeviceFluid<D>::save(Checkpoint& to) const {
    host().save(to);
    effects_.emitters.save(to);
}
template <int D>
void DeviceFluid<D>::restore(const Checkpoint& from) {
    change().restore(from);
    corrections_seen_ = 0;
    device_->upload(corrections, std::array<std::uint32_t, 2>{}.data(), 2 * sizeof(std::uint32_t));
    effects_.emitters.restore(from);
}

template <int D>
void DeviceFluid<D>::record(Passes& passes) {
    for (const backend::Timing& t : device_->timings())
        if (t.calls > 0) passes.add(t.kernel, t.seconds, t.calls);
}

template DeviceSetup with_scheme(DeviceSetup, const Scheme&, const Domain<2>&);
template DeviceSetup with_scheme(DeviceSetup, const Scheme&, const Domain<3>&);
template class DeviceFluid<2>;
template class DeviceFluid<3>;

}  // namespace weir::particles
