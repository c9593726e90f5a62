#include "core/error.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/targets.hpp"
#include "output/step_rows.hpp"
#include "validation/references/table.hpp"

#include <array>

/// The file of a run that goes on at step 3 gets another row and another column; a table of a case is read.
bool weir::fuzz::rows(std::string_view bytes) {
    const auto file = written("steps.csv", bytes);
    bool good = false;
    try {
        (void)validation::read_table(file);
        good = true;
    } catch (const BadInput&) {
    }
    output::StepRows rows(file, {"t [s]", "dt [s]"});
    rows.resume(3, true);
    good = good || rows.count() > 0;
    const std::vector<real> row(rows.columns().size(), 0.5);
    rows.add(4, row);
    rows.add_column("more");
    return good;
}
