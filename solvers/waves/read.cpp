#include "waves/read.hpp"

#include "geometry/shape.hpp"
#include "waves/basin.hpp"
#include "waves/ocean.hpp"
#include "waves/stokes.hpp"
#include "waves/trains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weir::waves {

namespace {

constexpr real fewest_cells = 4;     // minimum per wavelength that a grid must resolve
constexpr real miche_of_sea = 0.78;  // significant height over depth beyond which most waves would have broken (McCowan 1894)
/// A weaker acceleration has no visible effect: for a length of one metre the time scale sqrt(L/g) is a quarter of an hour.
constexpr real no_gravity = 1e-6;

struct Reader {
    const scene::Scene& scene;
    const scene::Table& table;
    const Box& box;
    Restoring by;
    real depth;

    [[noreturn]] void refuse(const std::string& key, const std::string& message, const std::string& hint = "") const {
        scene.refuse("waves." + key, message, hint);
    }
    void needs_gravity() const {
        if (!by.acts())
            refuse("model", fmt::format("waves of model \"{}\" require gravity, and the scene has none", table.text("model")),
                   "add effects.gravity with g downwards");
    }
    Vec<2> heading_of(const scene::Table& of, const std::string& path) const {
        const real angle = of.number("heading");
        Vec<2> e{{std::cos(angle), std::sin(angle)}};
        if (box.dim == 3) return e;
        if (std::abs(e[1]) > 1e-6) refuse(path + "heading", fmt::format("in 2D waves travel along x: {:g} rad is neither 0 nor pi", angle));
        return {{e[0] < 0 ? -1.0 : 1.0, 0}};
    }
    /// The larger horizontal cell size, which limits the resolved waves.
    real widest_cell() const { return box.dim == 3 ? std::max(box.spacing[0], box.spacing[2]) : box.spacing[0]; }
    void check_shown(real length, const std::string& key, const std::string& what) const {
        if (length < fewest_cells * widest_cell())
            refuse(key, fmt::format("{} {:.4g} m long on cells of {:.4g} m: a grid shows waves of {:g} cells and more", what, length,
                                    widest_cell(), fewest_cells));
    }
    std::vector<Train> trains() const;
    std::unique_ptr<Model> sines() const;
    std::unique_ptr<Model> gerstner() const;
    Bed bed() const;
    Spectrum spectrum() const;
    std::unique_ptr<Model> sea() const;
    std::unique_ptr<Model> stokes() const;
    template <int D>
    std::unique_ptr<Model> basin() const;
};

std::vector<Train> Reader::trains() const {
    const auto& list = table.tables("trains");
    if (list.empty()) refuse("trains", "the scene has no wave train: add waves.trains");
    std::vector<Train> made;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string path = fmt::format("trains[{}].", i);
        const real length = list[i].number("wavelength");
        check_shown(length, path + "wavelength", "a wave is");
        Train w{.amplitude = list[i].number("amplitude"),
                .k = 2 * pi / length,
                .omega = 0,
                .phase = list[i].number("phase"),
                .heading = heading_of(list[i], path)};
        w.omega = frequency(by, w.k, depth);
        made.push_back(w);
    }
    return made;
}

std::unique_ptr<Model> Reader::sines() const {
    const auto made = trains();
    for (std::size_t i = 0; i < made.size(); ++i) {
        const real steep = made[i].amplitude * made[i].k / pi, most = steepest(made[i].k, depth);
        if (steep > most)
            refuse(
                fmt::format("trains[{}].amplitude", i),
                fmt::format("a wave {:.4g} m high and {:.4g} m long: no wave is higher than {:.3g} of its length here, where crests break",
                            2 * made[i].amplitude, 2 * pi / made[i].k, most),
                "0.142 tanh(k d): Stokes, Michell 1893, Miche 1944");
    }
    return std::make_unique<Sines>(made, depth);
}

