// Estimate of what a rank sends in a step of the solver "mac_water": the exchanges of solver.cpp and of surface/, pass by pass.
#include "poisson/traffic.hpp"
#include "free_surface/traffic.hpp"
#include "geometry/liquid_fraction.hpp"
#include "mac/grid/own_planes.hpp"
#include "water/solver.hpp"

#include <cmath>

namespace weir::water {

namespace {

/// Keys whose messages the estimate does not include.
std::vector<std::string> not_counted(const scene::Scene& scene) {
    std::vector<std::string> keys;
    const auto lists = [&](const char* key) { return scene.has(key) && !scene.root().tables(key).empty(); };
    for (const char* list : {"solids", "emitters", "probes"})
        if (lists(list)) keys.emplace_back(list);
    if (scene.effect("volume_control")) keys.emplace_back("effects.volume_control");
    if (scene.root().number_or("time.stop_when_steady", 0) > 0) keys.emplace_back("time.stop_when_steady");
    if (poisson::method_named(scene.text("scheme.poisson.method")).needs_petsc) keys.emplace_back("scheme.poisson.method");
    return keys;
}

template <int D>
class Step {
public:
    Step(const scene::Scene& scene, const RankOf& of, const StepShape& shape)
        : scene_(scene),
          sides_(scene),
          lattice_(scene),
          n_(lattice_.cells),
          transfer_(scene.text("scheme.transfer")),
          ring_(sides_.periodic(D - 1)),
          windowed_(mac::could_hold_own_planes(scene, of.cut)),
          shape_(shape),
          reach_(std::min(n_[D - 1], shape.cells_crossed + 3)),
          surface_(n_, lattice_.h, scene.number("time.cfl"), ring_),
          cells_(surface_.cells),
          faces_(surface_.faces),
          tally_(of.cut, of.rank, ring_) {
        for (int a = 0; a < D; ++a) {
            const real ratio = lattice_.h[0] / lattice_.h[a];
            weight_[a] = ratio * ratio, periodic_[static_cast<std::size_t>(a)] = sides_.periodic(a);
        }
    }

    StepTraffic sent() {
        move();
        find_surface();
        sync();  // velocity from the markers, at walls
        surface_.continue_velocity(tally_, 2);
        sync();
        sync();  // after the forces
        if (viscous()) apply_viscosity();
        project();
        surface_.continue_velocity(tally_, surface_.layers - 1);
        sync();
        for (int a = 0; a < D; ++a) largest(faces_[static_cast<std::size_t>(a)].count);  // the maximum speed
        if (transfer_ != "grid") tally_.refresh(faces_, 1);                              // the velocity, or FLIP's difference
        tally_.everywhere(sizeof(int), 1, sizeof(int));                                  // finite check
        tally_run(tally_);
        tally_.sent().besides = not_counted(scene_);
        return tally_.sent();
    }

private:
    bool viscous() const { return scene_.effect("viscosity") && scene_.number("fluid.viscosity") > 0; }
    void sync() { tally_.refresh({faces_[D - 1]}, 1); }
    void largest(int planes) { tally_.gather({sizeof(real), planes}); }

