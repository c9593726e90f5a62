// A heap of water let go in a pond: what two gauges saw in the finest run of another solver, which is no truth, but nearer to it.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

using namespace weir;
using namespace weir::validation;

REFERENCE(pond) {
    const Table finest = read_table(data / "finest.csv");
    Reference ref{.source = "mac_water on 2048 x 256 cells"};
    ref.curves["near"] = finest.curve("t", "near", ref.source);
    ref.curves["far"] = finest.curve("t", "far", ref.source);
    ref.numbers["heap"] = 0.1;  // of the scene's heap over the level [m]
    return ref;
}
