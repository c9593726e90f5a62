#include "output/frames.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <string_view>

namespace weir::output {

namespace {

std::string file_name(const std::string& series, std::int64_t frame, const std::string& extension) {
    char number[24];
    std::snprintf(number, sizeof number, "_%06lld", static_cast<long long>(frame));
    return std::string(frame_folder) + '/' + series + number + extension;
}

}  // namespace

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

Frames::Frames(std::filesystem::path folder, FrameOptions options) : Frames(std::move(folder), options, frame_format(options.format)) {}

Frames::Frames(std::filesystem::path folder, FrameOptions options, FrameFormat format)
    : Frames(std::move(folder), std::move(options), std::move(format), Resume{}) {
    by_first_rank([&] {
        require_writable(folder_ / frame_folder);
        for (const FrameFormat& known : frame_formats())
            for (const auto& old : series_in(folder_, known.index)) truncate_series(folder_ / old, 0, known.index);
    });
}

Frames Frames::resume(std::filesystem::path folder, FrameOptions options, std::int64_t kept, real t) {
    Frames frames(std::move(folder), options, frame_format(options.format), Resume{});
    by_first_rank([&] { frames.take_up(kept, t); });
    return frames;
}

namespace {

std::int64_t until(const std::vector<SeriesEntry>& entries, real t) {
    return std::count_if(entries.begin(), entries.end(), [&](const SeriesEntry& entry) { return entry.time <= t; });
}

/// Number of frames of a series to keep. A series that starts later than the run belongs to a branch: it has the frames from there on.
std::int64_t kept_of(const std::filesystem::path& file, const std::vector<SeriesEntry>& entries, std::int64_t kept, real t) {
    if (!entries.empty() && entries[0].time > 0) return until(entries, t);
    if (static_cast<std::int64_t>(entries.size()) < kept)
        throw BadInput(file.string() + " has " + std::to_string(entries.size()) + " frames, but the checkpoint was written after " +
                       std::to_string(kept) + ": continue in the folder of the original run, or in a new one");
    return kept;
}

}  // namespace

void Frames::take_up(std::int64_t kept, real t) {
    require_writable(folder_ / frame_folder);
    std::map<std::filesystem::path, std::int64_t> frames;  // determined before any is removed
    for (const auto& name : series_in(folder_, format_.index))
        frames[name] = kept_of(folder_ / name, format_.index.read(folder_ / name), kept, t);
    for (const auto& [name, count] : frames) {
        const auto entries = truncate_series(folder_ / name, count, format_.index);
        times_.clear();
        for (const auto& entry : entries) times_.push_back(entry.time);
        if (!entries.empty()) pieces_[name.stem().string()] = std::filesystem::path(entries[0].file).extension().string();
    }
    for (const FrameFormat& other : frame_formats()) {
        if (std::string_view(other.index.extension) == format_.index.extension) continue;
        for (const auto& name : series_in(folder_, other.index))
            truncate_series(folder_ / name, until(other.index.read(folder_ / name), t), other.index);
    }
}

void Frames::write(const FieldSet& fields, real t) {
    if (!format_.unavailable.empty()) throw BadInput(format_.unavailable + " and cannot write frames as " + format_.name);
    auto pieces = pieces_;
    format_.write(fields, t, options_, [&](const std::string& series, const std::string& extension) {
        pieces[series] = extension;
        return folder_ / file_name(series, count(), extension);
    });
    pieces_ = std::move(pieces);
    by_first_rank([&] {
        times_.push_back(t);
        write_indices();
    });
}

void Frames::write_indices() const {
    for (const auto& [name, extension] : pieces_) {
        std::vector<SeriesEntry> entries;
        for (std::int64_t frame = 0; frame < count(); ++frame)
            entries.push_back({times_[static_cast<std::size_t>(frame)], file_name(name, frame, extension)});
        write_file(index_of(name), format_.index.text(entries));
    }
}

std::vector<std::filesystem::path> Frames::series() const {
    std::vector<std::filesystem::path> list;
    for (const auto& [name, extension] : pieces_) list.push_back(index_of(name));
    return list;
}

}  // namespace weir::output
