// Rules that tie several keys of a scene together: both ends of a periodic axis, corners of a box, the number of cells.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::scene {

/// Adds what is wrong to `problems`; and makes equal what may be said in two ways: `grid.periodic` and sides of kind "periodic" agree
/// afterwards, and a side that is "open" is an "outflow". dim 0: not known. Values that the schema refused are absent and are skipped.
void check_rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems);

/// Where a rule reports. Paths as in messages; the place is that of the value.
class Report {
public:
    Report(const std::string& file, std::vector<Problem>& problems) : file_(file), problems_(problems) {}
    void operator()(Place place, std::string message, std::string hint = "") const {
        problems_.push_back({.file = file_, .place = place, .message = std::move(message), .hint = std::move(hint)});
    }

private:
    const std::string& file_;
    std::vector<Problem>& problems_;
};

/// Corners of the domain [m]; empty where the grid is not known.
struct Domain {
    std::vector<double> min, max;
    bool known() const { return !min.empty(); }
};

void check_sides(Table& root, int dim, const Report& report);
void check_shape(const Table& shape, const std::string& path, int dim, const Report& report);
void check_motion(const Table& motion, const std::string& path, const Report& report);
/// The shape and the domain have no point in common, by their bounding boxes.
bool misses(const Table& shape, const Domain& domain);
void check_probes(const Table& root, const Domain& domain, int dim, const Report& report);

inline std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }
/// "[0, 1] m"
std::string point_text(const std::vector<double>& point);

}  // namespace weir::scene
