#include "fuzz/read_any.hpp"
#include "fuzz/small.hpp"
#include "fuzz/targets.hpp"
#include "output/frames.hpp"

bool weir::fuzz::run(std::string_view bytes) {
    const auto read = read_any(bytes, sim::schemas());
    if (!read) return false;
    try {
        require_small(*read);
        Simulation simulation(*read);
        simulation.step();
        simulation.step();
        return true;
    } catch (const BadInput&) {
        return false;
    } catch (const NumericalFailure&) {
        return false;
    }
}