Bed Reader::bed() const {
    Bed made;
    if (!table.has("bed")) return made;
    needs_gravity();
    if (table.has("depth")) refuse("depth", "give waves.depth or waves.bed, not both");
    made.x = table.numbers("bed.x");
    made.depth = table.numbers("bed.depth");
    if (made.x.size() < 2) refuse("bed.x", "a bed requires at least two points");
    if (made.x.size() != made.depth.size())
        refuse("bed.depth", fmt::format("{} depths at {} places", made.depth.size(), made.x.size()), "one per position");
    for (std::size_t i = 0; i < made.x.size(); ++i) {
        if (i > 0 && !(made.x[i] > made.x[i - 1]))
            refuse("bed.x", fmt::format("{:g} m follows {:g} m: places increase", made.x[i], made.x[i - 1]));
        if (!(made.depth[i] > 0))
            refuse("bed.depth",
                   fmt::format("the depth at x = {:g} m is {:g} m; it must be greater than 0: these waves do not run up a shore", made.x[i],
                               made.depth[i]));
    }
    return made;
}

std::unique_ptr<Model> Reader::gerstner() const {
    const auto made = trains();
    Trochoids::Shape shape{.bed = bed(), .lean = table.number("lean"), .flatten = table.number("flatten"), .tilt = table.number("tilt")};
    for (std::size_t i = 0; i < made.size(); ++i) {
        const real steep = made[i].amplitude * made[i].k;
        if (steep > 1)
            refuse(fmt::format("trains[{}].amplitude", i),
                   fmt::format("steepness k a = {:.4g}: at 1 a trochoid's crest is a cusp, and beyond it the surface cuts itself", steep));
        if (shape.lean * made[i].amplitude >= 1)
            refuse("lean", fmt::format("{:g} rad a metre on an amplitude of {:g} m: from 1 rad on a crest is blown through its own trough",
                                       shape.lean, made[i].amplitude));
        if (!shape.bed.empty() && std::abs(made[i].heading[0]) < 1e-3)
            refuse(fmt::format("trains[{}].heading", i), "a wave that travels along the shore does not cross the bed");
    }
    return std::make_unique<Trochoids>(made, depth, std::move(shape), by);
}

Spectrum Reader::spectrum() const {
    const scene::Table& t = table.table("spectrum");
    const std::string& kind = t.text("kind");
    const real wind = t.number("wind");
    if (kind == "phillips") return phillips(by, depth, wind, t.number("alpha"));
    if (kind == "pierson_moskowitz") return pierson_moskowitz(by, depth, wind);
    const Spectrum s = jonswap(by, depth, wind, t.number("fetch"), t.number("gamma"));
    // the wind at 19.5 m is 1.026 times that at 10 m
    if (const real risen = pierson_moskowitz(by, depth, 1.026 * wind).peak; s.peak < risen) {
        const real longest = std::pow(22 / risen, 3) * by.g * by.g / wind;
        refuse("spectrum.fetch",
               fmt::format("a fetch of {:.4g} km: after {:.4g} km a wind of {:g} m/s has fully developed the sea", 1e-3 * t.number("fetch"),
                           1e-3 * longest, wind),
               "use kind = \"pierson_moskowitz\"");
    }
    return s;
}

