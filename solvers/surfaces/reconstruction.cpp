#include "surfaces/reconstruction.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/sides.hpp"
#include "surfaces/contour.hpp"
#include "surfaces/contour_flat.hpp"
#include "surfaces/finish.hpp"
#include "surfaces/prepare.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

namespace {

/// Crowding above which a particle counts as one of many: a lattice has 12.5 (Loeschner et al. 2023 use 13).
constexpr real crowd = 13;
/// Markers of a grid along the edge of a cell.
constexpr real markers_per_cell = 2;

/// 0 at 0, 1 at 1, with zero first and second derivatives at both (Loeschner et al. 2023, section 3.2).
real smoother_step(real s) { return s * s * s * (s * (6 * s - 15) + 10); }

const FieldView* particles_of(const FieldSet& fields) {
    const FieldView* markers = fields.find(marker_set_name, "position");
    return markers ? markers : fields.find(particle_set_name, "position");
}

/// A velocity component on faces or in cells, or a cell field, trilinear.
real value_at(const FieldView& field, const GridView& grid, std::size_t component, const Vec<3>& x) {
    const auto dim = static_cast<std::size_t>(grid.dim);
    std::array<std::size_t, 3> low{}, n{1, 1, 1};
    std::array<real, 3> part{};
    for (std::size_t a = 0; a < dim; ++a) {
        const bool face = field.where == Where::face && a == component;
        n[a] = static_cast<std::size_t>(grid.cells[a]) + face;
        const real index = std::clamp((x[a] - grid.origin[a]) / grid.spacing[a] - (face ? 0 : 0.5), 0.0, real(n[a] - 1));
        low[a] = std::min(static_cast<std::size_t>(index), n[a] - std::min<std::size_t>(n[a], 2));
        part[a] = index - real(low[a]);
    }
    real sum = 0;
    for (std::size_t corner = 0; corner < std::size_t{1} << dim; ++corner) {
        std::array<std::size_t, 3> I{};
        real weight = 1;
        for (std::size_t a = 0; a < dim; ++a) {
            const std::size_t up = corner >> a & 1;
            I[a] = std::min(low[a] + up, n[a] - 1);
            weight *= up ? part[a] : 1 - part[a];
        }
        if (weight > 0) sum += weight * field.data[component][I[0] + n[0] * (I[1] + n[1] * I[2])];
    }
    return sum;
}

}  // namespace

Reconstruction::Reconstruction(const Options& options, const scene::Scene& scene)
    : options_(options),
      domain_{.flat = scene.dim() == 2},
      flat_solids_(domain_.flat ? geometry::Solids<2>(scene) : geometry::Solids<2>()),
      solids_(domain_.flat ? geometry::Solids<3>() : geometry::Solids<3>(scene)),
      field_(options.method, domain_.flat) {
    const auto lower = scene.root().numbers("grid.origin"), size = scene.root().numbers("grid.size");
    for (int a = 0; a < 3; ++a) {
        const bool endless = a == 2 && domain_.flat;
        domain_.lo[a] = endless ? -infinity : lower[static_cast<std::size_t>(a)];
        domain_.hi[a] = endless ? infinity : domain_.lo[a] + size[static_cast<std::size_t>(a)];
    }
    if (!scene.has("grid.periodic")) return;  // a study of walls only
    const auto repeat = [&]<int D>(const geometry::Sides<D>& sides) {
        for (int a = 0; a < D; ++a) domain_.periodic[static_cast<std::size_t>(a)] = sides.periodic(a);
    };
    domain_.flat ? repeat(geometry::Sides<2>(scene)) : repeat(geometry::Sides<3>(scene));
}

std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene) {
    const auto options = options_of(scene);
    if (options && !can_contour()) throw BadInput("output.surface: this weir was built without VTK (WEIR_VTK=OFF) and makes no surfaces");
    return options ? std::make_unique<Reconstruction>(*options, scene) : nullptr;
}

const SurfaceMesh& Reconstruction::make(const FieldSet& fields, real t) {
    in_parts_ = false;
    return make_from(fields, t);
}

const SurfaceMesh& Reconstruction::make_part(const FieldSet& fields, real t) {
    in_parts_ = communicator().several();
    make_from(fields, t);
    if (in_parts_) keep_own_part();
    return mesh_;
}

const SurfaceMesh& Reconstruction::make_from(const FieldSet& fields, real t) {
    mesh_.points.clear(), mesh_.corners.clear(), mesh_.lines.clear(), mesh_.velocity.clear();
    mesh_.first = 0, piece_ = {}, cut_ = {};
    flat_solids_.set_time(t), solids_.set_time(t);
    if (options_.method == Method::level_set)
        from_level_set(fields);
    else
        from_particles(fields);
    return mesh_;
}

