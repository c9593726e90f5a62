// Runs a scene and reads a field at the end: the largest pressure, or the largest particle speed if the solver has no pressure.
#include <weir/sim/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

int main(int argc, char** argv) try {
    weir::Simulation simulation(argc > 1 ? argv[1] : "scene.toml");
    while (!simulation.finished()) simulation.step();
    std::printf("t = %g s, %lld steps, ", simulation.time(), static_cast<long long>(simulation.steps()));
    const weir::FieldSet fields = simulation.fields();
    if (const auto* pressure = fields.find("pressure")) {  // nullptr: the solver has no field of this name
        std::printf("max p = %g Pa\n", *std::max_element(pressure->data[0].begin(), pressure->data[0].end()));
    } else if (const auto* velocity = fields.find(weir::particle_set_name, "velocity")) {
        double fastest = 0;
        for (std::size_t i = 0; i < velocity->data[0].size(); ++i) {
            double squared = 0;
            for (const auto& component : velocity->data) squared += component[i] * component[i];
            fastest = std::max(fastest, std::sqrt(squared));
        }
        std::printf("max |u| = %g m/s of %zu particles\n", fastest, velocity->data[0].size());
    }
} catch (const weir::BadInput& error) {  // an error in the scene: the message has the line and the allowed values
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
