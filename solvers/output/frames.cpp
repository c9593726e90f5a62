#include "output/frames.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/frame_files.hpp"
#include "output/series_file.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

namespace weir::output {

namespace {

std::string file_name(const std::string& series, std::int64_t frame, const std::string& extension) {
    char number[24];
    std::snprintf(number, sizeof number, "_%06lld", static_cast<long long>(frame));
    return std::string(frame_folder) + '/' + series + number + extension;
}

/// Particle sets of these fields, in the order in which they appear.
std::vector<std::string> particle_sets(const FieldSet& fields) {
    std::vector<std::string> sets;
    for (const auto& field : fields.fields)
        if (field.where == Where::particle && std::find(sets.begin(), sets.end(), field.set) == sets.end()) sets.push_back(field.set);
    return sets;
}

bool has_grid_fields(const FieldSet& fields, const FrameOptions& options, bool faces_only) {
    return fields.grid.dim > 0 && std::any_of(fields.fields.begin(), fields.fields.end(), [&](const FieldView& field) {
               return field.where != Where::particle && (!faces_only || field.where == Where::face) && chosen(options, field);
           });
}

}  // namespace

#ifdef WEIR_HAS_VTK
bool can_write_frames() { return true; }
#else
bool can_write_frames() { return false; }
#endif

void check(const FrameOptions& options, const FieldSet& fields) {
    std::set<std::string> known;
    for (const auto& field : fields.fields) known.insert(field.name);
    for (const auto& name : options.fields) {
        if (known.count(name)) continue;
        std::string list;
        for (const auto& field : known) list += (list.empty() ? "" : ", ") + field;
        throw BadInput("output.fields: this scene has no field \"" + name + "\"; known: " + list);
    }
}

Frames::Frames(std::filesystem::path folder, FrameOptions options) : Frames(std::move(folder), std::move(options), Resume{}) {
    by_first_rank([&] {
        require_writable(folder_ / frame_folder);
        for (const auto& old : series_in(folder_)) truncate_series(folder_ / old, 0);
    });
}

Frames Frames::resume(std::filesystem::path folder, FrameOptions options, std::int64_t kept, real t) {
    Frames frames(std::move(folder), std::move(options), Resume{});
    by_first_rank([&] { frames.take_up(kept, t); });
    return frames;
}

namespace {

/// Number of frames of a series to keep. A series that starts later than the run belongs to a branch: it has the frames from there on.
std::int64_t kept_of(const std::filesystem::path& pvd, std::int64_t kept, real t) {
    const auto entries = read_series(pvd);
    if (!entries.empty() && entries[0].time > 0)
        return std::count_if(entries.begin(), entries.end(), [&](const SeriesEntry& entry) { return entry.time <= t; });
    if (static_cast<std::int64_t>(entries.size()) < kept)
        throw BadInput(pvd.string() + " has " + std::to_string(entries.size()) + " frames, but the checkpoint was written after " +
                       std::to_string(kept) + ": continue in the folder of the original run, or in a new one");
    return kept;
}

}  // namespace

void Frames::take_up(std::int64_t kept, real t) {
    require_writable(folder_ / frame_folder);
    std::map<std::filesystem::path, std::int64_t> frames;  // determined before any is removed
    for (const auto& name : series_in(folder_)) frames[name] = kept_of(folder_ / name, kept, t);
    for (const auto& [name, count] : frames) {
        const auto entries = truncate_series(folder_ / name, count);
        times_.clear();
        for (const auto& entry : entries) times_.push_back(entry.time);
        if (!entries.empty()) pieces_[name.stem().string()] = std::filesystem::path(entries[0].file).extension().string();
    }
}

void Frames::write(const FieldSet& fields, real t) {
    if (!can_write_frames()) throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and writes no frames");
    if (has_grid_fields(fields, options_, false)) write_piece("grid", ".vti", image_of(fields, t, options_));
    if (options_.faces && has_grid_fields(fields, options_, true))
        for (int axis = 0; axis < fields.grid.dim; ++axis)
            write_piece(std::string("faces_") + "xyz"[axis], ".vti", face_image_of(fields, axis, t, options_));
    for (const auto& set : particle_sets(fields)) write_piece(set, ".vtp", particles_of(fields, set, t, options_));
    if (options_.surface) write_piece("liquid_surface", ".vtp", surface_of(options_.surface(fields, t), t, options_));
    by_first_rank([&] {
        times_.push_back(t);
        write_series();
    });
}

void Frames::write_piece(const std::string& name, const char* extension, const VtkFile& file) {
    output::write(folder_ / file_name(name, count(), extension), file, options_.compression);
    pieces_[name] = extension;
}

void Frames::write_series() const {
    for (const auto& [name, extension] : pieces_) {
        std::vector<SeriesEntry> entries;
        for (std::int64_t frame = 0; frame < count(); ++frame)
            entries.push_back({times_[static_cast<std::size_t>(frame)], file_name(name, frame, extension)});
        write_file(folder_ / (name + ".pvd"), series_text(entries));
    }
}

std::vector<std::filesystem::path> Frames::series() const {
    std::vector<std::filesystem::path> list;
    for (const auto& [name, extension] : pieces_) list.push_back(folder_ / (name + ".pvd"));
    return list;
}

}  // namespace weir::output
