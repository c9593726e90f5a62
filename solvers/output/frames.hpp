// Frames of a run: files of one format (frame_format.hpp) in the folder "frames", and beside it an index for each series of them (grid,
// markers, ...). A frame's files are written before the index names them, and the index is replaced atomically, so a killed run leaves a
// readable one. In parallel all ranks write a frame together, each its part of the fields: every call is collective.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "output/frame_format.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace weir::output {

/// Throws BadInput when `options` select names that these fields do not have.
void check(const FrameOptions& options, const FieldSet& fields);

class Frames {
public:
    /// Starts a new series in `folder` (which must be writable); files of an older series by weir, in any format, are removed.
    Frames(std::filesystem::path folder, FrameOptions options);
    /// The same in a format that is not registered.
    Frames(std::filesystem::path folder, FrameOptions options, FrameFormat format);
    /// Continues the series in `folder` after time t [s] with frame number `kept` of the run; later frames are removed. The series of a
    /// branch, which started within the run, has fewer frames. So has that of a run whose format changes: frames of the former format up to
    /// t stay. Throws BadInput where frames are missing.
    static Frames resume(std::filesystem::path folder, FrameOptions options, std::int64_t kept, real t);

    /// Writes frame `count()` at time t [s]. Throws OutputError; earlier frames stay readable then. Throws BadInput where this build cannot
    /// write the format.
    void write(const FieldSet& fields, real t);
    std::int64_t count() const { return static_cast<std::int64_t>(times_.size()); }
    /// The indices written so far: grid.pvd, markers.pvd, ...
    std::vector<std::filesystem::path> series() const;

private:
    struct Resume {};
    Frames(std::filesystem::path folder, FrameOptions options, FrameFormat format, Resume)
        : folder_(std::move(folder)), options_(std::move(options)), format_(std::move(format)) {}
    void take_up(std::int64_t kept, real t);
    void write_indices() const;
    std::filesystem::path index_of(const std::string& series) const { return folder_ / (series + format_.index.extension); }

    std::filesystem::path folder_;
    FrameOptions options_;
    FrameFormat format_;
    // in parallel known on rank 0 only
    std::vector<real> times_;
    std::map<std::string, std::string> pieces_;  // series by name, and the extension of its files
};

}  // namespace weir::output
