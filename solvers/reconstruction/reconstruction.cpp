#include "reconstruction/reconstruction.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/sides.hpp"
#include "reconstruction/contour.hpp"
#include "reconstruction/contour_flat.hpp"
#include "reconstruction/finish.hpp"
#include "reconstruction/prepare.hpp"

#include <algorithm>
#include <cmath>

namespace weir::reconstruction {

namespace {

/// Others near that make a particle one of many: a lattice has 12.5 (Loeschner et al. 2023 take 13).
constexpr real crowd = 13;
/// Markers of a grid along an edge of a cell.
constexpr real markers_a_cell = 2;

/// Of a flat liquid: a stretched kernel reaches 3.75 spacings, and one that was pulled inwards for want of neighbours a spacing more. Those
/// up to 4 layers away must have all of theirs within three; those from 5 on then do not reach the slice.
constexpr int layers_beside = 6;
static_assert(layers_beside >= 4 + far_reach - 1 && 5 - farthest_move >= longest * far_reach);

/// 0 at 0, 1 at 1, with two derivatives of zero at both (Loeschner et al. 2023, section 3.2).
real smoother_step(real s) { return s * s * s * (s * (6 * s - 15) + 10); }

const FieldView* particles_of(const FieldSet& fields) {
    const FieldView* markers = fields.find(marker_set_name, "position");
    return markers ? markers : fields.find(particle_set_name, "position");
}

/// A component of a velocity on faces or in cells, or a number in cells, trilinear.
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
      flat_(scene.dim() == 2),
      flat_solids_(flat_ ? geometry::Solids<2>(scene.root().tables("solids")) : geometry::Solids<2>()),
      solids_(flat_ ? geometry::Solids<3>() : geometry::Solids<3>(scene.root().tables("solids"))),
      field_(options.method, flat_) {
    const auto lower = scene.root().numbers("grid.origin"), size = scene.root().numbers("grid.size");
    for (int a = 0; a < 3; ++a) {
        const bool endless = a == 2 && flat_;
        lo_[a] = endless ? -infinity : lower[static_cast<std::size_t>(a)];
        hi_[a] = endless ? infinity : lo_[a] + size[static_cast<std::size_t>(a)];
    }
    if (!scene.has("grid.periodic")) return;  // a study of walls alone
    const auto repeat = [&]<int D>(const geometry::Sides<D>& sides) {
        for (int a = 0; a < D; ++a) periodic_[static_cast<std::size_t>(a)] = sides.periodic(a);
    };
    flat_ ? repeat(geometry::Sides<2>(scene)) : repeat(geometry::Sides<3>(scene));
}

std::unique_ptr<Reconstruction> reconstruction_of(const scene::Scene& scene) {
    const auto options = options_of(scene);
    if (options && !can_contour()) throw BadInput("output.surface: this weir was built without VTK (WEIR_VTK=OFF) and makes no surfaces");
    return options ? std::make_unique<Reconstruction>(*options, scene) : nullptr;
}

const SurfaceMesh& Reconstruction::make(const FieldSet& fields, real t) {
    mesh_.points.clear(), mesh_.corners.clear(), mesh_.lines.clear(), mesh_.velocity.clear();
    flat_solids_.set_time(t), solids_.set_time(t);
    if (options_.method == Method::level_set)
        from_level_set(fields);
    else
        from_particles(fields);
    return mesh_;
}

void Reconstruction::from_level_set(const FieldSet& fields) {
    const FieldView* phi = fields.find(level_set_name);
    if (!phi) throw BadInput("there is no level set to take the surface of");
    const GridView& grid = fields.grid;
    {
        const auto timed = passes_.time("field");
        for (std::size_t a = 0; a < 3; ++a) {
            samples_.n[a] = grid.cells[a] + 2;
            samples_.spacing[a] = grid.spacing[a];
            samples_.first[a] = grid.origin[a] - 0.5 * grid.spacing[a];
        }
        if (flat_) lay_plane();
        samples_.unit = std::min({samples_.spacing[0], samples_.spacing[1], samples_.spacing[2]});
        samples_.depth.resize(samples_.linear(0, 0, samples_.n[2]));
        const auto inside = [](int i, int n) { return static_cast<std::size_t>(std::clamp(i - 1, 0, n - 1)); };
        parallel_for(0, samples_.n[2], [&](int k) {
            for (int j = 0; j < samples_.n[1]; ++j)
                for (int i = 0; i < samples_.n[0]; ++i) {
                    const std::size_t from =
                        inside(i, grid.cells[0]) +
                        static_cast<std::size_t>(grid.cells[0]) *
                            (inside(j, grid.cells[1]) + static_cast<std::size_t>(grid.cells[1]) * inside(k, grid.cells[2]));
                    samples_.depth[samples_.linear(i, j, k)] =
                        static_cast<float>(std::clamp(-phi->data[0][from] / samples_.unit, -1.0, 1.0));
                }
        });
    }
    make_contour();
    add_velocity(fields);
}

void Reconstruction::from_particles(const FieldSet& fields) {
    const FieldView* position = particles_of(fields);
    if (!position) throw BadInput("there are no particles to make a surface of");
    const bool markers = position->set == marker_set_name;
    {
        const auto timed = passes_.time("particles");
        gather(*position, fields.grid.spacing[0] / (markers ? markers_a_cell : 1));
    }
    if (cloud_.count() == 0) {
        mesh_.normals.clear(), mesh_.thickness.clear();
        return;
    }
    {
        const auto timed = passes_.time("field");
        lay_samples();
        field_.compute(cloud_, samples_);
        if (markers) fill_holes(fields);
    }
    make_contour();
    add_velocity(fields);
}

/// The particles, and images of those near a side: the liquid goes on beyond a wall, or repeats, so that its surface meets the side as it
/// would meet more liquid.
void Reconstruction::gather(const FieldView& position, real spacing) {
    cloud_.spacing = spacing;
    cloud_.own = static_cast<int>(position.data[0].size());
    for (std::size_t a = 0; a < position.data.size(); ++a) cloud_.x[a].assign(position.data[a].begin(), position.data[a].end());
    if (flat_) cloud_.x[2].assign(cloud_.x[0].size(), 0);
    cloud_.source.clear();
    for (std::size_t a = 0; a < position.data.size(); ++a) add_images(a);
    if (flat_) add_layers();
}

void Reconstruction::add_images(std::size_t axis) {
    const real band = (reach + options_.cell) * cloud_.spacing;
    const int count = cloud_.count();
    const auto put = [&](int i, real x) {
        for (std::size_t a = 0; a < 3; ++a) cloud_.x[a].push_back(a == axis ? x : cloud_.x[a][static_cast<std::size_t>(i)]);
        cloud_.source.push_back(cloud_.particle(i));
    };
    for (int i = 0; i < count; ++i) {
        const real x = cloud_.x[axis][static_cast<std::size_t>(i)], size = hi_[axis] - lo_[axis];
        if (x - lo_[axis] < band && x >= lo_[axis]) put(i, periodic_[axis] ? x + size : 2 * lo_[axis] - x);
        if (hi_[axis] - x < band && x <= hi_[axis]) put(i, periodic_[axis] ? x - size : 2 * hi_[axis] - x);
    }
}

/// A flat liquid is a slice of one that goes on for ever: its particles again, a spacing in front and behind, as far as they count.
void Reconstruction::add_layers() {
    const int count = cloud_.count();
    for (auto& x : cloud_.x) x.reserve(static_cast<std::size_t>((2 * layers_beside + 1) * count));
    cloud_.source.reserve(cloud_.x[0].capacity());
    for (int layer = -layers_beside; layer <= layers_beside; ++layer)
        for (int i = 0; i < count && layer != 0; ++i) {
            for (std::size_t a = 0; a < 2; ++a) cloud_.x[a].push_back(cloud_.x[a][static_cast<std::size_t>(i)]);
            cloud_.x[2].push_back(layer * cloud_.spacing);
            cloud_.source.push_back(cloud_.particle(i));
        }
}

/// Markers part by chance, and leave holes of a spacing or two inside the liquid. A level set beside them, which sees no holes smaller than
/// a cell, tells that there is liquid: what lies a cell deep is inside.
void Reconstruction::fill_holes(const FieldSet& fields) {
    const FieldView* phi = fields.find(level_set_name);
    if (!phi) return;
    const real deep = *std::min_element(fields.grid.spacing.begin(), fields.grid.spacing.begin() + fields.grid.dim);
    parallel_for(0, samples_.n[2], [&](int k) {
        for (int j = 0; j < samples_.n[1]; ++j)
            for (int i = 0; i < samples_.n[0]; ++i) {
                float& depth = samples_.depth[samples_.linear(i, j, k)];
                if (depth < 1 && value_at(*phi, fields.grid, 0, samples_.position(i, j, k)) < -deep) depth = 1;
            }
    });
}

void Reconstruction::lay_plane() {
    samples_.n[2] = 1;
    samples_.first[2] = 0;
    samples_.spacing[2] = samples_.spacing[0];
}

/// Sides lie midway between samples where the domain is a whole number of cells wide. The ends of the lattice are outside.
void Reconstruction::lay_samples() {
    samples_.unit = cloud_.spacing;
    const real step = options_.cell * cloud_.spacing;
    if (flat_) samples_.spacing[0] = step, lay_plane();
    for (std::size_t a = 0; a < (flat_ ? 2U : 3U); ++a) {
        const auto [least, most] = std::minmax_element(cloud_.x[a].begin(), cloud_.x[a].begin() + cloud_.own);
        const real beyond = 1.5 * cloud_.spacing;  // no surface is farther from all particles: a plane's is half a spacing away
        const auto number = [&](real x) { return std::floor((x - lo_[a]) / step - 0.5); };
        const real first = number(std::max(lo_[a], *least - beyond));
        const real last = number(std::min(hi_[a], *most + beyond)) + 1;
        samples_.spacing[a] = step;
        samples_.first[a] = lo_[a] + (first + 0.5) * step;
        samples_.n[a] = std::max(2, static_cast<int>(last - first) + 1);
    }
}

void Reconstruction::make_contour() {
    {
        const auto timed = passes_.time("prepare");
        keep_out_of(samples_, flat_solids_);
        keep_out_of(samples_, solids_);
        keep_inside(samples_, lo_, hi_);
        avoid_zero(samples_);
    }
    {
        const auto timed = passes_.time("contour");
        flat_ ? contour_flat(samples_, mesh_) : contour(samples_, mesh_);
    }
    if (options_.method == Method::density && options_.smoothing > 0) smooth_by_crowding();
    const auto timed = passes_.time("normals and thickness");
    add_normals(mesh_);
    add_thickness(mesh_, samples_);
}

/// Many particles near: smooth. Few: a drop or a film keeps its shape.
void Reconstruction::smooth_by_crowding() {
    const auto timed = passes_.time("smooth");
    std::vector<real> weight(mesh_.points.size());
    parallel_for(0, static_cast<int>(weight.size()), [&](int p) {
        const auto at = static_cast<std::size_t>(p);
        bool at_side = false;  // its points stay where they are
        for (int a = 0; a < 3; ++a)
            at_side = at_side || std::min(mesh_.points[at][a] - lo_[a], hi_[a] - mesh_.points[at][a]) < 1e-3 * samples_.unit;
        weight[at] = at_side ? 0 : smoother_step(std::min(1.0, field_.crowding_at(mesh_.points[at]) / crowd));
    });
    smooth(mesh_, weight, options_.smoothing);
}

void Reconstruction::add_velocity(const FieldSet& fields) {
    const auto timed = passes_.time("velocity");
    const FieldView* position = options_.method == Method::level_set ? nullptr : particles_of(fields);
    const FieldView* v = position ? fields.find(position->set, "velocity") : fields.find("", "velocity");
    const bool on_grid = v && v->where != Where::particle;
    if (!v && position && fields.find("", "velocity")) v = fields.find("", "velocity");
    const std::size_t dim = flat_ ? 2 : 3;
    if (!v || v->data.size() < dim) return;
    if (flat_) across_.assign(v->data[0].size(), 0);
    mesh_.velocity.resize(mesh_.points.size());
    parallel_for(0, static_cast<int>(mesh_.points.size()), [&](int p) {
        const auto at = static_cast<std::size_t>(p);
        if (on_grid)
            for (std::size_t a = 0; a < dim; ++a) mesh_.velocity[at][a] = value_at(*v, fields.grid, a, mesh_.points[at]);
        else
            mesh_.velocity[at] = field_.velocity_at(mesh_.points[at], {v->data[0], v->data[1], flat_ ? across_ : v->data[2]});
    });
}

std::size_t Reconstruction::bytes() const {
    return 3 * cloud_.x[0].capacity() * sizeof(real) + cloud_.source.capacity() * sizeof(int) + field_.bytes() +
           samples_.depth.capacity() * sizeof(float) + 3 * mesh_.points.capacity() * sizeof(Vec<3>) +
           mesh_.corners.capacity() * sizeof(mesh_.corners[0]) + mesh_.lines.capacity() * sizeof(mesh_.lines[0]) +
           across_.capacity() * sizeof(real) + mesh_.thickness.capacity() * sizeof(real);
}

}  // namespace weir::reconstruction