std::unique_ptr<Model> Reader::sea() const {
    needs_gravity();
    if (by.g == 0) refuse("model", "a wind sea requires gravity, and the scene has none", "add effects.gravity with g downwards");
    Sea sea{.spectrum = spectrum(),
            .heading = table.number("heading"),
            .spread = box.dim == 3 ? table.number("spread") : 0,
            .choppiness = table.number("choppiness"),
            .shortest = table.number("shortest"),
            .seed = static_cast<std::uint64_t>(table.integer("seed")),
            .gaussian = table.text("amplitudes") == "gaussian"};
    heading_of(table, "");
    const real peak = 2 * pi / sea.spectrum.peak_wavenumber(), high = 4 * std::sqrt(sea.spectrum.variance());
    const real x = box.nx() * box.spacing[0], z = box.dim == 3 ? box.nz() * box.spacing[2] : x, tile = std::min(x, z);
    if (peak > tile)
        scene.refuse("grid.size",
                     fmt::format("the sea's highest waves are {:.4g} m long, and the periodic tile is {:.4g} m wide", peak, tile),
                     "the tile must hold at least four of them; eight are recommended");
    if (peak < fewest_cells * widest_cell())
        scene.refuse("grid.cells",
                     fmt::format("the sea's highest waves are {:.4g} m long on cells of {:.4g} m: a grid shows waves of {:g} cells "
                                 "and more",
                                 peak, widest_cell(), fewest_cells));
    if (high > miche_of_sea * depth)
        refuse("depth",
               fmt::format("a sea of significant height {:.4g} m on {:.4g} m of water: most of its waves would have broken", high, depth),
               "0.78 of the depth: McCowan 1894");
    if (sea.shortest >= peak) refuse("shortest", fmt::format("the sea's highest waves are {:.4g} m long, and would be omitted", peak));
    if (box.ny() > 1 && sea.choppiness > 0)
        scene.refuse("grid.cells", "a sea with horizontal displacement is a surface: use one cell along y", "or choppiness = 0");
    return std::make_unique<Ocean>(sea, box);
}

std::unique_ptr<Model> Reader::stokes() const {
    needs_gravity();
    if (by.sigma_over_rho > 0) scene.refuse("effects.surface_tension", "Stokes's expansion is that of gravity waves alone");
    const real length = table.number("wavelength");
    const StokesWave wave{.g = by.g,
                          .depth = depth,
                          .height = table.number("height"),
                          .k = 2 * pi / length,
                          .phase = table.number("phase"),
                          .heading = heading_of(table, ""),
                          .order = static_cast<int>(table.integer("order"))};
    check_shown(length, "wavelength", "a wave is");
    const real steep = wave.height / length, most = steepest(wave.k, depth),
               ursell = wave.height * length * length / (depth * depth * depth);
    if (steep > most)
        refuse("height",
               fmt::format("a wave {:.4g} m high and {:.4g} m long: no wave is higher than {:.3g} of its length here, where crests break",
                           wave.height, length, most),
               "0.142 tanh(k d): Stokes, Michell 1893, Miche 1944");
    constexpr real stokes_ends = 40;
    if (ursell > stokes_ends)
        refuse("height",
               fmt::format("height x length^2 / depth^3 = {:.4g}: above {:g} Stokes's expansion does not hold, waves are cnoidal", ursell,
                           stokes_ends),
               "Fenton 1990");
    return std::make_unique<Stokes>(wave);
}

