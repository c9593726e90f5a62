#include "geometry/mesh/mesh.hpp"

#include "core/error.hpp"
#include "geometry/mesh/sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

namespace weir::geometry {

namespace {

/// Distances are single precision, and moments are fifth powers of lengths: both are representable within these bounds [file's unit].
constexpr real largest = 1e30, smallest = 1e-30;

void require_size(const Triangles& mesh, const std::string& name) {
    real longest = 0;
    for (int a = 0; a < 3; ++a) {
        real least = infinity, most = -infinity;
        for (const Vec<3>& x : mesh.points) least = std::min(least, x[a]), most = std::max(most, x[a]);
        if (least < -largest || most > largest)
            throw BadInput(fmt::format("{}: it extends from {:.4g} to {:.4g} along {}; coordinates up to {:g} in magnitude are supported",
                                       name, least, most, "xyz"[a], largest));
        longest = std::max(longest, most - least);
    }
    if (longest < smallest && !mesh.points.empty())
        throw BadInput(fmt::format("{}: its longest side is {:.4g}; at least {:g} is read", name, longest, smallest));
}

}  // namespace

Mesh::Mesh(Triangles triangles, int resolution, const std::string& name) : triangles_(std::move(triangles)) {
    require_size(triangles_, name);
    weld(triangles_);
    require_closed(triangles_, name);
    min_ = Vec<3>::constant(infinity), max_ = Vec<3>::constant(-infinity);
    for (const Vec<3>& x : triangles_.points)
        for (int a = 0; a < 3; ++a) min_[a] = std::min(min_[a], x[a]), max_[a] = std::max(max_[a], x[a]);
    weigh();
    MeshSampler::sample(*this, resolution, name);
}

/// Integrals over the tetrahedra between each triangle and one point. With corners 0, a, b, c and six times the volume d, ∫1 = d/6, ∫x =
/// d/24 (a + b + c), ∫x xᵀ = d/120 (s sᵀ + a aᵀ + b bᵀ + c cᵀ), s = a + b + c.
void Mesh::weigh() {
    const Vec<3> o = 0.5 * (min_ + max_);
    real volumes = 0;
    Vec<3> first{};
    std::array<Vec<3>, 3> second{};
    for (const auto& t : triangles_.corners) {
        const auto at = [&](std::size_t k) { return triangles_.points[static_cast<std::size_t>(t[k])] - o; };
        const Vec<3> a = at(0), b = at(1), c = at(2), s = a + b + c;
        const real d = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
        volumes += d / 6, first += (d / 24) * s;
        for (int i = 0; i < 3; ++i) second[static_cast<std::size_t>(i)] += (d / 120) * (s[i] * s + a[i] * a + b[i] * b + c[i] * c);
    }
    volume_ = volumes;
    centre_ = o + first / volumes;
    for (int i = 0; i < 3; ++i) second_[static_cast<std::size_t>(i)] = second[static_cast<std::size_t>(i)] - (first[i] / volumes) * first;
}

real Mesh::distance(const Vec<3>& x) const {
    Vec<3> f, on = x;
    Index<3> I;
    for (int a = 0; a < 3; ++a) {
        on[a] = std::clamp(x[a], origin_[a], origin_[a] + h_ * (nodes_[a] - 1));
        f[a] = (on[a] - origin_[a]) / h_;
        I[a] = std::min(static_cast<int>(f[a]), nodes_[a] - 2);
        f[a] -= I[a];
    }
    const std::size_t row = static_cast<std::size_t>(nodes_[0]), sheet = row * static_cast<std::size_t>(nodes_[1]);
    const float* p =
        phi_.data() + static_cast<std::size_t>(I[2]) * sheet + static_cast<std::size_t>(I[1]) * row + static_cast<std::size_t>(I[0]);
    const auto line = [&](const float* q) { return (1 - f[0]) * q[0] + f[0] * q[1]; };
    const real d =
        (1 - f[2]) * ((1 - f[1]) * line(p) + f[1] * line(p + row)) + f[2] * ((1 - f[1]) * line(p + sheet) + f[1] * line(p + sheet + row));
    const Vec<3> off = x - on;
    const real away = dot(off, off);
    return away > 0 ? std::sqrt(away + d * d) : d;  // the grid is convex and contains the surface: Pythagoras gives a lower bound
}

std::size_t Mesh::bytes() const {
    return triangles_.points.capacity() * sizeof(Vec<3>) + triangles_.colours.capacity() * sizeof(Vec<3>) +
           triangles_.corners.capacity() * sizeof(std::array<int, 3>) + phi_.capacity() * sizeof(float);
}

Vec<3> PosedMesh::to_scene(const Vec<3>& y) const {
    return at + scale * Vec<3>{{dot(rotation[0], y), dot(rotation[1], y), dot(rotation[2], y)}};
}

Vec<3> PosedMesh::to_file(const Vec<3>& x) const {
    const Vec<3> d = (x - at) / scale;
    return d[0] * rotation[0] + d[1] * rotation[1] + d[2] * rotation[2];
}

namespace {

/// A file with the same grid is read and sampled once; a few unused meshes are cached.
std::shared_ptr<const Mesh> load(const std::filesystem::path& file, int resolution) {
    using Stamp = std::tuple<std::string, std::filesystem::file_time_type, int>;
    static std::mutex lock;
    static std::map<Stamp, std::shared_ptr<const Mesh>> loaded;
    constexpr std::size_t kept = 16;
    std::error_code none;
    const Stamp stamp{std::filesystem::absolute(file).string(), std::filesystem::last_write_time(file, none), resolution};
    const std::lock_guard guard(lock);
    if (const auto found = loaded.find(stamp); found != loaded.end()) return found->second;
    if (loaded.size() >= kept) std::erase_if(loaded, [](const auto& entry) { return entry.second.use_count() == 1; });
    return loaded[stamp] = std::make_shared<Mesh>(read_triangles(file), resolution, file.string());
}

std::array<Vec<3>, 3> turn(Vec<3> axis, real angle) {
    axis = axis / norm(axis);
    const real c = std::cos(angle), s = std::sin(angle);
    std::array<Vec<3>, 3> rows;
    for (int i = 0; i < 3; ++i) {
        const Vec<3> e = Vec<3>::unit(i);
        const Vec<3> across{
            {e[1] * axis[2] - e[2] * axis[1], e[2] * axis[0] - e[0] * axis[2], e[0] * axis[1] - e[1] * axis[0]}};  // e × axis
        rows[static_cast<std::size_t>(i)] = c * e + s * across + ((1 - c) * axis[i]) * axis;
    }
    return rows;
}

void require(const scene::Scene& scene, const scene::Table& table, const std::string& path) {
    for (const std::string& key : table.keys()) {
        const scene::Value* value = table.find(key);
        const std::string here = path.empty() ? key : path + '.' + key;
        if (const auto* inner = std::get_if<scene::Table>(value)) require(scene, *inner, here);
        if (const auto* list = std::get_if<std::vector<scene::Table>>(value))
            for (std::size_t i = 0; i < list->size(); ++i) require(scene, (*list)[i], here + '[' + std::to_string(i) + ']');
    }
    if (table.text_or("shape", "") != "mesh") return;
    try {
        (void)make_mesh(table);
    } catch (const BadInput& bad) {
        scene.refuse(path + ".file", bad.what());
    }
}

}  // namespace

PosedMesh make_mesh(const scene::Table& table) {
    if (table.text("file").empty()) throw BadInput("a file name must not be empty; known endings: .obj, .ply, .stl");
    PosedMesh posed;
    posed.mesh = load(table.file("file"), static_cast<int>(table.integer("resolution")));
    posed.scale = table.number("scale");
    posed.at = table.vec<3>("at");
    posed.rotation = turn(table.vec<3>("axis"), table.number("angle"));
    return posed;
}

void name_meshes_from(const std::filesystem::path& folder, scene::Table& table) {
    for (const std::string& key : table.keys()) {
        scene::Value value = *table.find(key);
        if (auto* inner = std::get_if<scene::Table>(&value))
            name_meshes_from(folder, *inner);
        else if (auto* list = std::get_if<std::vector<scene::Table>>(&value))
            for (scene::Table& each : *list) name_meshes_from(folder, each);
        else if (key == "file" && table.text_or("shape", "") == "mesh")
            value = std::filesystem::proximate(table.file("file"), folder).string();
        else
            continue;
        table.set(key, std::move(value), table.place(key));
    }
}

void require_meshes(const scene::Scene& scene) { require(scene, scene.root(), ""); }

}  // namespace weir::geometry