    void move() {
        largest(faces_[D - 1].count);
        tally_.refresh(faces_, reach_);
        tally_.refresh({cells_}, reach_, 2);  // the level set, before and after it moves
        migrate();
    }
    /// Migrating markers, and ghost markers of the planes at the subdomain boundaries.
    void migrate() {
        const int ranks = tally_.cut().ranks(), rank = tally_.rank();
        const std::size_t row = sizeof(int) * static_cast<std::size_t>(ranks);
        tally_.everywhere(row, 1, row * static_cast<std::size_t>(ranks));
        bool open = false;
        for (int a = 0; a < D; ++a) open = open || sides_.open(a, 0) || sides_.open(a, 1);
        const int numbers = D + (transfer_ == "grid" ? 0 : D) + (transfer_ == "apic" ? D * D : 0);
        const auto bytes_in = [&](int at) {
            const double markers =
                geometry::liquid_fraction_of_plane<D>(scene_, at) * static_cast<double>(cells_.bytes / sizeof(real)) * Markers<D>::per_cell;
            return static_cast<std::size_t>(std::llround(markers)) * static_cast<std::size_t>(numbers) * sizeof(real);
        };
        const int first = tally_.cut().begin(rank), last = tally_.cut().end(rank, n_[D - 1]) - 1;
        if (rank > 0 || ring_) tally_.message(bytes_in(first));
        if (rank + 1 < ranks || ring_) tally_.message(bytes_in(last));
        if (open) tally_.everywhere(sizeof(std::int64_t), 2, sizeof(std::int64_t) * static_cast<std::size_t>(ranks));
    }
    /// Redistancing; then the liquid flags and the matrix.
    void find_surface() {
        surface_.liquid_parts(tally_);
        surface_.distance(tally_);
        if (scene_.effect("surface_tension")) tally_.refresh({cells_}, 1);  // curvature
        if (!windowed_) return tally_.gather(cells_);
        Index<D> lines = n_;
        lines[0] = 1;
        const auto ranks = static_cast<std::size_t>(tally_.cut().ranks());
        tally_.everywhere(sizeof(std::int64_t), 1, sizeof(std::int64_t) * ranks);  // whether there is liquid
        tally_.refresh({plane_of<D>(n_, sizeof(poisson::Cell)), plane_of<D>(lines, sizeof(Segment))}, 2);
        sync();  // weights above the last cells
    }
    /// Velocity and liquid fractions at the subdomain boundaries; then per iteration a direction and two inner products.
    void apply_viscosity() {
        tally_.refresh(faces_, 1);
        tally_.refresh({cells_}, 2);
        continue_with_pressure();
        tally_.refresh(faces_, 1, shape_.viscous_iterations);
        tally_.gather({sizeof(real), faces_[D - 1].count}, 1 + shape_.viscous_coupling_iterations + 2 * shape_.viscous_iterations);
        sync(), sync();
    }
    /// Marks and values, two layers.
    void continue_with_pressure() { tally_.refresh(faces_, 1, 4); }
    /// Coupling iterations of friction and pressure. The estimate is low by some four messages in a thousand where there are any: norms,
    /// mixing of pressures, and the velocity at subdomain boundaries.
    void balance_friction() {
        const int iterations = shape_.viscous_coupling_iterations;
        for (int iteration = 0; iteration <= iterations; ++iteration) {
            continue_with_pressure();
            tally_.gather({sizeof(real), faces_[D - 1].count}, 4);
            tally_.refresh(faces_, 1);
            if (iteration == iterations) return;
            const int mixed = std::min(iteration - 1, AndersonMixing<D>::depth);
            if (iteration > 0) tally_.gather({sizeof(real), n_[D - 1]}, mixed * (mixed + 3) / 2);
            if (iteration > 0) tally_.refresh({cells_}, 1), continue_with_pressure();
            sync(), sync(), sync();
            solve(1);
        }
    }
    /// Rows of this rank that contain liquid at the start, one run each; and those of the plane below.
    poisson::Runs runs() const {
        const int first = tally_.cut().begin(tally_.rank()), end = tally_.cut().end(tally_.rank(), n_[D - 1]);
        const int rows = D == 2 ? 1 : n_[1];
        const auto wet = [&](int at) { return std::llround(geometry::liquid_fraction_of_plane<D>(scene_, at) * rows); };
        poisson::Runs runs;
        for (int at = first; at < end; ++at) runs.own += static_cast<std::size_t>(wet(at));
        if (tally_.rank() > 0) runs.below = static_cast<std::size_t>(wet(first - 1));
        return runs;
    }
    void solve(int iterations) {
        if (!windowed_) return tally_.gather(cells_, 2);  // right-hand side and guess: replicated solve
        poisson::tally_multigrid<D>(n_, periodic_, weight_, false, iterations, tally_);
        tally_.refresh({cells_}, 1);
    }
    void project() {
        if (windowed_) poisson::tally_multigrid_setup<D>(n_, periodic_, weight_, runs(), tally_);
        solve(shape_.iterations - shape_.viscous_coupling_iterations);
        if (viscous()) balance_friction();
        sync();
        largest(n_[D - 1]);  // maximum divergence
    }

    const scene::Scene& scene_;
    geometry::Sides<D> sides_;
    mac::Lattice<D> lattice_;
    Index<D> n_;
    std::string transfer_;
    bool ring_, windowed_;
    StepShape shape_;
    int reach_;
    SurfaceTally<D> surface_;
    PlaneSize cells_;
    std::array<PlaneSize, D> faces_;
    Vec<D> weight_;
    std::array<bool, D> periodic_;
    Tally tally_;
};

}  // namespace

StepTraffic traffic_of_step(const scene::Scene& scene, const RankOf& of, const StepShape& shape) {
    return scene.dim() == 2 ? Step<2>(scene, of, shape).sent() : Step<3>(scene, of, shape).sent();
}

}  // namespace weir::water
