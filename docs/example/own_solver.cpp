// A user-defined solver and effect outside the tree of weir: heat conduction on a grid, and a heater. Registration is sufficient: scenes,
// messages, probes, checkpoints, --set and the other parts of weir then support them.
//
//   dT/dt = alpha (d2T/dx2 + d2T/dy2) + heating        explicit Euler, stable for dt <= h^2 / (4 alpha)
#include <weir/core/effects.hpp>
#include <weir/sim/registry.hpp>
#include <weir/sim/simulation.hpp>

#include <algorithm>
#include <cstdio>

namespace {

using weir::real;

/// The state of the solver, on which its effects act.
struct Plate {
    weir::GridView grid;
    std::vector<real> temperature;  // at cell centres, x fastest [K]
    real time = 0;                  // [s]
};

/// dT/dt = rate in a disc
struct Heater final : weir::Effect<Plate> {
    explicit Heater(const weir::scene::Table& table)
        : centre(table.vec<2>("centre")), radius(table.number("radius")), rate(table.number("rate")) {}
    weir::Stage stage() const override { return weir::Stage::source; }
    void apply(Plate& plate, real dt) override {
        std::size_t i = 0;
        for (int y = 0; y < plate.grid.cells[1]; ++y)
            for (int x = 0; x < plate.grid.cells[0]; ++x, ++i) {
                const real dx = (x + 0.5) * plate.grid.spacing[0] - centre[0], dy = (y + 0.5) * plate.grid.spacing[1] - centre[1];
                if (dx * dx + dy * dy < radius * radius) plate.temperature[i] += rate * dt;
            }
    }
    weir::Vec<2> centre;
    real radius, rate;  // [m], [K/s]
};

class Spreading final : public weir::Solver {
public:
    explicit Spreading(const weir::scene::Scene& scene) : alpha_(scene.number("alpha")) {
        const auto cells = scene.index<2>("grid.cells");
        const auto size = scene.vec<2>("grid.size");
        plate_.grid.dim = 2;
        for (const std::size_t a : {0u, 1u}) {
            plate_.grid.cells[a] = cells[static_cast<int>(a)];
            plate_.grid.spacing[a] = size[a] / cells[static_cast<int>(a)];
        }
        plate_.temperature.assign(static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]), scene.number("start"));
        if (const auto* heater = scene.effect("heater")) effects_.add("heater", std::make_unique<Heater>(*heater));
    }
    weir::StepReport step(real dt) override {
        effects_.apply(weir::Stage::source, plate_, dt, passes_);
        const auto timed = passes_.time("spread");
        const int nx = plate_.grid.cells[0], ny = plate_.grid.cells[1];
        const std::vector<real> old = plate_.temperature;
        const auto at = [&](int x, int y) {  // adiabatic walls
            return old[static_cast<std::size_t>(std::clamp(y, 0, ny - 1) * nx + std::clamp(x, 0, nx - 1))];
        };
        const real h = plate_.grid.spacing[0], k = plate_.grid.spacing[1];
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                plate_.temperature[static_cast<std::size_t>(y * nx + x)] +=
                    dt * alpha_ *
                    ((at(x + 1, y) - 2 * at(x, y) + at(x - 1, y)) / (h * h) + (at(x, y + 1) - 2 * at(x, y) + at(x, y - 1)) / (k * k));
        plate_.time += dt;
        return {.dt = dt};
    }
    real advised_dt() const override { return 0.5 * stable_dt().dt; }
    weir::StepLimit stable_dt() const override {
        const real h = *std::min_element(plate_.grid.spacing.begin(), plate_.grid.spacing.begin() + 2);
        return {h * h / (4 * alpha_), "explicit conduction is stable up to it"};
    }
    weir::FieldSet fields() const override { return {plate_.grid, {{"temperature", "K", weir::Where::cell, "", {plate_.temperature}}}}; }
    std::vector<weir::EditableField> editable() override { return {{"", "temperature", {plate_.temperature}}}; }
    std::vector<weir::Integral> integrals() const override {
        real sum = 0;
        for (const real t : plate_.temperature) sum += t * plate_.grid.spacing[0] * plate_.grid.spacing[1];
        return {{"heat", "K m^2", sum}};
    }
    real time() const override { return plate_.time; }
    void save(weir::Checkpoint& to) const override {
        to.put("temperature", plate_.temperature);
        to.put_value("time", plate_.time);
    }
    void restore(const weir::Checkpoint& from) override {
        from.get("temperature", plate_.temperature);
        plate_.time = from.get_value<real>("time");
    }
    const weir::Passes& passes() const override { return passes_; }
    weir::Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return plate_.temperature.size() * sizeof(real); }
    std::vector<weir::EffectPlan> effects() const override { return effects_.plans(); }

private:
    Plate plate_;
    real alpha_;  // [m^2/s]
    weir::Effects<Plate> effects_{"spreading", {weir::Stage::source}};
    weir::Passes passes_;
};

/// The registration: the schema of its keys and effects, and the factory function.
weir::scene::SolverKind spreading() {
    using weir::scene::Type;
    weir::scene::SolverKind kind;
    kind.schema.name = "spreading";
    kind.schema.doc = "Heat spreads on a plate.";
    kind.schema.dims = {2};
    kind.schema.keys = {
        {.name = "alpha", .doc = "Diffusivity.", .unit = "m^2/s", .required = true, .min = 0.0, .min_open = true, .steerable = true},
        {.name = "start", .doc = "Temperature at the start.", .unit = "K", .fallback = 293.0}};
    kind.schema.effects = {
        {.name = "heater",
         .doc = "Heats a disc.",
         .keys = {{.name = "centre", .type = Type::numbers, .doc = "Of the disc.", .unit = "m", .required = true, .length = -1},
                  {.name = "radius", .doc = "Of the disc.", .unit = "m", .required = true, .min = 0.0, .min_open = true},
                  {.name = "rate", .doc = "How fast it warms.", .unit = "K/s", .required = true}},
         .strength = {"rate"}}};
    kind.make = [](const weir::scene::Scene& scene, const weir::Partition&) { return std::make_unique<Spreading>(scene); };
    return kind;
}

const char* const text = R"(
solver  = "spreading"
dim     = 2
grid    = { cells = [32, 32], size = [1.0, 1.0] }
time    = { end = 2.0 }
alpha   = 0.01
effects = { heater = { centre = [0.5, 0.5], radius = 0.2, rate = 10.0 } }
probes  = [ { name = "corner", kind = "point", at = [0.02, 0.02], field = "temperature" } ]
)";

}  // namespace

int main() try {
    const std::vector<weir::scene::SolverKind> kinds{spreading()};
    const auto schemas = weir::scene::schemas_of(kinds);
    weir::Simulation simulation(weir::scene::parse(text, "plate.toml", schemas), kinds);
    simulation.run_until(1.0);
    simulation.set("alpha", 0.02);  // steerable, see the schema
    simulation.run_until(2.0);
    const auto temperature = simulation.fields().find("temperature")->data[0];
    double mean = 0;
    for (const double t : temperature) mean += t / static_cast<double>(temperature.size());
    std::printf("t = %g s, %lld steps, mean T = %.6f K, corner T = %.3f K\n", simulation.time(), static_cast<long long>(simulation.steps()),
                mean, simulation.probe_series("corner").column("temperature").back());
    try {  // as for every solver: a misspelt key is refused with a suggestion
        weir::scene::parse(std::string(text) + "alhpa = 1\n", "plate.toml", schemas);
    } catch (const weir::BadInput& why) {
        std::printf("%s\n", why.what());
    }
} catch (const weir::BadInput& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
