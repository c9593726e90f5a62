#include "app/run_folder.hpp"
#include "core/error.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/targets.hpp"
#include "output/read_frame.hpp"
#include "output/series_file.hpp"
#include "output/vtk_read.hpp"

bool weir::fuzz::frame(std::string_view bytes) {
    try {
        if (bytes.starts_with("{")) {
            written("run.json", bytes);
            (void)app::scene_of_run(scratch_folder());
        } else if (bytes.find("\"Collection\"") != std::string_view::npos) {
            const auto file = written("grid.pvd", bytes);
            (void)output::is_ours(file, output::pvd_index());
            (void)output::read_series(file);
        } else {
            (void)output::read_vtk(written("frame.vti", bytes));
        }
        return true;
    } catch (const BadInput&) {
        return false;
    }
}
