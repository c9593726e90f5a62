// Each tests/input/bad/NN_name.toml is refused with exactly the text of NN_name.expected. After a message was changed on purpose,
// WEIR_WRITE_EXPECTED=1 writes the new texts, to be read before they are committed.
#include "input/bad_folder.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"

#include <cstdlib>

using namespace weir;

namespace {

/// What a user is told: by the reader, or by the solver that looks at the geometry.
std::string refusal(const std::filesystem::path& scene) {
    try {
        Simulation simulation(scene);
    } catch (const BadInput& e) {
        return std::string(e.what()) + "\n";
    }
    return "accepted\n";
}

}  // namespace

TEST("each bad scene is refused with exactly the expected message") {
    const test::InBadFolder here;
    const auto scenes = test::bad_scenes();
    EXPECT_GE(scenes.size(), 50U);
    for (const auto& scene : scenes) {
        const auto message = refusal(scene);
        const auto expected = test::expected_file(scene);
        if (std::getenv("WEIR_WRITE_EXPECTED")) std::ofstream(expected, std::ios::binary) << message;
        EXPECT_NE(message, "accepted\n") << scene;
        EXPECT_EQ(message, test::content(expected)) << scene;
    }
}
