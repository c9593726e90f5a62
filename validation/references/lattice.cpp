// A lattice of particles: density and neighbour counts as finite sums and enumeration give them.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <fmt/format.h>

using namespace weir;
using namespace weir::validation;

REFERENCE(kernel_lattice) {
    const std::string dim = fmt::format("{}", scene.dim()), support = fmt::format("{:g}", scene.number("scheme.support"));
    const std::string& kernel = scene.text("scheme.kernel");
    const std::string column = kernel == "muller" ? "poly6" : kernel == "cubic" ? "cubic_spline" : "wendlandC2";
    const Table sums = read_table(data / "density_sums.csv").where("dim", dim).where("h_over_dx", support);
    const Table counts = read_table(data / "neighbour_counts.csv").where("dim", dim).where("h_over_dx", support);
    Reference ref{.source = "lattice sums and counts (exact)"};
    ref.numbers["density"] = sums.number(0, column) * scene.number("fluid.density");
    ref.numbers["fewest_neighbours"] = counts.number(0, "count_lt");
    ref.numbers["most_neighbours"] = counts.number(0, "count_le");
    return ref;
}
