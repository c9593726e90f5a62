// Scenes with fewer cells that are otherwise alike: the same proportions, the same part of liquid, and for grids rows with similar padding.
#include "sim/small_copy.hpp"

#include "geometry/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace weir::sim {

double number_of_cells(const std::vector<double>& cells) { return std::accumulate(cells.begin(), cells.end(), 1.0, std::multiplies<>()); }

double number_of_boundary_faces(const std::vector<double>& cells) {
    double sum = 0;
    for (const double n : cells) sum += number_of_cells(cells) / n;
    return sum;
}

namespace {

constexpr double lanes_row = 32;   // cells: rows of fields are padded to whole multiples of it
constexpr double short_row = 64;   // cells: rows up to this length are not shortened
constexpr double fewest = 4;       // minimum number of cells along an axis of a copy
constexpr int samples = 1 << 17;   // number of cells: a part of a thousandth is estimated within a tenth of it
constexpr double alike = 0.02;     // relative to the liquid: less than a tenth of the claimed error
constexpr double corrected = 0.3;  // relative to the particles: the number of neighbours changes little within it

/// Number of times n can be halved, up to `most`.
int halvings(double n, int most) {
    int count = 0;
    for (; count < most && std::fmod(n, 2) == 0; n /= 2) ++count;
    return count;
}

/// About `target` cells that can be halved as often as n, as far as so few can.
double halving_like(double n, double target) {
    const double t = std::max(fewest, target);
    double power = 1;
    bool all = true;
    while (std::fmod(n, 2 * power) == 0 && all)
        if ((all = 2 * power <= 1.5 * t)) power *= 2;
    return std::min(n, all ? power * (2 * std::round((t / power - 1) / 2) + 1) : power);
}

/// About `target` cells whose rows have about the same relative padding as n and can be halved about as often.
double padded_like(double n, double target) {
    if (n <= short_row) return n;
    constexpr int often = 4;
    const auto padding = [](double m) { return lanes_row * std::ceil(m / lanes_row) / m; };
    double best = n, least = infinity;
    for (double m = std::max(lanes_row, std::floor(0.6 * target)); m <= std::max(short_row, 1.6 * target) && m < n; ++m) {
        // the padding adds to the size of a field; fewer halvings select another pressure solver
        const double differs =
            std::abs(padding(m) - padding(n)) + std::abs(halvings(m, often) - halvings(n, often)) + 0.1 * std::abs(std::log(m / target));
        if (differs < least) least = differs, best = m;
    }
    return best;
}

std::vector<double> copy_cells_of(const std::vector<double>& n, double target, Copy how) {
    std::vector<double> cells = n;
    const double f = std::pow(target / number_of_cells(n), 1.0 / static_cast<double>(n.size()));
    if (how == Copy::similar) {
        for (double& c : cells) c = std::min(c, std::max(fewest, std::round(c * f)));
        return cells;
    }
    if (how == Copy::like_columns) {
        const double fewer = std::pow(std::min(1.0, target / number_of_cells(n)), 1.0 / static_cast<double>(n.size() - 1));
        for (std::size_t a = 0; a < n.size(); ++a)
            if (a != 1) cells[a] = std::min(n[a], std::max(std::ceil(n[a] / widest_copy), halving_like(n[a], n[a] * fewer)));
        return cells;
    }
    cells[0] = padded_like(n[0], n[0] * f);
    const double rest = number_of_cells(n) / n[0];
    const double g = std::pow(std::min(1.0, target / cells[0] / rest), 1.0 / static_cast<double>(n.size() - 1));
    for (std::size_t a = 1; a < n.size(); ++a) cells[a] = halving_like(n[a], n[a] * g);
    return cells;
}

template <int D>
double liquid_fraction_of(const scene::Scene& scene) {
    const auto tables = [&](const char* list) { return scene.has(list) ? scene.root().tables(list) : std::vector<scene::Table>{}; };
    const auto liquid = geometry::make_shapes<D>(tables("liquid")), solids = geometry::make_shapes<D>(tables("solids"));
    const Vec<D> origin = scene.vec<D>("grid.origin"), size = scene.vec<D>("grid.size");
    const Index<D> n = scene.index<D>("grid.cells");
    double cells = 1;
    for (int a = 0; a < D; ++a) cells *= n[a];
    const bool all = cells <= samples;
    // Roberts' sequence: the powers of the root of g^(D+1) = g + 1 fill a box more evenly than random points (error 1/samples instead of
    // its root)
    const double g = D == 2 ? 1.32471795724474602596 : 1.22074408460575947536;
    const auto inside = [](const auto& shapes, const Vec<D>& x) {
        return std::any_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s->contains(x); });
    };
    double wet = 0;
    const int count = all ? static_cast<int>(cells) : samples;
    for (int k = 0; k < count; ++k) {
        Vec<D> x{};
        int rest = k;
        double power = 1;
        for (int a = 0; a < D; ++a) {
            power /= g;
            const double u = 0.5 + power * (k + 1);
            const int i = all ? rest % n[a] : std::min(n[a] - 1, static_cast<int>((u - std::floor(u)) * n[a]));
            rest /= n[a];
            x[a] = origin[a] + size[a] * (i + 0.5) / n[a];
        }
        wet += inside(liquid, x) && !inside(solids, x) ? 1 : 0;
    }
    return wet / count;
}

