// Frames of a run as VTK files: one image (.vti) of the grid, one (.vtp) of each particle set, and a .pvd series of each. A frame's files
// stand before the series names them, and the series is replaced whole, so a killed run leaves a readable one. Over ranks all write a frame
// together, each its part of the fields: every call is everybody's.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace weir {
struct SurfaceMesh;
}

namespace weir::output {

struct VtkFile;

enum class Compression { none, zlib, lz4 };

struct FrameOptions {
    std::vector<std::string> fields = {};  // names to write; all where empty. Positions of particles are always written
    bool faces = false;                    // also an image for each axis with the face components as they are, at the faces' centres
    Compression compression = Compression::zlib;
    bool single_precision = false;
    /// 1 for each of the cells [begin, end), which are whole planes, that a solid takes at a time: ParaView draws nothing there. Empty:
    /// there are no solids.
    std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t, std::size_t begin, std::size_t end)> solid = {};
    /// The liquid's surface at a time, written as liquid_surface.pvd; over ranks each has its part. Empty: the scene names none.
    std::function<const SurfaceMesh&(const FieldSet& fields, real t)> surface = {};
};

/// Whether this build can write frames at all (WEIR_VTK).
bool can_write_frames();

/// Throws BadInput when `options` ask for names that these fields do not have.
void check(const FrameOptions& options, const FieldSet& fields);

class Frames {
public:
    /// A new series in `folder` (which must be writable); files of an older series of ours there are removed.
    Frames(std::filesystem::path folder, FrameOptions options);
    /// Continues the series in `folder` after time t [s] with frame number `kept` of the run; later frames there are removed. A series of a
    /// branch, which began within the run, has fewer. Throws BadInput where frames are missing.
    static Frames resume(std::filesystem::path folder, FrameOptions options, std::int64_t kept, real t);

    /// Writes frame `count()` at time t [s]. Throws OutputError; earlier frames stay readable then.
    void write(const FieldSet& fields, real t);
    std::int64_t count() const { return static_cast<std::int64_t>(times_.size()); }
    /// The series written so far: grid.pvd, markers.pvd, ...
    std::vector<std::filesystem::path> series() const;

private:
    struct Resume {};
    Frames(std::filesystem::path folder, FrameOptions options, Resume) : folder_(std::move(folder)), options_(std::move(options)) {}
    void take_up(std::int64_t kept, real t);
    void write_piece(const std::string& name, const char* extension, const VtkFile& file);
    void write_series() const;

    std::filesystem::path folder_;
    FrameOptions options_;
    // Over ranks what the first knows:
    std::vector<real> times_;
    std::map<std::string, std::string> pieces_;  // series by name, and the extension of its files
};

}  // namespace weir::output
