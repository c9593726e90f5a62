#include "app/space.hpp"

#include "core/error.hpp"
#include "sim/frame_options.hpp"
#include "sim/memory_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::app {

namespace {

std::string size_text(double bytes) { return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6) : fmt::format("{:.3g} GB", bytes / 1e9); }

/// Of the disk on which the folder lies or will lie; infinity where the system does not say.
double room_in(const std::filesystem::path& folder) {
    std::filesystem::path there = std::filesystem::absolute(folder);
    std::error_code unknown;
    while (!std::filesystem::exists(there, unknown) && there.has_relative_path()) there = there.parent_path();
    const auto room = std::filesystem::space(there, unknown);
    return unknown ? infinity : static_cast<double>(room.available);
}

}  // namespace

std::string check_space(const Simulation& simulation, const std::filesystem::path& folder, bool any_size) {
    const scene::Scene& scene = simulation.scene();
    if (!sim::frames_unavailable(scene).empty()) return "";
    const auto parts = simulation.solver().distributed_view();
    const auto output = sim::estimate_output(scene, simulation.fields());
    const double room = room_in(folder), to_come = output.frames - static_cast<double>(simulation.frame());
    const double bytes = std::max(0.0, to_come) * output.bytes_of_frame;
    const bool compressed = scene.text("output.compression") != "none";
    const std::string frames = fmt::format("{:.0f} frames of {}{}, {} in all", to_come, compressed ? "at most " : "",
                                           size_text(output.bytes_of_frame), size_text(bytes));
    if (bytes > room && !any_size)
        throw BadInput(
            fmt::format("{}: {}; {} are free there\n    a longer output.every, fewer output.fields or output.precision = \"single\" reduce "
                        "it; --any-size starts the run anyway",
                        folder.string(), frames, size_text(room)));
    return fmt::format("{}; {} are free in {}\n", frames, size_text(room), folder.string());
}

}  // namespace weir::app
