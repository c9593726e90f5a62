// Runs a scene and reads a field: the greatest pressure at the end.
#include <weir/sim/simulation.hpp>

#include <algorithm>
#include <cstdio>

int main(int argc, char** argv) {
    weir::Simulation simulation(argc > 1 ? argv[1] : "scene.toml");
    while (!simulation.finished()) simulation.step();
    const weir::FieldSet fields = simulation.fields();
    const auto pressure = fields.find("pressure")->data[0];
    std::printf("t = %g s, %lld steps, max p = %g Pa\n", simulation.time(), static_cast<long long>(simulation.steps()),
                *std::max_element(pressure.begin(), pressure.end()));
}
