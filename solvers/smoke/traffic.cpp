// Estimate of what a rank sends in a step of the solver "mac": the exchanges of solver.cpp, pass by pass.
#include "poisson/traffic.hpp"
#include "mac/grid/own_planes.hpp"
#include "smoke/solver.hpp"

namespace weir::smoke {

namespace {

/// The sizes of a scene's arrays that messages depend on.
template <int D>
struct Sizes {
    PlaneSize cells, padded_cells, number;  // one value per cell, without and with ghosts; one number per plane
    std::array<PlaneSize, D> faces{}, padded{};
    explicit Sizes(const Index<D>& n) : cells(plane(n, 0)), padded_cells(plane(n, ghost_layers)), number{sizeof(real), n[D - 1]} {
        for (int a = 0; a < D; ++a) {
            faces[static_cast<std::size_t>(a)] = plane(n + e<D>(a), 0);
            padded[static_cast<std::size_t>(a)] = plane(n + e<D>(a), ghost_layers);
        }
    }
    static PlaneSize plane(const Index<D>& n, int ghosts) {
        std::size_t bytes = sizeof(real);
        for (int d = 0; d + 1 < D; ++d) bytes *= static_cast<std::size_t>(n[d] + 2 * ghosts);
        return {bytes, n[D - 1]};
    }
};

/// Keys whose messages the estimate does not include.
std::vector<std::string> not_counted(const scene::Scene& scene) {
    std::vector<std::string> keys;
    const auto lists = [&](const char* key) { return scene.has(key) && !scene.root().tables(key).empty(); };
    if (lists("solids")) keys.emplace_back("solids");
    if (scene.text("scheme.advection") != "maccormack") keys.emplace_back("scheme.advection");
    for (const char* effect : {"viscosity", "diffusion", "cooling", "decay"})
        if (scene.effect(effect)) keys.push_back(std::string("effects.") + effect);
    if (lists("probes")) keys.emplace_back("probes");
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
          size_(lattice_.cells),
          effects_(make_effects<D>(effect_kinds(), scene, all_stages)),
          shape_(shape),
          fields_(static_cast<std::int64_t>(field_plan(effects_, scene).advected_fields().size())),
          deep_(planes_reached(shape.cells_crossed, lattice_.cells[D - 1])),
          tally_(of.cut, of.rank, sides_.periodic(D - 1)) {}

    StepTraffic sent() {
        remember();
        advect();
        forces();
        project();
        report();
        tally_run(tally_);
        tally_.sent().besides = not_counted(scene_);
        return tally_.sent();
    }

private:
    std::vector<PlaneSize> every(const std::array<PlaneSize, D>& components, const PlaneSize& field) const {
        std::vector<PlaneSize> all(components.begin(), components.end());
        all.insert(all.end(), static_cast<std::size_t>(fields_), field);
        return all;
    }
    /// Faces beyond the subdomain boundary, after changes.
    void sync() { tally_.refresh({size_.faces[D - 1]}, 1); }
    void refresh_fields() {
        if (fields_ > 0) tally_.refresh(std::vector<PlaneSize>(static_cast<std::size_t>(fields_), size_.cells), 1);
    }
    void largest_velocity() {
        for (int a = 0; a < D; ++a) tally_.gather({sizeof(real), size_.faces[static_cast<std::size_t>(a)].count});
    }
    void remember() {
        largest_velocity();
        tally_.refresh(every(size_.padded, size_.padded_cells), deep_);
        refresh_fields();
        if (!effects_.empty(Stage::implicit) || !effects_.empty(Stage::force)) sync();
    }
    /// Advected values to the depth of trajectories, and predicted ones: one plane where no trajectory is longer than a cell.
    void advect() {
        const int predicted = shape_.cells_crossed <= 1 && scene_.text("scheme.interpolation") == "linear" ? 1 : deep_;
        if (fields_ > 0) tally_.refresh(std::vector<PlaneSize>(static_cast<std::size_t>(fields_), size_.padded_cells), predicted);
        tally_.refresh(size_.padded, deep_);
        for (const PlaneSize& component : size_.padded) tally_.refresh({component}, predicted);
        sync();
    }
    void forces() {
        refresh_fields();
        if (scene_.effect("confinement")) tally_.refresh({size_.cells}, 1, 2);  // the vorticity's magnitude, the force
        constexpr int asked = 2;  // computations of the step limit: for the step, and for the longest one of the run
        if (const auto* buoyancy = scene_.effect("buoyancy"); buoyancy && !scene_.has("time.dt"))
            for (const char* constant : {"alpha", "beta"})
                if (buoyancy->number(constant) != 0) tally_.gather(size_.number, asked);  // the maximum buoyancy
        sync();
    }
    void project() {
        bool closed = true;
        Vec<D> weight;
        std::array<bool, D> periodic;
        for (int a = 0; a < D; ++a) {
            const real ratio = lattice_.h[0] / lattice_.h[a];
            weight[a] = ratio * ratio, periodic[static_cast<std::size_t>(a)] = sides_.periodic(a);
            closed = closed && !sides_.open(a, 0) && !sides_.open(a, 1);
        }
        if (mac::could_hold_own_planes(scene_, tally_.cut())) {
            poisson::tally_multigrid<D>(lattice_.cells, periodic, weight, closed, shape_.iterations, tally_);
            tally_.refresh({size_.cells}, 1);
        } else {
            tally_.gather(size_.cells, 2);  // right-hand side and guess: replicated solve
        }
        sync();
    }
    void report() {
        largest_velocity();
        tally_.gather(size_.number, 2 + fields_);  // finite checks of the pressure and the fields; maximum divergence
    }

    const scene::Scene& scene_;
    geometry::Sides<D> sides_;
    Lattice<D> lattice_;
    Sizes<D> size_;
    Effects<MacState<D>> effects_;
    StepShape shape_;
    std::int64_t fields_;
    int deep_;
    Tally tally_;
};

}  // namespace

StepTraffic traffic_of_step(const scene::Scene& scene, const RankOf& of, const StepShape& shape) {
    return scene.dim() == 2 ? Step<2>(scene, of, shape).sent() : Step<3>(scene, of, shape).sent();
}

}  // namespace weir::smoke
