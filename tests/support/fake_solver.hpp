// A solver without physics: it shows the fields of the real water solver, by the same names, with values that change by a rule known
// exactly, so that the time loop, probes, output and restarts can be tested apart from any fluid. Its advised step varies from step to
// step; at step `fail_at` it yields a NaN, and after step `stall_at` its advised step is nothing. It calls steps up to `stable_dt` stable,
// and is concerned after step 2.
#pragma once
#include "core/solver.hpp"
#include "scene/solver_kind.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace weir::test {

/// What the solver "mac_water" shows, read off a small one: names, units, places and sets, without their data.
inline const std::vector<FieldView>& fields_of_water(int dim) {
    static const auto read = [](int d) {
        const bool flat = d == 2;
        const Simulation real(scene::parse(
            "solver = \"mac_water\"\ndim = " + std::to_string(d) + "\ngrid = { cells = " + (flat ? "[4, 4]" : "[4, 4, 4]") +
                ", size = " + (flat ? "[1, 1]" : "[1, 1, 1]") + " }\ntime = { end = 1 }\nliquid = [ { shape = \"box\", min = " +
                (flat ? "[0, 0], max = [1, 0.5]" : "[0, 0, 0], max = [1, 0.5, 1]") + " } ]\n",
            "real.toml", sim::schemas()));
        auto fields = real.fields().fields;
        for (auto& field : fields) field.data.clear();
        return fields;
    };
    static const std::vector<FieldView> in_2d = read(2), in_3d = read(3);
    return dim == 2 ? in_2d : in_3d;
}

class FakeSolver : public Solver {
public:
    explicit FakeSolver(const scene::Scene& scene)
        : dim_(scene.dim()),
          fail_at_(scene.integer("fail_at")),
          stall_at_(scene.integer("stall_at")),
          stable_dt_(scene.root().number_or("stable_dt", infinity)) {
        grid_.dim = dim_;
        const auto cells = scene.index<3>("grid.cells");
        const auto size = scene.vec<3>("grid.size"), origin = scene.vec<3>("grid.origin");
        for (int a = 0; a < dim_; ++a) {
            const auto at = static_cast<std::size_t>(a);
            grid_.cells[at] = cells[a];
            grid_.origin[at] = origin[a];
            grid_.spacing[at] = size[a] / cells[a];
        }
        const std::size_t n =
            static_cast<std::size_t>(grid_.cells[0]) * static_cast<std::size_t>(grid_.cells[1]) * static_cast<std::size_t>(grid_.cells[2]);
        for (int a = 0; a < dim_; ++a) faces_.emplace_back(n / static_cast<std::size_t>(cells[a]) * static_cast<std::size_t>(cells[a] + 1));
        level_set_.resize(n), pressure_.resize(n);
        for (int a = 0; a < dim_; ++a) positions_.emplace_back(10), still_.emplace_back(10);
        fill();
    }
    StepReport step(real dt) override {
        const auto timed = passes_.time("fake");
        time_ += dt;
        ++step_;
        memory_ = std::fmod(memory_ * 3.7 + dt, 1.0);
        fill();
        if (step_ == fail_at_) pressure_[1] = std::nan("");
        return {.dt = dt, .cfl = memory_, .max_divergence = 1e-12, .iterations = static_cast<int>(step_)};
    }
    real advised_dt() const override { return step_ == stall_at_ ? 1e-20 : 0.01 + 0.02 * memory_; }
    StepLimit stable_dt() const override { return {stable_dt_, "so it says"}; }
    std::string concern() const override { return step_ < 2 ? "" : "concerned"; }
    FieldSet fields() const override {
        FieldSet set;
        set.grid = grid_;
        set.fields = fields_of_water(dim_);
        for (FieldView& field : set.fields) fill_in(field);
        return set;
    }
    std::vector<Integral> integrals() const override { return {{"mass", "kg", 1 + memory_}}; }
    real time() const override { return time_; }
    void save(Checkpoint& to) const override {
        to.put_value("fake.time", time_);
        to.put_value("fake.step", step_);
        to.put_value("fake.memory", memory_);
    }
    void restore(const Checkpoint& from) override {
        time_ = from.get_value<real>("fake.time");
        step_ = from.get_value<std::int64_t>("fake.step");
        memory_ = from.get_value<real>("fake.memory");
        fill();
    }
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return level_set_.size() * sizeof(real); }

    /// What the fields are: velocity_a = (a + 1) x_a + t, pressure = 3 x - 2 y, level_set = y - 0.4 - t / 10 + 0.05 x.
    static real velocity(int a, real x_a, real t) { return (a + 1) * x_a + t; }
    static real pressure(real x, real y) { return 3 * x - 2 * y; }
    static real surface(real x, real t) { return 0.4 + t / 10 - 0.05 * x; }

