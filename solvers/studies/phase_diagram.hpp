// Solver "phase_diagram": static. The plane of the grid is that of temperature (x, in K) and pressure (y, its decimal logarithm, in Pa).
// Its cells show the state of a substance, and point sets its phase boundaries and its properties at chosen temperatures and pressures.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

namespace weir::studies {

class PhaseDiagram final : public Solver {
public:
    explicit PhaseDiagram(const scene::Scene& scene);
    static scene::Key samples_key();

    /// Only advances time.
    StepReport step(real dt) override;
    real advised_dt() const override { return infinity; }
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override { return {}; }
    real time() const override { return time_; }
    void save(Checkpoint& to) const override { to.put_value("time", time_); }
    void restore(const Checkpoint& from) override { time_ = from.get_value<real>("time"); }
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;

private:
    struct Column {
        std::string name, unit;
        std::vector<real> values;
    };
    struct PointSet {
        std::string name;
        std::vector<real> T, log_p;
        std::vector<Column> columns{};
    };
    void fill_plane(const thermo::Substance& substance);
    void add_line(const thermo::Substance& substance, thermo::Boundary boundary);
    void add_samples(const scene::Scene& scene, const thermo::Substance& substance);

    GridView grid_;
    std::vector<Column> plane_;
    std::vector<PointSet> sets_;
    real time_ = 0;
    Passes passes_;
};

}  // namespace weir::studies
