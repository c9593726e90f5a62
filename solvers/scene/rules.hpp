// Rules about several keys of a scene: both ends of a periodic axis, corners of a box, the number of cells.
#pragma once
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace weir::scene {

/// Adds violations to `problems`, and normalizes alternative notations: afterwards `grid.periodic` and sides of kind "periodic" agree, and
/// a side that is "open" is an "outflow". dim 0: unknown. Values rejected by the schema are absent and are skipped.
void check_rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems);

/// Collects the violations of rules. Paths as in messages; the position is that of the value.
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

/// Corners of the domain [m]; empty where the grid is unknown.
struct Domain {
    std::vector<double> min, max;
    bool known() const { return !min.empty(); }
};

void check_sides(Table& root, int dim, const Report& report);
void check_shape(const Table& shape, const std::string& path, int dim, const Report& report);
void check_motion(const Table& motion, const std::string& path, const Report& report);
/// Returns whether shape and domain do not intersect, by their bounding boxes.
bool misses(const Table& shape, const Domain& domain);
void check_probes(const Table& root, const Domain& domain, int dim, const Report& report);

inline std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }
/// "[0, 1] m"
std::string point_text(const std::vector<double>& point);

}  // namespace weir::scene