/// The height of the liquid column that stands on the floor at a point [m]; NaN where there is liquid above air.
template <int D>
class Tops {
public:
    Tops(const scene::Scene& scene, const Box& box)
        : shapes_(geometry::make_shapes<D>(scene.root().tables("liquid"))),
          floor_(box.origin[1]),
          height_(box.ny() * box.spacing[1]),
          layers_(std::max(box.ny(), 256)) {}
    bool empty() const { return shapes_.empty(); }
    real operator()(real x, real z) const {
        const auto wet = [&](real y) {
            Vec<D> at{};
            at[0] = x, at[1] = y;
            if constexpr (D == 3) at[2] = z;
            return std::any_of(shapes_.begin(), shapes_.end(), [&](const auto& s) { return s->contains(at); });
        };
        const auto middle = [&](int j) { return floor_ + (j + 0.5) * height_ / layers_; };
        int top = -1;
        for (int j = 0; j < layers_; ++j) {
            if (!wet(middle(j))) continue;
            if (j != top + 1) return std::numeric_limits<real>::quiet_NaN();
            top = j;
        }
        real low = top < 0 ? floor_ : middle(top), high = top < 0 ? floor_ : std::min(middle(top + 1), floor_ + height_);
        for (int turn = 0; turn < 60 && low < high; ++turn) (wet(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
        return low;
    }

private:
    std::vector<geometry::ShapePtr<D>> shapes_;
    real floor_, height_;
    int layers_;
};

template <int D>
std::unique_ptr<Model> Reader::basin() const {
    needs_gravity();
    for (const char* key : {"level", "depth"})
        if (table.has(key)) refuse(key, fmt::format("a basin's {} is that of its liquid", key));
    const Tops<D> tops(scene, box);
    if (tops.empty()) refuse("model", "a basin requires liquid, whose surface is released", "liquid = [ { shape = \"wave\", ... } ]");
    Values heights(box.of_sheet());
    const auto row = [&](int k) { return heights.data() + static_cast<std::ptrdiff_t>(k) * box.nx(); };
    for_own_rows(box, [&](int k) {
        for (int i = 0; i < box.nx(); ++i) row(k)[i] = tops(box.x(i), box.z(k));
    });
    const real torn = -most_of_rows(box, [&](int k) {  // the first such point of the sheet
        for (int i = 0; i < box.nx(); ++i)
            if (std::isnan(row(k)[i])) return -(static_cast<real>(k) * box.nx() + i);
        return -infinity;
    });
    if (torn < infinity)
        scene.refuse("liquid",
                     fmt::format("there is liquid over air at x = {:.4g} m: the surface of a basin has one height over each point, and "
                                 "these waves do not overturn",
                                 box.x(static_cast<int>(std::fmod(torn, box.nx())))),
                     "solver \"mac_water\" can do that");
    const real mean = sum_of_rows(box, [&](int k) {
        real sum = 0;
        for (int i = 0; i < box.nx(); ++i) sum += row(k)[i] / static_cast<real>(box.points());
        return sum;
    });
    if (!(mean > box.origin[1])) scene.refuse("liquid", "there is no liquid in the basin");
    for_own_rows(box, [&](int k) {
        for (int i = 0; i < box.nx(); ++i) row(k)[i] -= mean;
    });
    return std::make_unique<Basin>(by, mean, mean - box.origin[1], box, std::move(heights));
}

}  // namespace

Restoring restoring(const scene::Scene& scene) {
    Restoring by;
    if (const scene::Table* gravity = scene.effect("gravity")) {
        const auto& g = gravity->numbers("g");
        real sideways = 0;
        for (std::size_t a = 0; a < g.size(); ++a)
            if (a != 1) sideways = std::max(sideways, std::abs(g[a]));
        if (sideways > no_gravity || g[1] > no_gravity) scene.refuse("effects.gravity.g", "waves require gravity downwards, against y");
        by.g = std::max(0.0, -g[1]);
    }
    if (const scene::Table* tension = scene.effect("surface_tension"))
        by.sigma_over_rho = tension->number("sigma") / scene.number("fluid.density");
    return by;
}

real mean_level(const scene::Scene& scene, const Box& box) {
    const real level = scene.root().number_or("waves.level", 0), top = box.origin[1] + box.ny() * box.spacing[1];
    if (level < box.origin[1] || level > top)
        scene.refuse(scene.has("waves.level") ? "waves.level" : "waves",
                     fmt::format("the surface rests at y = {:g} m, outside of the grid's {:g} to {:g} m", level, box.origin[1], top),
                     "waves.level");
    return level;
}

std::unique_ptr<Model> make_model(const scene::Scene& scene, const Box& box) {
    const scene::Table& table = scene.root().table("waves");
    const Reader read{scene, table, box, restoring(scene), table.number_or("depth", infinity)};
    const std::string& model = table.text("model");
    if (model != "basin" && scene.has("liquid") && !scene.root().tables("liquid").empty())
        scene.refuse("liquid", "waves of model \"" + model + "\" use level and depth, and do not support liquid",
                     "use model \"basin\" to start from liquid");
    if (model == "sines") return read.sines();
    if (model == "gerstner") return read.gerstner();
    if (model == "spectrum") return read.sea();
    if (model == "stokes") return read.stokes();
    if (model == "basin") return box.dim == 2 ? read.basin<2>() : read.basin<3>();
    throw std::logic_error("waves of model \"" + model + "\" are in the schema but have no meaning");
}

}  // namespace weir::waves