void Reconstruction::from_level_set(const FieldSet& fields) {
    const FieldView* phi = fields.find(level_set_name);
    if (!phi) throw BadInput("there is no level set to reconstruct the surface from");
    const GridView& grid = fields.grid;
    {
        const auto timed = passes_.time("field");
        for (std::size_t a = 0; a < 3; ++a) {
            samples_.n[a] = grid.cells[a] + 2;
            samples_.spacing[a] = grid.spacing[a];
            samples_.first[a] = grid.origin[a] - 0.5 * grid.spacing[a];
        }
        if (domain_.flat) lay_plane();
        samples_.unit = std::min({samples_.spacing[0], samples_.spacing[1], samples_.spacing[2]});
        if (in_parts_) cut_by_planes(fields);
        samples_.make_room(cut_);
        const auto inside = [](int i, int n) { return static_cast<std::size_t>(std::clamp(i - 1, 0, n - 1)); };
        for_samples(samples_, samples_.own, [&](int i, int j, int k) {
            const std::size_t from = inside(i, grid.cells[0]) +
                                     static_cast<std::size_t>(grid.cells[0]) *
                                         (inside(j, grid.cells[1]) + static_cast<std::size_t>(grid.cells[1]) * inside(k, grid.cells[2]));
            samples_(i, j, k) = static_cast<float>(std::clamp(-phi->data[0][from] / samples_.unit, -1.0, 1.0));
        });
    }
    make_contour();
    add_velocity(fields);
}

void Reconstruction::from_particles(const FieldSet& fields) {
    const FieldView* position = particles_of(fields);
    if (!position) throw BadInput("there are no particles to reconstruct the surface from");
    const bool markers = position->set == marker_set_name;
    const Components own = in_parts_ ? part_of(fields, *position) : position->data;
    const FieldView* velocity = fields.find(position->set, "velocity");
    velocity_ = !velocity ? Components{} : in_parts_ ? part_of(fields, *velocity) : velocity->data;
    CloudExtent all;
    {
        const auto timed = passes_.time("particles");
        cloud_.spacing = fields.grid.spacing[0] / (markers ? markers_per_cell : 1);
        gather(own, domain_, band(), cloud_);
        all = in_parts_ ? extent_of_all(extent_of(cloud_)) : extent_of(cloud_);
        if (!all.finite) throw NumericalFailure("position", "a particle's position is not finite");
    }
    if (all.count == 0) {
        mesh_.normals.clear(), mesh_.thickness.clear();
        return;
    }
    {
        const auto timed = passes_.time("field");
        lay_samples(all);
        field_.lay(all.box, all.count, cloud_.spacing, samples_);
        if (in_parts_) {
            fields.cut ? cut_by_planes(fields) : cut_by_particles(own);
            share_particles(own);
        }
        samples_.make_room(cut_);
        field_.compute(cloud_, samples_);
        if (markers) fill_holes(fields);
    }
    make_contour();
    add_velocity(fields);
}

/// Images extend this far beyond a side.
real Reconstruction::band() const { return (reach + options_.cell) * cloud_.spacing; }

/// Random motion of markers leaves holes of one or two spacings inside the liquid. A level set, which does not resolve holes smaller than a
/// cell, shows the liquid there: samples one cell deep are set inside.
void Reconstruction::fill_holes(const FieldSet& fields) {
    const FieldView* phi = fields.find(level_set_name);
    if (!phi) return;
    const real deep = *std::min_element(fields.grid.spacing.begin(), fields.grid.spacing.begin() + fields.grid.dim);
    FieldView known = *phi;
    PlaneStore<real> beside;
    if (fields.cut) beside = with_planes_beside(fields, *phi), known.data = {{beside.data(), beside.size()}};
    for_samples(samples_, samples_.own, [&](int i, int j, int k) {
        float& depth = samples_(i, j, k);
        if (depth < 1 && value_at(known, fields.grid, 0, samples_.position(i, j, k)) < -deep) depth = 1;
    });
}

void Reconstruction::lay_plane() {
    samples_.n[2] = 1;
    samples_.first[2] = 0;
    samples_.spacing[2] = samples_.spacing[0];
}