/// At least x, with few enough digits that its products with cell counts are exact: cubic cells stay cubic to the last bit.
double short_number(double x) {
    constexpr int bits = 30;
    const double unit = std::ldexp(1.0, std::ilogb(x) - bits);
    return std::ceil(x / unit) * unit;
}

std::string list_text(const std::vector<double>& list) { return fmt::format("[{}]", fmt::join(list, ", ")); }

}  // namespace

double liquid_fraction(const scene::Scene& scene) { return scene.dim() == 2 ? liquid_fraction_of<2>(scene) : liquid_fraction_of<3>(scene); }

std::string pool_text(const std::vector<double>& origin, const std::vector<double>& size, const std::vector<double>& cells, double part) {
    const auto box = [&](double width, double from, double to) {
        std::vector<double> low = origin, high = origin;
        for (std::size_t a = 0; a < origin.size(); ++a) high[a] += size[a];
        high[0] = origin[0] + width, low[1] += from, high[1] = origin[1] + to;
        return fmt::format("{{ shape = \"box\", min = {}, max = {} }}", list_text(low), list_text(high));
    };
    const double h = size[1] / cells[1], full = std::floor(part * cells[1]), more = part * cells[1] - full;
    std::vector<std::string> boxes;
    if (full > 0) boxes.push_back(box(size[0], 0, full * h));
    const double width = std::ceil(more * cells[0]) * size[0] / cells[0];
    if (width > 0 && full < cells[1]) boxes.push_back(box(width, full * h, (full + 1) * h));
    return fmt::format("[{}]", fmt::join(boxes, ", "));
}

scene::Scene small_copy(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double cells, Copy how) {
    const auto n = scene.root().numbers("grid.cells"), size = scene.root().numbers("grid.size");
    if (number_of_cells(n) <= cells) return scene;
    const auto copy = copy_cells_of(n, cells, how);
    const auto schemas = scene::schemas_of(kinds);
    if (how == Copy::like_columns) {  // the same box with the same liquid
        auto overrides = scene.overrides();
        overrides.push_back({"grid.cells", list_text(copy)});
        return scene::parse(scene.source(), scene.file(), schemas, overrides);
    }
    double coarser = 1;  // one factor for all axes: particles need cubic cells
    for (std::size_t a = 0; a < n.size(); ++a) coarser = std::max(coarser, n[a] / copy[a]);
    bool cubes = true;  // to the last bit: a pressure solver has simpler coefficients for cubic cells
    for (std::size_t a = 0; a < n.size(); ++a) cubes = cubes && size[a] / n[a] == size[0] / n[0];
    std::vector<double> box = size;
    for (std::size_t a = 0; a < n.size(); ++a) {
        const double differs = cubes ? 0 : 4 * static_cast<double>(a) * std::numeric_limits<double>::epsilon();
        box[a] = short_number(size[a] / n[a] * coarser) * copy[a] * (1 + differs);
    }
    auto overrides = scene.overrides();
    overrides.push_back({"grid.cells", list_text(copy)});
    overrides.push_back({"grid.size", list_text(box)});
    const auto parsed = [&] { return scene::parse(scene.source(), scene.file(), schemas, overrides); };
    if (!scene.has("liquid") || scene.root().tables("liquid").empty()) return parsed();
    const double wet = how == Copy::similar
                           ? liquid_fraction(scene) * number_of_cells(n) / number_of_cells(copy) / std::pow(coarser, scene.dim())
                           : liquid_fraction(scene);
    const scene::Scene as_it_is = parsed();
    if (std::abs(liquid_fraction(as_it_is) - wet) <= (how == Copy::similar ? corrected : alike) * wet) return as_it_is;
    overrides.push_back({"liquid", pool_text(scene.root().numbers("grid.origin"), box, copy, std::min(1.0, wet))});
    return parsed();
}

}  // namespace weir::sim
