// Frames of a run as VTK files: one image (.vti) of the grid, one (.vtp) of each particle set, and a .pvd series for each. A frame's files
// are written before the series names them, and the series is replaced atomically, so a killed run leaves a readable one. In parallel all
// ranks write a frame together, each its part of the fields: every call is collective.
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
    std::vector<std::string> fields = {};  // names to write; all where empty. Particle positions are always written
    bool faces = false;                    // also an image per axis with the face components at the faces' centres
    Compression compression = Compression::zlib;
    bool single_precision = false;
    /// 1 for each of the cells [begin, end), which must be whole planes, inside a solid at time t: ParaView hides them. Empty function:
    /// there are no solids.
    std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t, std::size_t begin, std::size_t end)> solid = {};
    /// The liquid's surface at a time, written as liquid_surface.pvd; in parallel each rank has its part. Empty function: the scene names
    /// none.
    std::function<const SurfaceMesh&(const FieldSet& fields, real t)> surface = {};
};

/// Returns whether this build can write frames (WEIR_VTK).
bool can_write_frames();

/// Throws BadInput when `options` select names that these fields do not have.
void check(const FrameOptions& options, const FieldSet& fields);

class Frames {
public:
    /// Starts a new series in `folder` (which must be writable); files of an older series by weir are removed.
    Frames(std::filesystem::path folder, FrameOptions options);
    /// Continues the series in `folder` after time t [s] with frame number `kept` of the run; later frames are removed. The series of a
    /// branch, which started within the run, has fewer frames. Throws BadInput where frames are missing.
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
    // in parallel known on rank 0 only
    std::vector<real> times_;
    std::map<std::string, std::string> pieces_;  // series by name, and the extension of its files
};

}  // namespace weir::output
