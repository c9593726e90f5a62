// Files that a scene names belong to it: changed contents are another run, and no checkpoint continues with them.
#include "sim/registry.hpp"
#include "sim/run_id.hpp"
#include "sim/simulation.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

namespace scene_files_tests {

namespace {

using namespace weir;
using test::TemporaryFolder;

/// A tetrahedron with an edge of this length [m].
void write_mesh(const std::filesystem::path& file, const char* edge) {
    std::ofstream(file) << "v 0 0 0\nv " << edge << " 0 0\nv 0 " << edge << " 0\nv 0 0 " << edge
                        << "\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

void write_terrain(const std::filesystem::path& file, const char* height) {
    std::ofstream(file) << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n" << height << " 0\n0 0\n";
}

Simulation start(const std::filesystem::path& folder, const std::string& solver) {
    const std::string water =
                          "solver = \"mac_water\"\ndim = 3\ngrid = { cells = [8, 8, 8], size = [1.0, 1.0, 1.0] }\ntime = { end = 0.1 }\n"
                          "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [1.0, 0.4, 1.0] } ]\n"
                          "solids = [ { shape = \"mesh\", file = \"rock.obj\", at = [0.3, 0.1, 0.3] } ]\n",
                      shore =
                          "solver = \"heightfield\"\ndim = 3\ngrid = { cells = [8, 1, 8], size = [2.0, 1.0, 2.0] }\ntime = { end = 0.1 }\n"
                          "terrain = { kind = \"asc\", file = \"bed.asc\" }\n"
                          "liquid = [ { shape = \"box\", min = [0.0, -1.0, 0.0], max = [2.0, 0.5, 2.0] } ]\n";
    return Simulation(scene::parse(solver == "mac_water" ? water : shore, (folder / "scene.toml").string(), sim::schemas()));
}

}  // namespace

TEST("a scene whose mesh or terrain has changed is another run, and a checkpoint of the old one is refused") {
    for (const std::string solver : {"mac_water", "heightfield"}) {
        TemporaryFolder folder;
        write_mesh(folder.path() / "rock.obj", "0.3"), write_terrain(folder.path() / "bed.asc", "0.1");
        const std::string changed = solver == "mac_water" ? "rock.obj" : "bed.asc";
        Simulation first = start(folder, solver);
        const std::string id = sim::run_id(first.scene());
        first.step();
        Checkpoint state;
        first.save(state);
        Simulation same = start(folder, solver);
        EXPECT_EQ(sim::run_id(same.scene()), id);
        same.restore(state);
        EXPECT_EQ(same.time(), first.time());

        write_mesh(folder.path() / "rock.obj", "0.4"), write_terrain(folder.path() / "bed.asc", "0.2");
        Simulation other = start(folder, solver);
        EXPECT_NE(sim::run_id(other.scene()), id);
        try {
            other.restore(state);
            ADD_FAILURE() << "continued with a changed " << changed;
        } catch (const BadInput& refusal) {
            EXPECT_NE(std::string(refusal.what()).find("the file " + changed + " has changed since the checkpoint"), std::string::npos)
                << refusal.what();
        }
    }
}

}  // namespace scene_files_tests