/// Sides lie midway between samples where the domain is a whole number of cells wide. The ends of the lattice are outside.
void Reconstruction::lay_samples(const CloudExtent& all) {
    samples_.unit = cloud_.spacing;
    const real step = options_.cell * cloud_.spacing;
    if (domain_.flat) samples_.spacing[0] = step, lay_plane();
    for (std::size_t a = 0; a < (domain_.flat ? 2U : 3U); ++a) {
        const real beyond = 1.5 * cloud_.spacing;  // bound of the distance from surface to particles: half a spacing for a plane
        const real lo = domain_.lo[a], hi = domain_.hi[a];
        const auto number = [&](real x) { return std::floor((x - lo) / step - 0.5); };
        const real first = number(std::max(lo, all.least[a] - beyond));
        const real last = number(std::min(hi, all.most[a] + beyond)) + 1;
        samples_.spacing[a] = step;
        samples_.first[a] = lo + (first + 0.5) * step;
        samples_.n[a] = std::max(2, static_cast<int>(last - first) + 1);
    }
}

void Reconstruction::make_contour() {
    {
        const auto timed = passes_.time("prepare");
        samples_.exchange(cut_);
        keep_out_of(samples_, flat_solids_);
        keep_out_of(samples_, solids_);
        keep_inside(samples_, domain_.lo, domain_.hi);
        avoid_zero(samples_);
    }
    {
        const auto timed = passes_.time("contour");
        piece_ = domain_.flat ? contour_flat(samples_, mesh_) : contour(samples_, mesh_);
    }
    if (options_.method == Method::density && options_.smoothing > 0) smooth_by_crowding();
    const auto timed = passes_.time("normals and thickness");
    add_normals(mesh_);
    add_thickness(mesh_, piece_, samples_, cut_);
}

/// Smooths where many particles are near; drops and films keep their shape.
void Reconstruction::smooth_by_crowding() {
    const auto timed = passes_.time("smooth");
    std::vector<real> weight(piece_.points());
    parallel_for(0, static_cast<int>(weight.size()), [&](int p) {
        const Vec<3>& x = mesh_.points[piece_.begin + static_cast<std::size_t>(p)];
        bool at_side = false;  // its points are not moved
        for (int a = 0; a < 3; ++a) at_side = at_side || std::min(x[a] - domain_.lo[a], domain_.hi[a] - x[a]) < 1e-3 * samples_.unit;
        weight[static_cast<std::size_t>(p)] = at_side ? 0 : smoother_step(std::min(1.0, field_.crowding_at(x) / crowd));
    });
    smooth(mesh_, piece_, weight, options_.smoothing, cut_);
}

void Reconstruction::add_velocity(const FieldSet& fields) {
    const auto timed = passes_.time("velocity");
    const bool carried = options_.method != Method::level_set && !velocity_.empty();
    const FieldView* on_grid = carried ? nullptr : fields.find("", "velocity");
    const std::size_t dim = domain_.flat ? 2 : 3;
    if ((carried ? velocity_.size() : on_grid ? on_grid->data.size() : 0) < dim) return;
    std::array<std::span<const real>, 3> of_particles;
    if (carried) {
        for (std::size_t a = 0; a < dim; ++a) of_particles[a] = velocity_[a];
        if (domain_.flat) across_.assign(velocity_[0].size(), 0), of_particles[2] = across_;
    }
    const auto velocity_at = [&](const Vec<3>& x) {
        if (carried) return field_.velocity_at(x, of_particles);
        Vec<3> v{};
        for (std::size_t a = 0; a < dim; ++a) v[a] = value_at(*on_grid, fields.grid, a, x);
        return v;
    };
    mesh_.velocity.assign(mesh_.points.size(), Vec<3>{});
    parallel_for(0, static_cast<int>(piece_.points()), [&](int p) {
        const std::size_t at = piece_.begin + static_cast<std::size_t>(p);
        if (samples_.is_near(mesh_.points[at])) mesh_.velocity[at] = velocity_at(mesh_.points[at]);
    });
    if (!cut_.empty()) add_velocity_elsewhere(velocity_at);
}

std::size_t Reconstruction::bytes() const {
    std::size_t received = 0;
    for (const auto* lists : {&received_.x, &received_.v})
        for (const auto& list : *lists) received += list.capacity() * sizeof(real);
    return 3 * cloud_.x[0].capacity() * sizeof(real) + cloud_.source.capacity() * sizeof(int) + received + field_.bytes() +
           samples_.depth.bytes() + 3 * mesh_.points.capacity() * sizeof(Vec<3>) + mesh_.corners.capacity() * sizeof(mesh_.corners[0]) +
           mesh_.lines.capacity() * sizeof(mesh_.lines[0]) + across_.capacity() * sizeof(real) + mesh_.thickness.capacity() * sizeof(real);
}

}  // namespace weir::surfaces