private:
    /// A field of the real solver that the fake does not know is a mistake of the fake's.
    void fill_in(FieldView& field) const {
        if (field.set == marker_set_name)
            for (const auto& p : field.name == "position" ? positions_ : still_) field.data.emplace_back(p);
        else if (field.name == "velocity")
            for (const auto& f : faces_) field.data.emplace_back(f);
        else if (field.name == "pressure")
            field.data = {pressure_};
        else if (field.name == level_set_name)
            field.data = {level_set_};
        else
            throw std::logic_error("the fake has no field \"" + field.name + "\" of the real solver");
    }
    void fill() {
        for (int a = 0; a < dim_; ++a)
            each(a, [&](std::size_t i, const Vec<3>& x) { faces_[static_cast<std::size_t>(a)][i] = velocity(a, x[a], time_); });
        each(-1, [&](std::size_t i, const Vec<3>& x) {
            pressure_[i] = pressure(x[0], x[1]);
            level_set_[i] = x[1] - surface(x[0], time_);
        });
        for (auto& component : positions_)
            for (std::size_t m = 0; m < component.size(); ++m) component[m] = 0.1 * memory_ + 0.05 * static_cast<real>(m);
    }
    /// f(i, x) at every cell centre (axis -1), or at every face across an axis.
    template <class F>
    void each(int axis, const F& f) const {
        const auto count = [&](int a) { return grid_.cells[static_cast<std::size_t>(a)] + (a == axis); };
        std::size_t i = 0;
        for (int z = 0; z < count(2); ++z)
            for (int y = 0; y < count(1); ++y)
                for (int x = 0; x < count(0); ++x) {
                    const int index[3] = {x, y, z};
                    Vec<3> at{};
                    for (int a = 0; a < dim_; ++a)
                        at[a] = grid_.origin[static_cast<std::size_t>(a)] +
                                grid_.spacing[static_cast<std::size_t>(a)] * (index[a] + (a == axis ? 0 : 0.5));
                    f(i++, at);
                }
    }
    int dim_;
    std::int64_t fail_at_, stall_at_;
    real stable_dt_;
    GridView grid_;
    std::vector<std::vector<real>> faces_, positions_, still_;  // still_: velocities of markers
    std::vector<real> pressure_, level_set_;
    real time_ = 0, memory_ = 0.3;
    std::int64_t step_ = 0;
    Passes passes_;
};

inline std::vector<scene::SolverKind> fake_kinds() {
    scene::SolverKind kind;
    kind.schema.name = "fake";
    kind.schema.doc = "Without physics.";
    kind.schema.dims = {2, 3};
    kind.schema.keys = {
        {.name = "fail_at", .type = scene::Type::integer, .doc = "Step that yields a NaN.", .fallback = std::int64_t{-1}},
        {.name = "stall_at", .type = scene::Type::integer, .doc = "Step after which none is advised.", .fallback = std::int64_t{-1}},
        {.name = "stable_dt", .type = scene::Type::number, .doc = "The longest stable step.", .unit = "s"}};
    kind.make = [](const scene::Scene& scene, const Partition&) { return std::make_unique<FakeSolver>(scene); };
    return {kind};
}

/// A simulation of the fake solver in the unit square or cube of 8 cells a side; `more` is TOML, one key a line.
inline Simulation fake_simulation(const std::string& more, int dim = 2) {
    const std::string cells = dim == 2 ? "[8, 8]" : "[8, 8, 8]", size = dim == 2 ? "[1, 1]" : "[1, 1, 1]";
    const std::string text =
        "solver = \"fake\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = " + cells + ", size = " + size + " }\n" + more;
    return Simulation(scene::parse(text, "fake.toml", {fake_kinds()[0].schema}), fake_kinds());
}

}  // namespace weir::test
