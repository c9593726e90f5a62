// File formats of frames. A format is one file, output/formats/NAME.cpp, that defines NAME_format(); NAME stands in WEIR_FRAME_FORMATS of
// solvers/CMakeLists.txt. From that list come the values of output.format and the registry below.
#pragma once
#include "core/solver.hpp"
#include "core/types.hpp"
#include "output/series_index.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace weir {
struct SurfaceMesh;
}

namespace weir::output {

enum class Compression { none, zlib, lz4 };

/// Contents of frames; sim/frame_options.hpp reads them from a scene.
struct FrameOptions {
    std::string format = {};               // name of a registered format; the first one where empty
    std::vector<std::string> fields = {};  // names to write; all where empty. Particle positions are always written
    bool faces = false;                    // also the face components at the faces' centres
    Compression compression = Compression::zlib;
    bool single_precision = false;
    /// 1 for each of the cells [begin, end), which must be whole planes, inside a solid at time t: viewers hide them. Empty function: there
    /// are no solids.
    std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t, std::size_t begin, std::size_t end)> solid = {};
    /// The liquid's surface at a time, written as the series liquid_surface; in parallel each rank has its part. Empty function: the scene
    /// names none.
    std::function<const SurfaceMesh&(const FieldSet& fields, real t)> surface = {};
};

/// The path of the present frame's file in a series ("grid", "markers"), with this extension. The index of the series will name the file
/// once the frame is complete.
using FrameFile = std::function<std::filesystem::path(const std::string& series, const std::string& extension)>;

struct FrameFormat {
    std::string name{};
    /// Writes the files of the frame at time t [s]. Collective: in parallel every rank calls it with its part of the fields
    /// (output/frame_arrays.hpp). Throws OutputError.
    std::function<void(const FieldSet& fields, real t, const FrameOptions& options, const FrameFile& file)> write{};
    SeriesIndex index = csv_index();
    double bytes_per_value = 0;                                   // at most; 0: 8, or 4 in single precision
    std::string (*viewers)(const std::string& folder) = nullptr;  // programs that read the frames, for the message at the end of a run
    std::string unavailable{};                                    // why this build cannot write the format; empty: it can
};

/// All formats; the first is the default.
const std::vector<FrameFormat>& frame_formats();
/// The format of that name, the first one for an empty name. Throws BadInput with the known names.
const FrameFormat& frame_format(const std::string& name = {});

}  // namespace weir::output
